// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Servers that the command line names, accept a connection and never say a word.
#include "command.hpp"
#include "spawned.hpp"

#include <gtest/gtest.h>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

/// The system accepts connections for it, and nobody reads what they send.
class Silent {
public:
    Silent() : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
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
    ~Silent() { close(socket_); }
    Silent(Silent const&) = delete;
    Silent& operator=(Silent const&) = delete;
    std::string const& port() const { return port_; }

private:
    int socket_;
    std::string port_;
};

} // namespace

TEST(LongUnanswered, ServersAreGivenUpAfterTenSeconds) {
    Silent const server;
    Workplace const place;
    std::string const base = "PG:host=127.0.0.1 port=" + server.port() + " dbname=x";
    std::string const address = "/vsicurl/http://127.0.0.1:" + server.port() + "/a.geojson";
    for (std::vector<std::string> const& words :
         {std::vector<std::string>{"make", base, "-o", "out"}, {"make", address, "-o", "out"}, {"check", base}}) {
        auto const begin = std::chrono::steady_clock::now();
        Ended const ended = Spawned(words, place.path(), [] {}).wait(60.0);
        double const seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        EXPECT_FALSE(ended.hung) << words[1];
        EXPECT_EQ(ended.code, 2) << words[1] << ended.err;
        EXPECT_NE(ended.err.find("error: "), std::string::npos) << ended.err;
        EXPECT_GE(seconds, 9.0) << words[1] << ended.err;
        EXPECT_LE(seconds, 25.0) << words[1] << ", at most asked twice";
        EXPECT_TRUE(names_in(place.path()).empty());
    }
}
