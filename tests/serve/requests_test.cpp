// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Requests over real sockets.
#include <algorithm>
#include <chrono>
#include <future>
#include <memory>
#include <new>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <sys/resource.h>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/serve/serve.hpp>

#include "running.hpp"

using namespace thalweg;
using namespace thalweg::serve;

namespace requests_test {

bool has_status(std::string const& answer, int status) {
    return answer.starts_with("HTTP/1.1 " + std::to_string(status) + " ");
}

std::string body_of(std::string const& answer) {
    return answer.substr(answer.find("\r\n\r\n") + 4);
}

} // namespace requests_test

using namespace requests_test;

TEST(Token, IsOf128BitsAndNeverTheSame) {
    std::string const token = new_token();
    EXPECT_EQ(token.size(), 32U);
    EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos) << token;
    EXPECT_NE(token, new_token());
    EXPECT_NE(ServeParams().token, ServeParams().token);
}

TEST(Server, RefusesBadParameters) {
    for (ServeParams const& params : {ServeParams{.token = ""},
                                      {.token = "short"},
                                      {.token = "0123456789abcde&"},
                                      {.connections = 0},
                                      {.message_bytes = 0},
                                      {.queue_bytes = -1},
                                      {.request_time = std::chrono::milliseconds(0)},
                                      {.silence = std::chrono::hours(2)}}) {
        EXPECT_TRUE(test::refused<BadParameter>(
            "serve.Server", [&] { Server(params, {}); }, "must"));
    }
}

TEST(Server, NamesAPortThatIsTaken) {
    Running const first;
    ServeParams params;
    params.port = static_cast<std::uint16_t>(first.port());
    EXPECT_TRUE(test::refused<IoError>(
        "serve.Server", [&] { Server(params, {}); }, std::to_string(first.port())));
    EXPECT_TRUE(test::refused<IoError>(
        "serve.Server", [&] { Server(params, {}); }, "or 0 for any free one"));
}

TEST(Server, ItsPortIsFreeAfterIt) {
    ServeParams params;
    {
        Running const first;
        EXPECT_TRUE(first.gives_back());
        params.port = static_cast<std::uint16_t>(first.port());
    }
    EXPECT_TRUE(Running(params).gives_back());
}

TEST(Server, ListensAtTheLoopbackAddressAlone) {
    Running running;
    EXPECT_EQ(running.server().address(), "http://" + running.host() + "/?token=" + running.token());
    EXPECT_NO_THROW(RawClient(running.port()));
    EXPECT_THROW(RawClient(running.port(), "127.0.0.2"), std::runtime_error) << "it listens at all addresses";
}

TEST(Requests, OfThePageAndOfFilesAreAnswered) {
    Running running;
    std::string const page = running.ask(running.head(running.page()));
    EXPECT_TRUE(has_status(page, 200)) << page;
    EXPECT_TRUE(test::has(page, "\r\nContent-Type: text/html; charset=utf-8\r\n", "\r\nContent-Length: 11\r\n",
                          "\r\nContent-Security-Policy: default-src 'self'\r\n"));
    EXPECT_EQ(body_of(page), "<p>page</p>");
    std::string const file = running.ask(running.head("/a/b.txt?x=1&token=" + running.token()));
    EXPECT_TRUE(has_status(file, 200)) << file;
    EXPECT_EQ(body_of(file), "file");
    EXPECT_EQ(running.events(), (std::vector<std::string>{"get ", "get a/b.txt"}));
}

TEST(Requests, OfAHeadGetNoBody) {
    Running const running;
    std::string const answer = running.ask(running.head(running.page(), "", "HEAD"));
    EXPECT_TRUE(has_status(answer, 200)) << answer;
    EXPECT_TRUE(test::has(answer, "\r\nContent-Length: 11\r\n"));
    EXPECT_EQ(body_of(answer), "");
}

