// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Messages over real sockets.
#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/serve/serve.hpp>

#include "running.hpp"

using namespace thalweg;
using namespace thalweg::serve;

TEST(Clients, AreLetInAtTheAddressOfThePage) {
    Running running;
    RawClient client(running.port());
    client.send(
        running.upgrade("Origin: http://" + running.host() + "\r\nSec-WebSocket-Extensions: permessage-deflate\r\n"));
    std::string const answer = client.read_until("\r\n\r\n");
    EXPECT_TRUE(test::has(answer, "HTTP/1.1 101 ", "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=")) << "of RFC 6455, section 1.3";
    EXPECT_EQ(answer.find("deflate"), std::string::npos) << "it is slower than the network";
    EXPECT_TRUE(running.has_seen("opened 1"));
    client.send(frame(0x82, std::string("\0\xff", 2)));
    Frame const back = client.read_message();
    EXPECT_EQ(back.opcode, 2);
    EXPECT_EQ(back.payload, std::string("\0\xff", 2));
    client.send(frame(0x88, "\x03\xe8"));
    EXPECT_EQ(client.read_message().code(), 1000);
    client.end_sending();
    EXPECT_TRUE(running.has_seen("closed 1: it left"));
    std::string const elsewhere = running.ask("GET /a/b.txt" + running.upgrade().substr(5));
    EXPECT_TRUE(test::has(elsewhere, "HTTP/1.1 404 "));
}

TEST(Clients, MessagesGoToOneOrToAll) {
    Running running;
    RawClient first(running.port());
    RawClient second(running.port());
    ASSERT_TRUE(running.lets_in(first) && running.has_seen("opened 1"));
    ASSERT_TRUE(running.lets_in(second) && running.has_seen("opened 2"));
    running.server().send_text(2, "to the second");
    running.server().send_text(everyone, "to all");
    running.server().send_binary(everyone, "");
    running.server().send_text(3, "to nobody");
    EXPECT_EQ(second.read_message().payload, "to the second");
    for (RawClient* const client : {&first, &second}) {
        EXPECT_EQ(client->read_message().payload, "to all");
        Frame const empty = client->read_message();
        EXPECT_EQ(empty.opcode, 2);
        EXPECT_EQ(empty.payload, "");
    }
}

TEST(Clients, MessagesOfAThreadKeepTheirOrder) {
    Running running;
    RawClient client(running.port());
    ASSERT_TRUE(running.lets_in(client) && running.has_seen("opened 1"));
    std::vector<std::jthread> threads;
    for (int t = 0; t < 4; ++t) {
        threads.emplace_back([&, t] {
            for (int i = 0; i < 500; ++i) {
                running.server().send_text(everyone, std::to_string(t) + " " + std::to_string(i));
            }
        });
    }
    std::map<int, int> next;
    for (int i = 0; i < 2000; ++i) {
        std::string const message = client.read_message().payload;
        ASSERT_GT(message.size(), 2U);
        ASSERT_EQ(std::stoi(message.substr(2)), next[std::stoi(message)]++) << message;
    }
}

TEST(Clients, GarbageClosesOneConnection) {
    Running running;
    RawClient other(running.port());
    ASSERT_TRUE(running.lets_in(other));
    struct Case {
        char const* what;
        std::string bytes;
        int code;
    };
    for (Case const& bad : {Case{"an opcode that is none", frame(0x83, "a"), 1002},
                            {"no mask",
                             "\x81\x01"
                             "a",
                             1002},
                            {"a bit of an extension", frame(0xc1, "a"), 1002},
                            {"text that is no UTF-8", text_frame("\xff\xfe"), 1007},
                            {"a ping in parts", frame(0x09, "a"), 1002},
                            {"a long ping", frame(0x89, std::string(126, 'a')), 1002},
                            {"a part of nothing", frame(0x80, "a"), 1002},
                            {"a message in a message", frame(0x01, "a") + frame(0x81, "b"), 1002},
                            {"a code that is none", frame(0x88, "\x03\xee"), 1002},
                            {"a request", running.head(running.page()), 1002}}) {
        RawClient client(running.port());
        ASSERT_TRUE(running.lets_in(client));
        client.send(bad.bytes);
        EXPECT_EQ(client.read_message().code(), bad.code) << bad.what;
        EXPECT_EQ(client.read_message().opcode, -1) << bad.what;
        other.send(text_frame("still here"));
        EXPECT_EQ(other.read_message().payload, "still here") << bad.what;
    }
}

TEST(Clients, RandomBytesHarmNobody) {
    Running running;
    RawClient other(running.port());
    ASSERT_TRUE(running.lets_in(other));
    ASSERT_TRUE(rc::check("random bytes affect one connection only", [&] {
        std::string const bytes = *rc::gen::container<std::string>(rc::gen::arbitrary<char>());
        RawClient client(running.port());
        RC_ASSERT(running.lets_in(client));
        client.send(bytes);
        client.end_sending();
        client.read_all();
        other.send(text_frame("still here"));
        RC_ASSERT(other.read_message().payload == "still here");
    }));
}

TEST(Clients, LongMessagesCloseTheConnection) {
    Running running({.message_bytes = 1000});
    std::string const huge = std::string("\x82\xff\0\0\1\0\0\0\0\0", 10) + "mask";
    for (std::string const& bytes : {frame(0x82, std::string(1001, 'a')),
                                     frame(0x02, std::string(600, 'a')) + frame(0x80, std::string(600, 'a')), huge}) {
        RawClient client(running.port());
        ASSERT_TRUE(running.lets_in(client));
        client.send(frame(0x82, std::string(1000, 'a')));
        EXPECT_EQ(client.read_message().payload.size(), 1000U);
        client.send(bytes);
        EXPECT_EQ(client.read_message().code(), 1009) << "too big";
    }
    EXPECT_TRUE(running.has_seen("closed 3"));
    EXPECT_TRUE(running.gives_back());
}

