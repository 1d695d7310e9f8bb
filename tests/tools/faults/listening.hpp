// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <stdexcept>
#include <string>
#include <sys/socket.h>
#include <unistd.h>

/// A socket of this machine on a free port. The system accepts connections for it.
class Listening {
public:
    Listening() : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
        sockaddr_in at{};
        at.sin_family = AF_INET;
        at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t size = sizeof at;
        if (bind(socket_, reinterpret_cast<sockaddr*>(&at), size) != 0 || listen(socket_, 64) != 0 ||
            getsockname(socket_, reinterpret_cast<sockaddr*>(&at), &size) != 0) {
            throw std::runtime_error("no socket");
        }
        port_ = std::to_string(ntohs(at.sin_port));
    }
    ~Listening() { close(socket_); }
    Listening(Listening const&) = delete;
    Listening& operator=(Listening const&) = delete;
    int descriptor() const { return socket_; }
    std::string const& port() const { return port_; }

private:
    int socket_;
    std::string port_;
};