TEST(Requests, EachAnswerHasTheHeadersOfSecurity) {
    Running const running;
    for (std::string const& request :
         {running.head(running.page()), running.head("/"), running.head("/none?token=" + running.token()),
          running.head("/../x?token=" + running.token()), running.head(running.page(), "", "POST"),
          std::string("\r\n\r\n"), running.head(running.page(), "Content-Length: 1\r\n"),
          running.head(running.page(), std::string(9000, 'a'))}) {
        std::string const answer = running.ask(request);
        EXPECT_TRUE(test::has(answer, "\r\nContent-Security-Policy: default-src '",
                              "\r\nX-Content-Type-Options: nosniff\r\n", "\r\nReferrer-Policy: no-referrer\r\n",
                              "\r\nCache-Control: no-store\r\n", "\r\nCross-Origin-Resource-Policy: same-origin\r\n",
                              "\r\nConnection: close\r\n"))
            << request;
        EXPECT_EQ(answer.find("Access-Control"), std::string::npos);
        EXPECT_EQ(answer.find("Set-Cookie"), std::string::npos);
        EXPECT_EQ(answer.find(running.token()), std::string::npos) << "an answer never has the token";
    }
}

TEST(Requests, WithoutTheTokenAreForbidden) {
    Running running;
    std::string const& token = running.token();
    std::string other = token;
    other.back() = other.back() == '0' ? '1' : '0';
    for (std::string const& target :
         {std::string("/"), std::string("/?token="), "/?token=" + other, "/?token=" + token.substr(1),
          "/?token=" + token + "0", "/?Token=" + token, "/?xtoken=" + token, "/" + token, "/token=" + token,
          "/?token=" + other + "&token=" + token, std::string("/a/b.txt"), "/#?token=" + other, std::string("*")}) {
        std::string const answer = running.ask(running.head(target));
        EXPECT_TRUE(has_status(answer, 403)) << target << answer;
        EXPECT_TRUE(test::has(body_of(answer), "token")) << target;
    }
    EXPECT_TRUE(has_status(running.ask(running.head("/", "", "POST")), 403)) << "nothing is said to who has no token";
    EXPECT_TRUE(running.events().empty());
}

TEST(Requests, ForAnotherHostAreForbidden) {
    Running running;
    std::string const port = ":" + std::to_string(running.port());
    for (std::string const& hosts :
         {std::string(), std::string("Host: \r\n"), std::string("Host: 127.0.0.1\r\n"),
          "Host: evil.example" + port + "\r\n", "Host: 127.0.0.1" + port + ".evil.example\r\n",
          std::string("Host: 127.0.0.1:1\r\n"), "Host: localhost" + port + "\r\n",
          "Host: 127.0.0.1" + port + "\r\nHost: evil.example\r\n"}) {
        for (std::string const& lines : {std::string(), std::string("Upgrade: websocket\r\nConnection: Upgrade\r\n")}) {
            std::string const answer = running.ask("GET " + running.page() + " HTTP/1.1\r\n" + hosts + lines + "\r\n");
            EXPECT_TRUE(has_status(answer, 403)) << hosts << answer;
            EXPECT_TRUE(test::has(body_of(answer), "http://" + running.host()));
        }
    }
    EXPECT_TRUE(running.events().empty());
}

TEST(Requests, OfForeignPagesAreForbidden) {
    Running running;
    std::string const port = ":" + std::to_string(running.port());
    for (std::string const& origin :
         {std::string("http://evil.example"), std::string("null"), std::string(), std::string("http://127.0.0.1"),
          "https://127.0.0.1" + port, "http://127.0.0.1" + port + ".evil.example", "http://127.0.0.1" + port + "0",
          "http://127.0.0.1" + port + "\r\nOrigin: http://evil.example"}) {
        std::string const line = "Origin: " + origin + "\r\n";
        EXPECT_TRUE(has_status(running.ask(running.head(running.page(), line)), 403)) << origin;
        EXPECT_TRUE(has_status(running.ask(running.upgrade(line)), 403)) << origin;
    }
    EXPECT_TRUE(running.events().empty());
    EXPECT_TRUE(
        has_status(running.ask(running.head(running.page(), "Origin: http://" + running.host() + "\r\n")), 200));
}

