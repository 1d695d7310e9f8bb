// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Large messages to a client by a library.
#include <cstdint>
#include <string>
#include <utility> // Boost.Asio 1.74 needs it

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket.hpp>
#include <gtest/gtest.h>

#include "running.hpp"

namespace beast_test {

namespace asio = boost::asio;
namespace beast = boost::beast;

std::string pattern(std::uint32_t size) {
    std::string bytes;
    for (std::uint32_t i = 0; i < size; ++i) {
        bytes += static_cast<char>(i * 2654435761U >> 24U);
    }
    return bytes;
}

} // namespace beast_test

TEST(BeastClient, LargeMessagesComeBackAsTheyWere) {
    using namespace beast_test;
    Running const running;
    asio::io_context io;
    beast::websocket::stream<asio::ip::tcp::socket> client(io);
    client.read_message_max(0);
    client.next_layer().connect({asio::ip::address_v4::loopback(), static_cast<std::uint16_t>(running.port())});
    client.handshake(running.host(), running.page());
    for (std::uint32_t const size : {0U, 1U, 125U, 126U, 65535U, 65536U, 4U << 20U}) {
        for (bool const is_text : {false, true}) {
            std::string const sent = is_text ? std::string(size, 'x') : pattern(size);
            client.text(is_text);
            client.write(asio::buffer(sent));
            beast::flat_buffer received;
            client.read(received);
            EXPECT_EQ(client.got_text(), is_text);
            EXPECT_TRUE(beast::buffers_to_string(received.data()) == sent) << size;
        }
    }
    client.close(beast::websocket::close_code::normal);
}
