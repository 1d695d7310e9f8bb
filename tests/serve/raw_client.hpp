// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <arpa/inet.h>
#include <cstdint>
#include <netinet/in.h>
#include <stdexcept>
#include <string>
#include <string_view>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>
#include <utility>

/// A frame of a WebSocket as it arrives; opcode -1: the connection is closed.
struct Frame {
    int opcode = -1;
    std::string payload;

    /// The status code of a frame that closes the connection.
    int code() const {
        return opcode == 8 && payload.size() >= 2
                   ? (static_cast<unsigned char>(payload[0]) << 8) + static_cast<unsigned char>(payload[1])
                   : -1;
    }
};

/// A client's frame with its head given, so that a test can break it. The key of the mask is "mask".
inline std::string frame(int first_byte, std::string_view payload) {
    std::string bytes{static_cast<char>(first_byte)};
    std::size_t const size = payload.size();
    int const digits = size < 126 ? 0 : size < 65536 ? 2 : 8;
    bytes += static_cast<char>(0x80U | (digits == 0 ? size : digits == 2 ? 126U : 127U));
    for (int i = digits - 1; i >= 0; --i) {
        bytes += static_cast<char>(size >> static_cast<unsigned>(8 * i));
    }
    bytes += "mask";
    for (std::size_t i = 0; i < size; ++i) {
        bytes += static_cast<char>(payload[i] ^ "mask"[i % 4]);
    }
    return bytes;
}
inline std::string text_frame(std::string_view text) {
    return frame(0x81, text);
}

/// A connection to a server of this machine, byte by byte.
class RawClient {
public:
    explicit RawClient(int port, char const* host = "127.0.0.1") : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
        timeval const minute{60, 0}; // a test that hangs fails
        setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &minute, sizeof minute);
        sockaddr_in at{};
        at.sin_family = AF_INET;
        at.sin_port = htons(static_cast<std::uint16_t>(port));
        inet_pton(AF_INET, host, &at.sin_addr);
        if (connect(socket_, reinterpret_cast<sockaddr*>(&at), sizeof at) != 0) {
            close(socket_);
            throw std::runtime_error("no connection");
        }
    }
    ~RawClient() { close(socket_); }
    RawClient(RawClient const&) = delete;
    RawClient& operator=(RawClient const&) = delete;

    /// How many bytes the system takes before the server closes the connection.
    std::size_t send(std::string_view bytes) const {
        std::size_t sent = 0;
        while (sent < bytes.size()) {
            ssize_t const more = ::send(socket_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
            if (more <= 0) {
                break;
            }
            sent += static_cast<std::size_t>(more);
        }
        return sent;
    }
    void end_sending() const { shutdown(socket_, SHUT_WR); }

    /// So many bytes, or fewer where the connection ends before.
    std::string read(std::size_t count) {
        while (received_.size() < count && receive()) {
        }
        std::string bytes = received_.substr(0, count);
        received_.erase(0, count);
        return bytes;
    }

    /// Bytes up to and including these.
    std::string read_until(std::string_view end) {
        std::size_t at = 0;
        while ((at = received_.find(end)) == std::string::npos && receive()) {
        }
        return read(at == std::string::npos ? received_.size() : at + end.size());
    }

    /// All bytes until the server closes the connection.
    std::string read_all() {
        while (receive()) {
        }
        return std::exchange(received_, "");
    }

    Frame read_frame() {
        std::string const head = read(2);
        if (head.size() < 2) {
            return {};
        }
        std::size_t size = static_cast<unsigned char>(head[1]) & 127U;
        if (size >= 126) {
            std::string const digits = read(size == 126 ? 2 : 8);
            size = 0;
            for (char const digit : digits) {
                size = size << 8U | static_cast<unsigned char>(digit);
            }
        }
        return {static_cast<unsigned char>(head[0]) & 15, read(size)};
    }

    /// The next frame that is no ping.
    Frame read_message() {
        Frame next = read_frame();
        while (next.opcode == 9) {
            next = read_frame();
        }
        return next;
    }

private:
    bool receive() {
        char bytes[65536];
        ssize_t const count = recv(socket_, bytes, sizeof bytes, 0);
        if (count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) {
            throw std::runtime_error("the server does not answer");
        }
        received_.append(bytes, static_cast<std::size_t>(count > 0 ? count : 0));
        return count > 0;
    }

    int socket_;
    std::string received_;
};