TEST(Requests, OfOtherMethodsAreRefused) {
    Running running;
    for (char const* const method : {"POST", "PUT", "DELETE", "OPTIONS", "TRACE", "PATCH", "PROPFIND", "BREW", "get"}) {
        std::string const answer = running.ask(running.head(running.page(), "", method));
        EXPECT_TRUE(has_status(answer, 405)) << method << answer;
        EXPECT_TRUE(test::has(answer, "\r\nAllow: GET, HEAD\r\n", "GET and HEAD"));
    }
    EXPECT_TRUE(running.events().empty());
}

TEST(Requests, HaveNoBody) {
    Running running;
    std::string const head = running.head(running.page(), "Content-Length: 1000000000\r\n");
    std::string const answer = running.ask(head);
    EXPECT_TRUE(has_status(answer, 413)) << answer << "before any of it is sent";
    EXPECT_TRUE(has_status(
        running.ask(running.head(running.page(), "Transfer-Encoding: chunked\r\n") + "5\r\nhello\r\n"), 413));
    for (std::string const& lines :
         {std::string("Content-Length: 1000000000\r\n"), std::string("Transfer-Encoding: chunked\r\n")}) {
        for (char const* const method : {"GET", "POST"}) {
            RawClient const client(running.port());
            client.send(running.head(running.page(), lines, method));
            std::string const piece(1 << 20, '0');
            std::size_t sent = 0;
            while (client.send(piece) == piece.size() && sent < 1000000000) {
                sent += piece.size();
            }
            EXPECT_LT(sent, 50000000U) << "what is more than the system's buffers is read";
        }
    }
    EXPECT_TRUE(running.events().empty());
    EXPECT_TRUE(running.gives_back());
}

TEST(Requests, NoBadPathReachesTheHandler) {
    Running running;
    for (char const* const path : {"/..",
                                   "/../etc/passwd",
                                   "/a/../b",
                                   "/a/..",
                                   "/./a",
                                   "/.",
                                   "/.git/config",
                                   "/a/.b",
                                   "//etc/passwd",
                                   "/a//b",
                                   "/a/",
                                   "/%2e%2e/etc/passwd",
                                   "/%2E%2E%2Fetc",
                                   "/..%2fetc",
                                   "/%252e%252e/etc",
                                   "/a%00b",
                                   "/a%2fb",
                                   "/a\\b",
                                   "/..\\..\\x",
                                   "/%5c..%5c",
                                   "/a b",
                                   "/C:/x",
                                   "/a;b",
                                   "/\xc3\xa9",
                                   "/\xc0\xae\xc0\xae/",
                                   "/a~",
                                   "http://127.0.0.1/a",
                                   "a",
                                   "*",
                                   ""}) {
        std::string const answer = running.ask(running.head(path + ("?token=" + running.token())));
        EXPECT_TRUE(has_status(answer, 400)) << path << answer;
    }
    EXPECT_TRUE(running.events().empty());
    EXPECT_TRUE(has_status(running.ask(running.head("/a..b/c.d-e_F9?token=" + running.token())), 404));
    EXPECT_EQ(running.events(), std::vector<std::string>{"get a..b/c.d-e_F9"});
}

TEST(Requests, WhateverThePathTheHandlerGetsACleanOne) {
    Running const running;
    std::vector<std::string> const pieces{"/",   "/",     ".",   "..",  "a",  "B9",       "-_",
                                          "%2e", "%252e", "%2f", "%00", "\\", "\xc3\xa9", "~"};
    ASSERT_TRUE(rc::check("a path is clean or refused", [&] {
        std::string path = "/";
        for (std::string const& piece : *rc::gen::container<std::vector<std::string>>(rc::gen::elementOf(pieces))) {
            path += piece;
        }
        bool is_clean = path.find_first_not_of("aB9-_./") == std::string::npos &&
                        path.find("//") == std::string::npos && path.find("/.") == std::string::npos;
        is_clean = is_clean && (path == "/" || path.back() != '/');
        std::string const answer = running.ask(running.head(path + "?token=" + running.token()));
        RC_ASSERT(has_status(answer, !is_clean ? 400 : path == "/" ? 200 : 404));
    }));
}

