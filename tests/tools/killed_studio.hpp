// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
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
    /// \param prepare what the child does first
    StartedStudio(
        std::vector<std::string> words, std::filesystem::path const& folder,
        std::function<void()> const& prepare = [] {}, bool no_browser = true)
        : studio_(with_command(std::move(words), no_browser), folder, [this, &prepare] {
              dup2(ends_[1], STDOUT_FILENO);
              prepare();
          }) {
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
    std::vector<std::string> with_command(std::vector<std::string> words, bool no_browser) {
        EXPECT_EQ(pipe(ends_), 0);
        words.insert(words.begin(), "studio");
        if (no_browser) {
            words.emplace_back("--no-browser");
        }
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
    std::size_t rivers = 0;   // on the sheet
    std::size_t features = 0; // pins and ridges on it
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
        Frame next = {1, ""};
        auto const is_answered = [&](std::string const& request) {
            client.send(text_frame(request));
            do {
                next = client.read_message();
            } while (next.opcode != -1 && next.payload.find(R"("type":"reply")") == std::string::npos);
            return next.opcode != -1;
        };
        auto const is_drawn_now = [&](std::string const& what) {
            bool const is = is_answered(R"({"id":2,"do":"draw","what":)" + what + "}");
            EXPECT_TRUE(!is || next.payload.find(R"("ok":true)") != std::string::npos) << next.payload;
            return is;
        };
        for (;;) {
            ++value;
            if (!is_answered(R"({"id":1,"do":"edit","edit":{"steps":[{"set":"seed","value":")" + std::to_string(value) +
                             "\"}]}}")) {
                break;
            }
            answered = value;
            std::int64_t const number = strokes++ % 100;
            is_clearing = number == 0;
            if (is_clearing) { // a new sheet now and then
                if (!is_drawn_now(R"({"verb":"clear"})")) {
                    break;
                }
                rivers = features = 0;
                continue;
            }
            // A river beside the last one, and between them a pin or a ridge.
            std::int64_t const x = 4 + 5 * (number % 50);
            std::int64_t const y = number < 50 ? 20 : 140;
            auto const at = [&](double right, std::int64_t down) {
                return std::to_string(static_cast<double>(x) + right) + "," + std::to_string(y + down);
            };
            if (!is_drawn_now(R"({"verb":"river","points":[)" + at(0, 0) + "," + at(0, 60) + "]}")) {
                break;
            }
            ++rivers;
            if (!is_drawn_now(number % 2 == 0 ? R"({"verb":"pin","at":[)" + at(2.5, 10) + R"(],"height":300})"
                                              : R"({"verb":"ridge","points":[)" + at(2.5, 5) + "," + at(2.5, 25) +
                                                    R"(],"from":)" + std::to_string(number) + "}")) {
                break;
            }
            ++features;
        }
        EXPECT_EQ(studio.process().wait(30.0).code, -SIGKILL);
        DocumentFolder const document(folder);
        auto const kept = static_cast<std::int64_t>(document.document().recipe.seed);
        if (answered > 0) {
            EXPECT_TRUE(kept == answered || kept == answered + 1) << kept << " " << answered;
        }
        EXPECT_LE(kept, value);
        recipe::Recipe const& recipe = document.document().recipe;
        if (is_drawn(recipe)) { // what is named is whole
            Drawing const kept_drawing = read_drawing(recipe, *grid_of(recipe));
            std::size_t const there = kept_drawing.rivers.size();
            EXPECT_TRUE(there == rivers || there == rivers + 1 || (is_clearing && there == 0))
                << there << " " << rivers;
            std::size_t const kept_features = kept_drawing.pins.size() + kept_drawing.ridges.size();
            EXPECT_TRUE(kept_features == features || kept_features == features + 1 ||
                        (is_clearing && kept_features == 0))
                << kept_features << " " << features;
            features = kept_features;
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
