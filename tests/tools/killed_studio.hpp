// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <random>
#include <signal.h> // NOLINT(modernize-deprecated-headers): kill is of POSIX
#include <string>
#include <thread>
#include <unistd.h>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <serve/raw_client.hpp>

#include <thalweg/studio/document_folder.hpp>
#include <thalweg/studio/drawing_files.hpp>

#include "command.hpp"
#include "spawned.hpp"

/// A studio that a test started.
class StartedStudio {
public:
    /// \param words after "studio"
    StartedStudio(std::vector<std::string> words, std::filesystem::path const& folder)
        : studio_(with_command(std::move(words)), folder, [this] { dup2(ends_[1], STDOUT_FILENO); }) {
        close(ends_[1]);
        for (char c = 0; read(ends_[0], &c, 1) == 1 && c != '\n';) {
            address_ += c;
        }
        close(ends_[0]);
    }

    /// What it printed first: its address.
    std::string const& address() const { return address_; }
    int port() const { return std::stoi(address_.substr(address_.rfind(':') + 1)); }
    Spawned& process() { return studio_; }
    /// Lets a window in.
    bool opens(RawClient& client) const {
        client.send("GET " + address_.substr(address_.find('/', address_.rfind(':'))) +
                    " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port()) +
                    "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                    "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n");
        return client.read_until("\r\n\r\n").starts_with("HTTP/1.1 101 ");
    }

private:
    std::vector<std::string> with_command(std::vector<std::string> words) {
        EXPECT_EQ(pipe(ends_), 0);
        words.insert(words.begin(), "studio");
        words.emplace_back("--no-browser");
        return words;
    }

    int ends_[2] = {-1, -1};
    std::string address_;
    Spawned studio_;
};

/// Edits through the page's socket as fast as answers come, kills the studio with SIGKILL at moments at random, and
/// opens the document again: every edit that was answered must be there, and it must be one that was asked for.
inline void kill_studio_while_editing(int kills, std::uint64_t seed) {
    using namespace thalweg;
    using namespace thalweg::studio;
    Workplace const place;
    std::string const folder = (place.path() / "doc").string();
    new_sheet(folder);
    DocumentFolder(folder).edit({"", {SetKey{"grid.width", "256"}, SetKey{"grid.height", "256"}}});
    std::mt19937_64 random(seed);
    std::int64_t value = 1000; // the seed of the recipe counts the edits
    std::int64_t strokes = 0;
    std::size_t rivers = 0; // on the sheet
    for (int round = 0; round < kills; ++round) {
        SCOPED_TRACE(testing::Message() << "seed " << seed << ", kill " << round);
        StartedStudio studio({"doc", "-q"}, place.path());
        ASSERT_TRUE(studio.address().starts_with("http://127.0.0.1:")) << studio.address();
        RawClient client(studio.port());
        ASSERT_TRUE(studio.opens(client));
        std::jthread const killer([&, wait = std::chrono::microseconds(random() % 400'000)] {
            std::this_thread::sleep_for(wait);
            kill(studio.process().pid(), SIGKILL);
        });
        std::int64_t answered = 0;
        bool is_clearing = false;
        for (Frame next = {1, ""}; next.opcode != -1;) {
            ++value;
            client.send(text_frame(R"({"id":1,"do":"edit","edit":{"steps":[{"set":"seed","value":")" +
                                   std::to_string(value) + "\"}]}}"));
            do {
                next = client.read_message();
            } while (next.opcode != -1 && next.payload.find(R"("type":"reply")") == std::string::npos);
            answered = next.opcode != -1 ? value : answered;
            if (next.opcode != -1) { // a river beside the last one, on a new sheet now and then
                std::int64_t const number = strokes++ % 100;
                is_clearing = number == 0;
                std::string const x = std::to_string(4 + 5 * (number % 50));
                std::string const y = number < 50 ? "20" : "140";
                client.send(text_frame(number == 0
                                           ? R"({"id":2,"do":"draw","what":{"verb":"clear"}})"
                                           : R"({"id":2,"do":"draw","what":{"verb":"river","points":[)" + x + "," + y +
                                                 "," + x + "," + std::to_string(std::stoi(y) + 60) + "]}}"));
                do {
                    next = client.read_message();
                } while (next.opcode != -1 && next.payload.find(R"("type":"reply")") == std::string::npos);
                EXPECT_TRUE(next.opcode == -1 || next.payload.find(R"("ok":true)") != std::string::npos)
                    << next.payload;
                rivers = next.opcode == -1 ? rivers : number == 0 ? 0 : rivers + 1;
            }
        }
        EXPECT_EQ(studio.process().wait(30.0).code, -SIGKILL);
        DocumentFolder const document(folder);
        auto const kept = static_cast<std::int64_t>(document.document().recipe.seed);
        if (answered > 0) {
            EXPECT_TRUE(kept == answered || kept == answered + 1) << kept << " " << answered;
        }
        EXPECT_LE(kept, value);
        pipeline::Recipe const& recipe = document.document().recipe;
        if (is_drawn(recipe)) { // what is named is whole
            std::size_t const there = read_drawing(recipe, *grid_of(recipe)).rivers.size();
            EXPECT_TRUE(there == rivers || there == rivers + 1 || (is_clearing && there == 0))
                << there << " " << rivers;
            strokes -= is_clearing && there > 0 ? 1 : 0; // it was not cleared
            rivers = there;
        }
    }
    DocumentFolder document(folder);
    std::int64_t undone = 0;
    while (document.undo()) {
        ++undone;
    }
    EXPECT_GT(undone, 0);
    EXPECT_EQ(document.document().recipe.seed, 7U) << "the first";
    while (document.redo()) {
        --undone;
    }
    EXPECT_EQ(undone, 0);
}