TEST(Requests, ThatAreNoneAreRefused) {
    Running const running;
    for (std::string const& bytes :
         {std::string("hello\r\n\r\n"), std::string("\r\n\r\n"),
          std::string("\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03", 11), std::string("GET / HTTP/9.9\r\n\r\n"),
          running.head(running.page(), "no colon\r\n"), running.head("/\x01"),
          running.head(running.page(), "Content-Length: -1\r\n"),
          running.head(running.page(), "Content-Length: 1\r\nContent-Length: 2\r\n"),
          running.head(running.page(), "X: a\rb\r\n"), std::string("SSH-2.0-OpenSSH_9.2\r\n\r\n")}) {
        std::string const answer = running.ask(bytes);
        EXPECT_TRUE(has_status(answer, 400)) << bytes << answer;
    }
    std::string const answer = running.ask(running.head(running.page(), "X: " + std::string(100000, 'x') + "\r\n"));
    EXPECT_TRUE(has_status(answer, 431)) << answer;
    EXPECT_TRUE(has_status(running.ask(std::string(100000, 'x')), 431)) << "a method without end";
    EXPECT_TRUE(has_status(running.ask("GET /" + std::string(100000, 'x')), 431)) << "a target without end";
}

TEST(Requests, HalfSentOnesTimeOut) {
    Running const running({.request_time = std::chrono::milliseconds(100)});
    for (std::string const& part : {std::string(), std::string("GE"), running.head("/").substr(0, 30)}) {
        EXPECT_EQ(running.ask(part), "") << "closed without a word, as the time is over";
    }
    RawClient left(running.port());
    left.send("GET ");
    left.end_sending();
    EXPECT_NO_THROW(left.read_all());
}

TEST(Requests, AFileThatCannotBeReadIsAnsweredInWords) {
    ServeParams const params;
    Server server(params, {.get = [](std::string const& path) -> std::optional<Answer> {
                      if (path == "gone") {
                          throw BadInput("test.answer", "gone is no longer there");
                      }
                      if (path == "large") {
                          throw std::bad_alloc();
                      }
                      return Answer{.bytes = "page"};
                  }});
    std::jthread const thread([&](std::stop_token const& stop) { server.run(stop); });
    std::string const address = server.address();
    std::string const host = address.substr(7, address.find("/?") - 7);
    auto const answer = [&](std::string const& path) {
        RawClient client(std::stoi(host.substr(host.find(':') + 1)));
        client.send("GET /" + path + "?token=" + params.token + " HTTP/1.1\r\nHost: " + host + "\r\n\r\n");
        return client.read_all();
    };
    std::string const gone = answer("gone");
    EXPECT_TRUE(has_status(gone, 404) && test::has(gone, "gone is no longer there")) << gone;
    EXPECT_TRUE(has_status(answer("large"), 500));
    EXPECT_TRUE(has_status(answer(""), 200)) << "it serves on";
}

TEST(Requests, AThrowingHandlerEndsRun) {
    ServeParams const params;
    Server server(params, {.get = [](std::string const&) -> std::optional<Answer> {
                      throw std::logic_error("a fault of ours");
                  }});
    auto run = std::async(std::launch::async, [&] { server.run({}); });
    std::string const address = server.address();
    std::string const host = address.substr(7, address.find("/?") - 7);
    RawClient const client(std::stoi(host.substr(host.find(':') + 1)));
    client.send("GET /?token=" + params.token + " HTTP/1.1\r\nHost: " + host + "\r\n\r\n");
    EXPECT_EQ(test::message_of<std::logic_error>([&] { run.get(); }), "a fault of ours");
    server.send_text(everyone, "nobody is there");
}