TEST(Clients, WhoDoesNotReadIsDropped) {
    Running running({.queue_bytes = 8 << 20});
    RawClient lazy(running.port());
    RawClient other(running.port());
    ASSERT_TRUE(running.lets_in(lazy) && running.has_seen("opened 1"));
    ASSERT_TRUE(running.lets_in(other) && running.has_seen("opened 2"));
    for (int i = 0; i < 100; ++i) { // more than the system's buffers and the queue take
        running.server().send_binary(1, std::string(1 << 20, 'a'));
    }
    EXPECT_TRUE(running.has_seen("closed 1: it reads too slowly"));
    running.server().send_binary(everyone, std::string(4 << 20, 'b'));
    EXPECT_EQ(other.read_message().payload, std::string(4 << 20, 'b'));
    running.server().send_text(2, std::string(9 << 20, 'c'));
    EXPECT_TRUE(running.has_seen("closed 2: it reads too slowly")) << "no queue holds it";
}

TEST(Clients, EmptyMessagesFillNoMemoryEither) {
    Running running({.queue_bytes = 1 << 20});
    RawClient lazy(running.port());
    ASSERT_TRUE(running.lets_in(lazy) && running.has_seen("opened 1"));
    for (int i = 0; i < 20000 && running.events().size() == 1; ++i) {
        for (int k = 0; k < 1000; ++k) {
            running.server().send_text(1, "");
        }
    }
    EXPECT_TRUE(running.has_seen("closed 1: it reads too slowly"));
}

TEST(Clients, HalfSentFramesTimeOut) {
    Running running({.silence = std::chrono::milliseconds(200)});
    RawClient client(running.port());
    ASSERT_TRUE(running.lets_in(client));
    client.send(text_frame("hello").substr(0, 8));
    EXPECT_NO_THROW(client.read_all());
    EXPECT_TRUE(running.has_seen("closed 1"));
    EXPECT_TRUE(running.gives_back());
}

TEST(Clients, HalfAHandshakeTimesOut) {
    Running const running({.request_time = std::chrono::milliseconds(100)});
    EXPECT_EQ(running.ask(running.upgrade().substr(0, 90)), "");
    std::string const old =
        running.head(running.page(), "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 8\r\n");
    EXPECT_TRUE(test::has(running.ask(old), "HTTP/1.1 4"));
}

TEST(Clients, AreToldWhenTheServerStops) {
    Running running({.queue_bytes = 1 << 30});
    RawClient polite(running.port());
    RawClient lazy(running.port());
    RawClient half(running.port());
    ASSERT_TRUE(running.lets_in(polite) && running.has_seen("opened 1"));
    ASSERT_TRUE(running.lets_in(lazy) && running.has_seen("opened 2"));
    half.send("GET / ");
    for (int i = 0; i < 100; ++i) {
        running.server().send_binary(2, std::string(1 << 20, 'a'));
    }
    std::jthread reader([&] {
        Frame const last = polite.read_message();
        EXPECT_EQ(last.code(), 1001) << "going away";
        EXPECT_TRUE(test::has(last.payload, "the program ends"));
        polite.send(frame(0x88, "\x03\xe9"));
    });
    running.stop();
    EXPECT_TRUE(running.has_seen("closed 1: "));
    EXPECT_TRUE(running.has_seen("closed 2: the program ends"));
    EXPECT_EQ(running.events().size(), 4U) << "each is closed once";
    running.server().send_text(everyone, "nobody is there");
}

TEST(Clients, AStopBeforeTheStartEndsAtOnce) {
    Server server({}, {});
    std::stop_source source;
    source.request_stop();
    server.run(source.get_token());
}

TEST(SoakClients, StopTakesLessThanTwoSeconds) {
    for (int round = 0; round < 5; ++round) {
        Running running({.connections = 200, .queue_bytes = 1 << 30});
        std::vector<std::unique_ptr<RawClient>> clients;
        for (int i = 0; i < 200; ++i) {
            clients.push_back(std::make_unique<RawClient>(running.port()));
            ASSERT_TRUE(i % 2 == 0 ? running.lets_in(*clients.back()) : clients.back()->send("GET / ") > 0);
        }
        for (int i = 0; i < 20; ++i) {
            running.server().send_binary(everyone, std::string(1 << 20, 'a')); // nobody reads
        }
        auto const begin = std::chrono::steady_clock::now();
        running.stop();
        EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(), 2.0);
    }
}

TEST(SoakClients, WhoDoNotReadLeaveMemoryAlone) {
    Running running({.queue_bytes = 4 << 20});
    for (int round = 1; round <= 50; ++round) {
        RawClient lazy(running.port());
        ASSERT_TRUE(running.lets_in(lazy) && running.has_seen("opened " + std::to_string(round)));
        for (int i = 0; i < 200; ++i) {
            running.server().send_binary(everyone, std::string(1 << 20, 'a'));
        }
        ASSERT_TRUE(running.has_seen("closed " + std::to_string(round)));
    }
    std::string const status = test::bytes_of("/proc/self/status");
    EXPECT_LT(std::stol(status.substr(status.find("VmHWM:") + 6)), 1000000) << "[KB] of 10 GB that were sent";
}
