// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <thalweg/serve/serve.hpp>

#include "raw_client.hpp"

/// A server that runs. It has a page and the file "a/b.txt", gives messages back and notes what happens.
class Running {
public:
    explicit Running(thalweg::serve::ServeParams const& params = {})
        : server_(params, handlers()), token_(params.token),
          thread_([this](std::stop_token const& stop) { server_.run(stop); }) {}

    thalweg::serve::Server& server() { return server_; }
    std::string const& token() const { return token_; }
    int port() const {
        std::string const address = server_.address();
        return std::stoi(address.substr(address.rfind(':') + 1));
    }
    std::string host() const { return "127.0.0.1:" + std::to_string(port()); }
    void stop() {
        thread_.request_stop();
        thread_.join();
    }

    /// Whether something happens, now or within a minute: "opened 1", "closed 1: it left".
    bool has_seen(std::string_view event) {
        std::unique_lock lock(mutex_);
        return changed_.wait_for(lock, std::chrono::minutes(1), [&] {
            return std::ranges::any_of(events_, [&](std::string const& seen) { return seen.starts_with(event); });
        });
    }
    std::vector<std::string> events() {
        std::lock_guard const lock(mutex_);
        return events_;
    }

    /// The head of a request for a path with its query, with lines of its own.
    std::string head(std::string const& target, std::string const& lines = "",
                     std::string const& method = "GET") const {
        return method + " " + target + " HTTP/1.1\r\nHost: " + host() + "\r\n" + lines + "\r\n";
    }
    std::string page() const { return "/?token=" + token_; }

    /// The server's answer to the bytes of a request.
    std::string ask(std::string const& bytes) const {
        RawClient client(port());
        client.send(bytes);
        return client.read_all();
    }

    std::string upgrade(std::string const& lines = "") const {
        return head(page(), "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                            "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
                                lines);
    }
    /// Whether a client is let in.
    bool lets_in(RawClient& client) const {
        client.send(upgrade());
        return client.read_until("\r\n\r\n").starts_with("HTTP/1.1 101 ");
    }
    /// Whether a new client gets its message back.
    bool gives_back() const {
        RawClient client(port());
        if (!lets_in(client)) {
            return false;
        }
        client.send(text_frame("well?"));
        return client.read_message().payload == "well?";
    }

private:
    void note(std::string event) {
        std::lock_guard const lock(mutex_);
        events_.push_back(std::move(event));
        changed_.notify_all();
    }

    thalweg::serve::Handlers handlers() {
        using thalweg::serve::Answer;
        using thalweg::serve::Client;
        return {
            .get =
                [this](std::string const& path) {
                    note("get " + path);
                    return path.empty() ? std::optional(Answer{.bytes = "<p>page</p>", .policy = "default-src 'self'"})
                           : path == "a/b.txt" ? std::optional(Answer{.bytes = "file", .type = "text/plain"})
                                               : std::nullopt;
                },
            .opened = [this](Client client) { note("opened " + std::to_string(client)); },
            .text = [this](Client client, std::string_view text) { server_.send_text(client, std::string(text)); },
            .binary = [this](Client client,
                             std::string_view bytes) { server_.send_binary(client, std::string(bytes)); },
            .closed =
                [this](Client client, std::string_view why) {
                    note("closed " + std::to_string(client) + ": " + std::string(why));
                },
        };
    }

    std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<std::string> events_;
    thalweg::serve::Server server_;
    std::string token_;
    std::jthread thread_;
};