TEST(Requests, WithoutHandlersFindNothing) {
    ServeParams const params;
    Server server(params, {});
    std::jthread const thread([&](std::stop_token const& stop) { server.run(stop); });
    std::string const address = server.address();
    std::string const host = address.substr(7, address.find("/?") - 7);
    RawClient client(std::stoi(host.substr(host.find(':') + 1)));
    client.send("GET /?token=" + params.token + " HTTP/1.1\r\nHost: " + host + "\r\n\r\n");
    EXPECT_TRUE(has_status(client.read_all(), 404));
}

// The excess is refused in words or closed, and the clients that are there are served.
TEST(Connections, OverTheLimitAreRefused) {
    Running running({.connections = 100});
    std::vector<std::unique_ptr<RawClient>> inside;
    for (int i = 0; i < 100; ++i) {
        inside.push_back(std::make_unique<RawClient>(running.port()));
        ASSERT_TRUE(running.lets_in(*inside.back())) << i;
    }
    for (int i = 0; i < 100; ++i) {
        RawClient outside(running.port());
        outside.send(running.head(running.page()));
        std::string const answer = outside.read_all();
        EXPECT_TRUE(has_status(answer, 503)) << answer;
        EXPECT_TRUE(test::has(answer, "Too many connections", "\r\nX-Content-Type-Options: nosniff\r\n"));
    }
    for (auto const& client : inside) {
        client->send(text_frame("here"));
        EXPECT_EQ(client->read_message().payload, "here");
    }
    inside.pop_back();
    EXPECT_TRUE(running.has_seen("closed 100"));
    bool is_served = false;
    for (int i = 0; i < 1000 && !is_served; ++i) {
        is_served = running.gives_back();
    }
    EXPECT_TRUE(is_served) << "a place is free again";
}

TEST(Connections, WithoutTheTokenKeepNobodyOut) {
    Running running;
    RawClient inside(running.port());
    ASSERT_TRUE(running.lets_in(inside));
    std::vector<std::unique_ptr<RawClient>> strangers; // half-open, all at once
    for (int i = 1; i <= 1000; ++i) {
        strangers.push_back(std::make_unique<RawClient>(running.port()));
        strangers.back()->send(i % 3 == 0 ? "GET /?token=" : i % 3 == 1 ? "" : running.head("/").substr(0, 40));
        if (i % 100 == 0) {
            inside.send(text_frame("here"));
            ASSERT_EQ(inside.read_message().payload, "here") << i;
            EXPECT_TRUE(running.gives_back()) << "a window opens beside " << i;
        }
    }
    EXPECT_TRUE(has_status(running.ask(running.head(running.page())), 200));
}

TEST(SoakConnections, TenThousandDoNotHarm) {
    rlimit files{};
    getrlimit(RLIMIT_NOFILE, &files);
    files.rlim_cur = files.rlim_max;
    setrlimit(RLIMIT_NOFILE, &files);
    std::size_t const most = std::min<std::size_t>(10000, files.rlim_max - 500);
    Running running;
    RawClient inside(running.port());
    ASSERT_TRUE(running.lets_in(inside));
    {
        std::vector<std::unique_ptr<RawClient>> many; // all open at once, most without a word
        while (many.size() < most) {
            many.push_back(std::make_unique<RawClient>(running.port()));
            if (many.size() % 3 == 0) {
                many.back()->send("GET / HTT");
            }
            if (many.size() % 1000 == 0) {
                inside.send(text_frame("here"));
                ASSERT_EQ(inside.read_message().payload, "here") << many.size();
            }
        }
    }
    bool is_served = false;
    for (int i = 0; i < 10000 && !is_served; ++i) {
        is_served = running.gives_back();
    }
    EXPECT_TRUE(is_served);
}
