// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>

namespace thalweg::serve {

/// Makes a token that cannot be guessed, from the system's random source.
/// \return 32 hexadecimal digits (128 bits)
/// \throws IoError when the system gives no random bytes
std::string new_token();

/// Options of a Server.
struct ServeParams {
    std::uint16_t port = 0;                       ///< 0: any free one
    std::string token = new_token();              ///< at least 16 letters, digits, '-' or '_'; part of the address
    int connections = 64;                         ///< [1, 100000] open at a time, with the token; more are refused
    std::int64_t message_bytes = 4 << 20;         ///< [1, 2^30] of a client's message; a longer one ends its connection
    std::int64_t queue_bytes = 64 << 20;          ///< [1, 2^40] that wait for one client; with more it is dropped
    std::chrono::milliseconds request_time{5000}; ///< [1 ms, 1 h] in which a whole request must arrive
    std::chrono::milliseconds silence{30000}; ///< [1 ms, 1 h] without a sign of life, after which a client is dropped
};

/// What a request gets.
struct Answer {
    std::string bytes;
    std::string type = "text/html; charset=utf-8"; ///< Content-Type
    std::string policy = "default-src 'none'";     ///< Content-Security-Policy
};

/// The number of a WebSocket connection, from 1 and never used twice.
using Client = std::uint64_t;

/// Stands for all clients.
inline constexpr Client everyone = 0;

/// What a Server calls, one call at a time, on the thread that runs it. Each may be empty.
struct Handlers {
    /// \param path relative, of letters, digits, '.', '_', '-' and '/', no part empty or with '.' in front; "": the
    /// page
    /// \return nothing: 404
    /// \throws Error: 404 with its words
    std::function<std::optional<Answer>(std::string const& path)> get = {};
    std::function<void(Client)> opened = {};
    std::function<void(Client, std::string_view message)> text = {}; ///< the message is valid UTF-8
    std::function<void(Client, std::string_view message)> binary = {};
    std::function<void(Client, std::string_view why)> closed = {}; ///< once for each client that was opened
};

class Listener;

/// Serves a page, files and a WebSocket to programs on this machine that know the token. It answers GET and HEAD at
/// 127.0.0.1, each request on a connection of its own, and never touches the file system. WebSocket clients connect to
/// the address of the page. A request with another Host (DNS rebinding), a foreign Origin or without the token gets
/// 403. Errors are answered in words. Connections that have not shown the token never keep out those that do.
class Server {
public:
    /// Opens the port; connections wait until run().
    /// \throws BadParameter when a parameter is outside its range
    /// \throws IoError when the port cannot be opened
    /// \param params,handlers kept
    Server(ServeParams params, Handlers handlers);
    /// \pre No other thread is in send_text or send_binary.
    ~Server();
    Server(Server const&) = delete;
    Server& operator=(Server const&) = delete;

    /// The address of the page.
    /// \return "http://127.0.0.1:PORT/?token=TOKEN"
    std::string address() const;

    /// Serves on this thread until a stop is requested, then closes the port and, within a second, all clients. May be
    /// called once.
    /// \param stop ends it
    /// \throws what a handler throws; the server then serves nothing more
    void run(std::stop_token const& stop);

    /// Sends a message. May be called by any thread, handlers among them; never waits. Messages of one thread arrive in
    /// their order. A client for which too much waits is dropped; one that is no longer there gets nothing.
    /// \param to a client, or everyone
    /// \param text valid UTF-8
    void send_text(Client to, std::string text);
    void send_binary(Client to, std::string bytes);

private:
    std::unique_ptr<Listener> listener_;
};

} // namespace thalweg::serve
