// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/studio/studio.hpp>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <random>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <serve/raw_client.hpp>
#include <support.hpp>
#include <zero_height.hpp>

#include <thalweg/commands/make.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/recipe/presets.hpp>
#include <thalweg/studio/document_folder.hpp>
#include <thalweg/studio/drawing_files.hpp>
#include <thalweg/studio/internal/messages.hpp>

#include "random_draw.hpp"
#include "random_edits.hpp"

namespace studio_test {

using namespace thalweg;
using namespace thalweg::studio;

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

std::string const land = "[grid]\nwidth = 72\nheight = 64\n[network]\nsource = \"forest\"\nprune = 6\n"
                         "[network.forest]\noutlet_spacing = 40\nspacing = 8\n[surface]\n";

/// A studio that runs.
class Running {
public:
    explicit Running(StudioParams params)
        : token_(params.serve.token), studio_(std::move(params)),
          thread_([this](std::stop_token const& stop) { studio_.run(stop); }) {}

    int port() const {
        std::string const address = studio_.address();
        return std::stoi(address.substr(address.rfind(':') + 1));
    }
    std::string head(std::string const& target, std::string const& lines = "") const {
        return "GET " + target + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port()) + "\r\n" + lines + "\r\n";
    }
    std::string with_token(std::string const& path) const { return path + "?token=" + token_; }
    std::string ask(std::string const& target) const {
        RawClient client(port());
        client.send(head(target));
        return client.read_all();
    }

private:
    std::string const token_;
    Studio studio_;
    std::jthread thread_;
};

/// A window on a studio.
class Window {
public:
    explicit Window(Running const& studio) : client_(studio.port()) {
        client_.send(studio.head(studio.with_token("/"),
                                 "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                                 "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"));
        EXPECT_TRUE(client_.read_until("\r\n\r\n").starts_with("HTTP/1.1 101 "));
    }

    /// The next text message of a type; null: the connection ended.
    json next(std::string const& type) {
        for (;;) {
            Frame const frame = client_.read_message();
            if (frame.opcode == -1 || frame.opcode == 8) {
                return nullptr;
            }
            json message = frame.opcode == 1 ? json::parse(frame.payload) : json();
            if (frame.opcode == 1 && message["type"] == "drawing") {
                drawing_ = message;
            }
            if (frame.opcode == 1 && message["type"] == "findings") {
                findings_ = message["list"];
            }
            if (frame.opcode == 1 && message["type"] == "idle") {
                idle_ = message;
            }
            if (frame.opcode == 1 && message["type"] == type) {
                return message;
            }
        }
    }
    /// What is drawn, as it was told last.
    json const& drawing() const { return drawing_; }
    /// The kinds and texts of the warnings of the last job.
    std::vector<std::pair<std::string, std::string>> warnings() const {
        std::vector<std::pair<std::string, std::string>> found;
        for (json const& finding : findings_) {
            if (finding["severity"] == "warning") {
                found.emplace_back(finding["kind"], finding["text"]);
            }
        }
        return found;
    }
    json draw(json const& what) { return ask(json{{"id", 1}, {"do", "draw"}, {"what", what}}.dump()); }
    /// Waits until the terrain of a revision is there, unless that was told before another answer; what was told of it.
    json wait_for(std::int64_t revision) {
        while (!idle_.is_null() && (idle_["revision"] != revision || idle_["job"] == 0)) {
            idle_ = next("idle");
        }
        EXPECT_FALSE(idle_.is_null());
        return idle_;
    }
    void send(std::string const& text) const { client_.send(text_frame(text)); }
    json ask(std::string const& text) {
        send(text);
        return next("reply");
    }
    json set(std::string const& key, std::string const& value, std::string const& how = "edit") {
        return ask(json{{"id", 1}, {"do", how}, {"edit", {{"steps", {{{"set", key}, {"value", value}}}}}}}.dump());
    }

private:
    RawClient client_;
    json drawing_;
    json findings_ = json::array();
    json idle_{{"revision", -1}, {"job", 0}};
};

/// A drawing as the page has it.
Drawing drawing_in(json const& message) {
    Drawing drawing;
    json const& of = message["grid"];
    drawing.grid = {of["width"], of["height"], of["cell_m"], of["west"], of["north"], of["crs"]};
    auto const line_in = [&](json const& numbers) {
        DrawnLine line;
        for (std::size_t i = 0; i + 1 < numbers.size(); i += 2) {
            line.push_back({drawing.grid.west + numbers[i].get<double>() * drawing.grid.cell_m,
                            drawing.grid.north - numbers[i + 1].get<double>() * drawing.grid.cell_m});
        }
        return line;
    };
    for (json const& river : message["rivers"]) {
        drawing.rivers.push_back({line_in(river["line"]), river["type"], river["lambda"]});
    }
    for (json const& coast : message["coasts"]) {
        drawing.coasts.push_back(line_in(coast));
    }
    for (json const& lake : message["lakes"]) {
        drawing.lakes.push_back({{line_in(lake["ring"])}, std::nullopt});
    }
    for (json const& mask : message["masks"]) {
        drawing.masks.push_back(line_in(mask));
    }
    for (json const& pin : message["pins"]) {
        drawing.pins.push_back({line_in(pin["at"]).front(), pin["height"]});
    }
    for (json const& ridge : message["ridges"]) {
        drawing.ridges.push_back({line_in(ridge["line"]), {}});
    }
    return drawing;
}

class Studios : public testing::Test {
protected:
    Studios() {
        test::write(at("land.toml"), land);
        new_document(at("doc"), at("land.toml"));
    }
    std::string at(std::string const& name) const { return (folder_.path() / name).string(); }
    StudioParams params() const { return {.folder = at("doc"), .threads = 2}; }
    std::string recipe() const { return test::bytes_of(at("doc/recipe.toml")); }

    io::TemporaryFolder folder_{"thalweg-studio"};
};

class SoakStudios : public Studios {};

// Warnings belong to a terrain, whether its stages were run or their results were kept, and whoever comes to see it.
TEST_F(Studios, FindingsAreThoseOfTheTerrainShown) {
    test::write(at("r.geojson"), test::zero_height);
    test::write(at("lines.toml"), "[grid]\ncell = 50\n[network]\nsource = \"lines\"\n[network.lines]\npath = "
                                  "\"r.geojson\"\n[surface]\n");
    new_document(at("rivers"), at("lines.toml"));
    Running const studio({.folder = at("rivers"), .threads = 2});
    Window window(studio);
    std::int64_t revision = window.wait_for(0)["revision"];
    auto const first = window.warnings();
    ASSERT_GE(first.size(), 2U);
    EXPECT_EQ(first[0].first, "placeholder_heights");
    EXPECT_EQ(first[1].first, "filled_heights");
    // Lines are kept; then they are read again; then all is kept.
    for (auto const& [key, value] : {std::pair{"surface.hillslope", "40"}, {"network.lines.snap", "0.5"}}) {
        ASSERT_EQ(window.set(key, value)["ok"], true);
        window.wait_for(++revision);
        EXPECT_EQ(window.warnings(), first) << key;
    }
    ASSERT_EQ(window.ask(R"({"id": 0, "do": "undo"})")["ok"], true);
    window.wait_for(++revision);
    EXPECT_EQ(window.warnings(), first) << "kept";
    Window late(studio);
    late.next("findings");
    EXPECT_EQ(late.warnings(), first) << "late";
}

/// Edits at random through a window, sees now and then that what is exported is what make makes of the saved recipe,
/// then undoes everything and does it again.
void edit_at_random(std::string const& folder, int edits, int compare_every, std::uint64_t seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937_64 random(seed);
    Running const studio({.folder = folder, .threads = 2});
    Window window(studio);
    window.next("drawing");
    auto const recipe = [&] { return test::bytes_of(folder + "/recipe.toml"); };
    std::string const first = recipe();
    int compared = 0;
    int made = 0; // some steps of drawing change nothing, or are refused
    int drawn = 0;
    for (int i = 1; i <= edits; ++i) {
        std::string const before = recipe();
        if (random() % 2 == 0 || drawn == 0) { // later the rivers of a generator may be under way
            json const reply = window.draw(random_draw(drawing_in(window.drawing()), random));
            ASSERT_TRUE(reply["ok"] == true || reply["error"] != "") << reply;
            made += recipe() != before ? 1 : 0;
            drawn += recipe() != before ? 1 : 0;
        } else {
            auto const [edit, after] = random_edit(document_of(before), random);
            bool const sets = std::holds_alternative<SetKey>(edit.steps.front());
            json const step = sets ? json{{"set", std::get<SetKey>(edit.steps.front()).key},
                                          {"value", std::get<SetKey>(edit.steps.front()).value}}
                                   : json{{"unset", std::get<UnsetKey>(edit.steps.front()).key}};
            json const reply = window.ask(json{{"id", i}, {"do", "edit"}, {"edit", {{"steps", {step}}}}}.dump());
            ASSERT_EQ(reply["ok"], true) << step << reply;
            ASSERT_EQ(recipe(), after.toml) << step;
            ++made;
        }
        if (i % compare_every != 0) {
            continue;
        }
        json const written = window.ask(R"({"id": 0, "do": "export"})");
        std::string const error = test::error_of([&] {
            commands::run_make(
                {.input = folder + "/recipe.toml", .output = folder + "/made", .existing = io::Existing::replace});
        });
        ASSERT_EQ(written["ok"].get<bool>(), error.empty()) << written << error;
        for (char const* name : {"dem.tif", "network.gpkg", "recipe.toml"}) {
            bool const is_there = error.empty() && std::filesystem::exists(folder + "/made/" + name);
            if (is_there) {
                ASSERT_EQ(test::bytes_of(folder + "/terrain/" + name), test::bytes_of(folder + "/made/" + name))
                    << name << " after " << i;
                ++compared;
            }
        }
    }
    EXPECT_GT(compared, 0);
    EXPECT_GT(drawn, 0);
    std::string const last = recipe();
    for (int i = 0; i < made; ++i) {
        ASSERT_EQ(window.ask(R"({"id": 0, "do": "undo"})")["ok"], true);
    }
    EXPECT_EQ(recipe(), first);
    for (int i = 0; i < made; ++i) {
        ASSERT_EQ(window.ask(R"({"id": 0, "do": "redo"})")["ok"], true);
    }
    EXPECT_EQ(recipe(), last);
}

} // namespace

TEST_F(Studios, EditsAtRandomAreUndoneAndRedone) {
    edit_at_random(at("doc"), 10, 5, 2);
}

TEST_F(SoakStudios, EditsAtRandomAreUndoneAndRedone) {
    edit_at_random(at("doc"), 200, 10, std::random_device()());
}

TEST_F(Studios, EditUndoAndRedo) {
    Running const studio(params());
    Window window(studio);
    json const first = window.next("document");
    EXPECT_EQ(first["recipe"], recipe());
    EXPECT_EQ(first["undo"], "");

    EXPECT_EQ(window.set("network.prune", "9")["ok"], true);
    std::string const edited = recipe();
    EXPECT_NE(first["recipe"], edited) << "saved before it is answered";
    Window other(studio);
    EXPECT_EQ(other.next("document")["recipe"], edited) << "a second window joins";

    EXPECT_EQ(other.ask(R"({"id": 2, "do": "undo"})")["ok"], true);
    json const undone = window.next("document");
    EXPECT_EQ(undone["recipe"], first["recipe"]) << "and each hears of the other";
    EXPECT_EQ(first["recipe"], recipe());
    EXPECT_EQ(undone["redo"], "network.prune = 9");
    EXPECT_EQ(window.ask(R"({"id": 3, "do": "redo"})")["ok"], true);
    EXPECT_EQ(recipe(), edited);
}

TEST_F(Studios, TriesSaveNothing) {
    Running const studio(params());
    Window window(studio);
    std::string const before = recipe();
    EXPECT_EQ(window.set("network.prune", "9", "try")["ok"], true);
    EXPECT_EQ(recipe(), before);
}

TEST_F(Studios, RefuseInWords) {
    Running const studio(params());
    Window window(studio);
    std::string const before = recipe();
    json const unknown = window.set("network.prunes", "9");
    EXPECT_EQ(unknown["ok"], false);
    EXPECT_TRUE(test::has(unknown["error"].get<std::string>(), "unknown key", "network.prune"));
    EXPECT_TRUE(test::has(window.set("network.dla.sticking", "9")["error"].get<std::string>(), "network.dla.sticking"));
    EXPECT_TRUE(test::has(window.set("surface.mask", "/etc/passwd")["error"].get<std::string>(), "inputs/"));
    EXPECT_EQ(window.ask("no JSON")["ok"], false);
    EXPECT_EQ(window.ask(R"({"id": 5, "do": "export", "file": "../history.jsonl"})")["ok"], false);
    EXPECT_EQ(recipe(), before);
}

TEST_F(Studios, ExportWhatMakeMakes) {
    StudioParams wanted = params();
    wanted.export_folder = at("out");
    Running const studio(wanted);
    Window window(studio);
    window.set("seed", "11");
    json const written = window.ask(R"({"id": 7, "do": "export"})");
    ASSERT_EQ(written["ok"], true) << written;
    EXPECT_EQ(written["folder"], at("out/terrain"));
    commands::run_make({.input = at("doc/recipe.toml"), .output = at("made")});
    for (json const& name : written["files"]) {
        std::string const file = name.get<std::string>();
        if (file != "report.json" && file != "report.html") { // they hold times
            EXPECT_EQ(test::bytes_of(at("out/terrain/" + file)), test::bytes_of(at("made/" + file))) << file;
        }
    }
    EXPECT_EQ(window.ask(R"({"id": 8, "do": "export"})")["ok"], true) << "and again over it";

    json const one = window.ask(R"({"id": 9, "do": "export", "file": "dem.tif"})");
    ASSERT_EQ(one["ok"], true) << one;
    std::string const answer = studio.ask(studio.with_token("/" + one["url"].get<std::string>()));
    EXPECT_TRUE(answer.ends_with(test::bytes_of(at("made/dem.tif"))));
    EXPECT_TRUE(studio.ask(studio.with_token("/files/../recipe.toml")).find(" 200 ") == std::string::npos);
    EXPECT_TRUE(studio.ask(studio.with_token("/files/history.jsonl")).starts_with("HTTP/1.1 404"));
    EXPECT_TRUE(studio.ask("/" + one["url"].get<std::string>()).starts_with("HTTP/1.1 403"));
}

TEST_F(Studios, SayThatAnExportedFileIsGone) {
    Running const studio(params());
    Window window(studio);
    json const one = window.ask(R"({"id": 9, "do": "export", "file": "dem.tif"})");
    ASSERT_EQ(one["ok"], true) << one;
    std::string const url = studio.with_token("/" + one["url"].get<std::string>());
    fs::path const file = fs::path(one["folder"].get<std::string>()) / "dem.tif";
    fs::remove(file);
    EXPECT_TRUE(test::has(studio.ask(url), "HTTP/1.1 404", "no longer there: export it again"));
    fs::create_directory(file);
    EXPECT_TRUE(test::has(studio.ask(url), "HTTP/1.1 404", "no longer there"));
    fs::remove(file);
    fs::create_symlink(at("doc/history.jsonl"), file);
    EXPECT_TRUE(test::has(studio.ask(url), "HTTP/1.1 404")) << "no way out by a link";
    EXPECT_EQ(window.set("seed", "12")["ok"], true) << "the studio goes on";
}

TEST_F(Studios, AnswerHostileStrokesSoon) {
    Running const studio(params());
    Window window(studio);
    Window other(studio);
    window.next("idle");
    auto const stroke = [](int points, auto at) {
        json line = json::array();
        for (int i = 0; i < points; ++i) {
            auto const [x, y] = at(i);
            line.push_back(x);
            line.push_back(y);
        }
        return json{{"verb", "ridge"}, {"points", line}};
    };
    auto const seconds_of = [&](json const& what) {
        auto const begin = std::chrono::steady_clock::now();
        EXPECT_FALSE(window.draw(what).is_null());
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    };
    auto const zigzag = [](int i) { return std::pair(i % 2 == 0 ? 2.0 : 70.0, 2.0 + 60.0 * i / 4000.0); };
    auto const fine = [](int i) { return std::pair(i % 2 == 0 ? 20 : 21, i / 2 % 60); };
    EXPECT_LT(seconds_of(stroke(4000, zigzag)), 1.0);
    EXPECT_LT(seconds_of(stroke(100000, fine)), 1.0);
    EXPECT_LT(seconds_of(stroke(300000, fine)), 1.0);
    EXPECT_EQ(other.set("seed", "12")["ok"], true);
}

TEST_F(Studios, WriteIntoTheDocumentAlone) {
    Running const studio(params());
    Window window(studio);
    window.next("idle");
    fs::create_directory(at("elsewhere"));
    fs::create_directory_symlink(at("elsewhere"), at("doc/terrain"));
    fs::create_directory_symlink(at("elsewhere"), at("doc/.terrain"));
    for (char const* const asked :
         {R"({"id": 7, "do": "export"})", R"({"id": 8, "do": "export", "file": "dem.tif"})"}) {
        json const refused = window.ask(asked);
        EXPECT_EQ(refused["ok"], false);
        EXPECT_TRUE(test::has(refused["error"].get<std::string>(), "is a link")) << refused;
    }
    fs::remove_all(at("doc/inputs"));
    fs::create_directory_symlink(at("elsewhere"), at("doc/inputs"));
    json pin;
    for (double at = 5.5; at < 60.0 && (pin.is_null() || test::has(pin["error"].get<std::string>(), "river")); ++at) {
        pin = window.draw({{"verb", "pin"}, {"at", {at, 20.5}}, {"height", 900}});
    }
    EXPECT_EQ(pin["ok"], false);
    EXPECT_TRUE(test::has(pin["error"].get<std::string>(), "inputs is a link")) << pin;
    EXPECT_TRUE(fs::is_empty(at("elsewhere")));
}

TEST_F(Studios, ServeThePage) {
    Running const studio(params());
    std::string const answer = studio.ask(studio.with_token("/"));
    EXPECT_TRUE(answer.starts_with("HTTP/1.1 200"));
    EXPECT_TRUE(test::has(answer, "connect-src 'self'", "frame-ancestors 'none'", "network.dla.sticking"));
    EXPECT_EQ(answer.find("@@"), std::string::npos) << "every marker is filled";
    EXPECT_TRUE(studio.ask("/").starts_with("HTTP/1.1 403"));
}

TEST_F(Studios, LateWindowsSeeTheTerrain) {
    Running const studio(params());
    Window first(studio);
    first.wait_for(0);
    Window second(studio);
    EXPECT_EQ(second.next("scene")["level"], "measured");
}

TEST_F(Studios, SayHowLongItTookAlsoWhereNothingRan) {
    Running const studio(params());
    Window window(studio);
    window.wait_for(0);
    window.set("seed", "11");
    window.wait_for(1);
    auto const begin = std::chrono::steady_clock::now();
    window.ask(R"({"id": 2, "do": "undo"})");
    json const idle = window.wait_for(2);
    std::chrono::duration<double> const waited = std::chrono::steady_clock::now() - begin;
    EXPECT_LE(idle["seconds"].get<double>(), waited.count());
}

TEST_F(Studios, ExportTheDocumentAfterAStop) {
    Running const studio(params());
    Window window(studio);
    window.ask(R"({"id": 1, "do": "stop"})");
    EXPECT_EQ(window.ask(R"({"id": 2, "do": "export", "file": "dem.tif"})")["ok"], true);
}

TEST_F(Studios, RefuseADocumentThatIsOpen) {
    Running const studio(params());
    EXPECT_TRUE(test::has(test::error_of([&] { Studio twice(params()); }), "open"));
}

TEST_F(Studios, DrawnRiversBecomeTheTerrain) {
    Running const studio(params());
    Window window(studio);
    json const shown = window.next("drawing");
    EXPECT_EQ(shown["kind"], "shown");
    ASSERT_GT(shown["rivers"].size(), 1U);
    std::string const grown = recipe();

    json const erased = window.draw({{"verb", "erase"}, {"river", 0}});
    ASSERT_EQ(erased["ok"], true) << erased;
    EXPECT_TRUE(test::has(erased["said"].dump(), "drawn lines now, ", "undo brings it back"));
    EXPECT_EQ(window.drawing()["kind"], "drawn");
    EXPECT_LT(window.drawing()["rivers"].size(), shown["rivers"].size());
    EXPECT_TRUE(test::has(recipe(), "source = 'lines'", "drawing.gpkg"));

    EXPECT_EQ(window.ask(R"({"id": 2, "do": "undo"})")["ok"], true);
    EXPECT_EQ(recipe(), grown) << "the generator is back";
    EXPECT_EQ(window.next("drawing")["rivers"], shown["rivers"]);

    EXPECT_EQ(window.draw({{"verb", "clear"}})["ok"], true);
    EXPECT_TRUE(window.drawing()["rivers"].empty());
    json const nothing = window.ask(R"({"id": 3, "do": "export"})");
    EXPECT_TRUE(test::has(nothing["error"].get<std::string>(), "no river yet"));
    Window late(studio);
    EXPECT_TRUE(late.next("drawing")["rivers"].empty());
    EXPECT_EQ(late.next("idle")["type"], "idle") << "and no terrain of before";

    ASSERT_EQ(window.draw({{"verb", "river"}, {"points", {36, 5, 36, 60}}})["ok"], true);
    json const second = window.draw({{"verb", "river"}, {"points", {5, 20, 35, 40}}, {"type", "C"}});
    ASSERT_EQ(second["ok"], true) << second;
    json const crossing = window.draw({{"verb", "river"}, {"points", {20, 50, 60, 50}}});
    EXPECT_TRUE(test::has(crossing["error"].get<std::string>(), "cross"));
    EXPECT_NEAR(crossing["at"][0].get<double>(), 36.0, 0.1);
    EXPECT_NEAR(crossing["at"][1].get<double>(), 50.0, 0.1);
    ASSERT_EQ(window.draw({{"verb", "lake"}, {"points", {32, 44, 40, 44, 40, 52, 32, 52}}})["ok"], true);
    json const stale = window.ask(R"({"id": 4, "do": "draw", "revision": 1, "what": {"verb": "clear"}})");
    EXPECT_TRUE(test::has(stale["error"].get<std::string>(), "meanwhile"));
    json const written = window.ask(R"({"id": 5, "do": "export"})");
    ASSERT_EQ(written["ok"], true) << written;
    commands::run_make({.input = at("doc/recipe.toml"), .output = at("made")});
    for (char const* name : {"dem.tif", "network.gpkg", "lakes.tif"}) {
        EXPECT_EQ(test::bytes_of(at("doc/terrain/" + std::string(name))),
                  test::bytes_of(at("made/" + std::string(name))))
            << name;
    }
}

TEST_F(Studios, PinsAndRidgesAreOfTheRecipe) {
    std::string const folder = document_for("", at("sheet"), true);
    auto const toml = [&] { return test::bytes_of(folder + "/recipe.toml"); };
    std::vector<std::string> all;
    json last;
    {
        Running const studio({.folder = folder, .threads = 2});
        Window window(studio);
        window.next("drawing");
        EXPECT_EQ(window.drawing()["pins"], json::array());
        for (json const& what : {json{{"verb", "river"}, {"points", {200, 100, 220, 500}}},
                                 json{{"verb", "pin"}, {"at", {100.25, 200}}, {"height", 900}},
                                 json{{"verb", "ridge"}, {"points", {300, 100, 320, 300}}, {"from", 500.5}},
                                 json{{"verb", "height"}, {"pin", 0}, {"height", 910.5}},
                                 json{{"verb", "heights"}, {"ridge", 0}, {"from", nullptr}, {"to", 30}},
                                 json{{"verb", "erase"}, {"pin", 0}}, json{{"verb", "erase"}, {"ridge", 0}},
                                 json{{"verb", "pin"}, {"at", {100, 200}}, {"height", 5}}, json{{"verb", "clear"}}}) {
            all.push_back(toml());
            json const reply = window.draw(what);
            ASSERT_EQ(reply["ok"], true) << what << reply;
        }
        EXPECT_EQ(all[7], all[1]) << "without pins and ridges the recipe is as before";
        EXPECT_FALSE(test::has(toml(), "skeleton"));
        while (!all.empty()) {
            ASSERT_EQ(window.ask(R"({"id": 1, "do": "undo"})")["ok"], true);
            EXPECT_EQ(toml(), all.back()) << all.size();
            all.pop_back();
        }
        for (int i = 0; i < 5; ++i) {
            ASSERT_EQ(window.ask(R"({"id": 1, "do": "redo"})")["ok"], true);
        }
        EXPECT_EQ(window.drawing()["pins"], json::parse(R"([{"at": [100.25, 200.0], "height": 910.5}])"));
        EXPECT_EQ(window.drawing()["ridges"][0]["to"], 30.0);
        EXPECT_TRUE(window.drawing()["ridges"][0]["from"].is_null());
        json const wet = window.draw({{"verb", "pin"}, {"at", {200, 100}}, {"height", 5}});
        EXPECT_TRUE(test::has(wet["error"].get<std::string>(), "a river runs here"));
        EXPECT_NEAR(wet["at"][0].get<double>(), 200.0, 1e-3);
        last = window.drawing();
    }
    Running const again({.folder = folder, .threads = 2});
    Window window(again);
    json const read = window.next("drawing");
    EXPECT_EQ(read["pins"], last["pins"]);
    EXPECT_EQ(read["ridges"], last["ridges"]);
}

TEST_F(Studios, PinsTakeThePlaceOfRandomPoints) {
    {
        DocumentFolder document(at("doc"));
        document.edit({"", {SetKey{"surface.method", "diffuse"}, SetKey{"skeleton.scatter", "5"}}});
    }
    Running const studio(params());
    Window window(studio);
    window.next("drawing");
    json const reply = window.draw({{"verb", "pin"}, {"at", {1, 1}}, {"height", 5}});
    ASSERT_EQ(reply["ok"], true) << reply;
    EXPECT_TRUE(test::has(reply["said"].dump(), "skeleton.scatter", "undo brings them back"));
    EXPECT_TRUE(test::has(recipe(), "points.gpkg"));
    EXPECT_FALSE(test::has(recipe(), "scatter"));
    EXPECT_EQ(window.ask(R"({"id": 2, "do": "undo"})")["ok"], true);
    EXPECT_TRUE(test::has(recipe(), "scatter = 5"));
}

TEST_F(Studios, PinsWithoutAnEffectAreRefusedInWords) {
    test::write(at("field.toml"), "[grid]\nwidth = 72\nheight = 64\n[statistics]\nstd = 100.0\n");
    new_document(at("field"), at("field.toml"));
    Running const studio({.folder = at("field"), .threads = 2});
    Window window(studio);
    window.next("drawing");
    std::string const before = test::bytes_of(at("field/recipe.toml"));
    for (json const& what : {json{{"verb", "pin"}, {"at", {1, 1}}, {"height", 5}},
                             json{{"verb", "ridge"}, {"points", {30, 20, 40, 20}}}}) {
        json const reply = window.draw(what);
        EXPECT_EQ(reply["ok"], false) << reply;
        EXPECT_TRUE(test::has(reply["error"].get<std::string>(), "skeleton.", "has no effect")) << reply;
        EXPECT_EQ(test::bytes_of(at("field/recipe.toml")), before);
    }
}

TEST_F(Studios, HolesOfMasksStay) {
    Grid const grid{72, 64, 30.0, 500000.0, 5000000.0, "EPSG:32631"};
    auto const ring = [&](double low, double high) {
        double const west = grid.west + low * grid.cell_m;
        double const north = grid.north - low * grid.cell_m;
        double const side = (high - low) * grid.cell_m;
        return DrawnLine{{west, north}, {west + side, north}, {west + side, north - side}, {west, north - side}};
    };
    {
        DocumentFolder document(at("doc"));
        Drawing before;
        before.grid = grid;
        Drawing masked = before;
        masked.masks = {ring(1, 60)};
        masked.mask_islands = {{ring(20, 24)}};
        document.edit(edit_between(
            document.document(), before, {masked, "", {}},
            [&](auto const& key, auto const& name, auto const& write) { return document.put(key, name, write); }));
    }
    {
        Running const studio(params());
        Window window(studio);
        window.next("drawing");
        json const second = window.draw({{"verb", "mask"}, {"points", {62, 2, 70, 2, 70, 10, 62, 10}}});
        ASSERT_EQ(second["ok"], true) << second;
        EXPECT_FALSE(second.contains("said"));
    }
    DocumentFolder document(at("doc"));
    Drawing const read = read_drawing(document.document().recipe, grid);
    ASSERT_EQ(read.mask_islands.size(), 2U);
    EXPECT_EQ(read.mask_islands[0].size(), 1U);
}

TEST_F(Studios, ARasterMaskThatGoesIsTold) {
    {
        DocumentFolder document(at("doc"));
        Mask const mask({72, 64, 30.0, 500000.0, 5000000.0, "EPSG:32631"}, 1);
        document.edit({"", {document.put("surface.mask", "mask.tif", [&](std::string const& path) {
                           io::write_mask(mask, path);
                       })}});
    }
    Running const studio(params());
    Window window(studio);
    window.next("drawing");
    json const drawn = window.draw({{"verb", "mask"}, {"points", {2, 2, 60, 2, 60, 60, 2, 60}}});
    ASSERT_EQ(drawn["ok"], true) << drawn;
    EXPECT_TRUE(test::has(drawn["said"].dump(), "raster", "undo brings it back"));
}

TEST_F(Studios, AnEmptySheetIsDrawnOn) {
    std::string const folder = document_for("", at("sheet"), true);
    EXPECT_TRUE(test::has(test::error_of([&] { document_for(at("land.toml"), "", true); }), "--blank"));
    EXPECT_FALSE(test::error_of([&] { document_for("", at("sheet"), true); }).empty()) << "it is there";
    Running const studio({.folder = folder, .threads = 2});
    Window window(studio);
    EXPECT_EQ(window.next("drawing")["kind"], "drawn");
    EXPECT_EQ(window.drawing()["grid"]["width"], 512);
    EXPECT_EQ(window.draw({{"verb", "river"}, {"points", {200, 100, 220, 505}}})["ok"], true);
    json const failed = window.draw({{"verb", "branching"}, {"on", true}});
    EXPECT_EQ(failed["ok"], true) << failed;
    EXPECT_EQ(window.drawing()["branching"], true);
    window.wait_for(2);
}

// Rivers meander about the lines that are drawn, which stay what they are.
TEST_F(Studios, RiversMeanderAboutDrawnLines) {
    std::string const folder = document_for("", at("sheet"), true);
    Running const studio({.folder = folder, .threads = 2});
    Window window(studio);
    EXPECT_EQ(window.set("grid.width", "128")["ok"], true);
    EXPECT_EQ(window.set("grid.height", "96")["ok"], true);
    auto const sinuosity = [&] { // of the terrain's river, by the length of its line
        window.ask(R"({"id": 7, "do": "export"})");
        auto const report = json::parse(test::bytes_of(folder + "/terrain/report.json"));
        return report["network"]["length_m"].get<double>() / report["given"]["given_m"].get<double>();
    };
    ASSERT_EQ(window.draw({{"verb", "river"}, {"points", {60, 10, 64, 96}}})["ok"], true);
    json const line = window.drawing()["rivers"][0]["line"];
    EXPECT_EQ(line.size(), 4U);
    EXPECT_GT(sinuosity(), 1.05);
    EXPECT_EQ(window.set("network.meander", "0")["ok"], true);
    EXPECT_EQ(window.drawing()["rivers"][0]["line"], line);
    EXPECT_NEAR(sinuosity(), 1.0, 1e-3);
}

// The page lets pins and ridges be drawn up to the border, and snaps them to it.
TEST_F(Studios, WhatIsDrawnOnTheBorderIsExported) {
    std::string const folder = document_for("", at("sheet"), true);
    Running const studio({.folder = folder, .threads = 2});
    Window window(studio);
    EXPECT_EQ(window.set("grid.width", "128")["ok"], true);
    EXPECT_EQ(window.set("grid.height", "96")["ok"], true);
    EXPECT_EQ(window.draw({{"verb", "river"}, {"points", {60, 20, 64, 90}}})["ok"], true);
    for (json const& place : {json{128, 40}, json{20, 96}, json{128, 96}, json{0, 0}, json{140, 10}}) {
        json const pin = window.draw({{"verb", "pin"}, {"at", place}, {"height", 700}});
        EXPECT_EQ(pin["ok"], true) << place << " " << pin;
    }
    json const ridge = window.draw({{"verb", "ridge"}, {"points", {128, 60, 100, 62}}, {"from", 800}, {"to", 600}});
    EXPECT_EQ(ridge["ok"], true) << ridge;
    json const written = window.ask(R"({"id": 7, "do": "export"})");
    EXPECT_EQ(written["ok"], true) << written;
}

// As the page does it: the recipe of a preset takes the place of the document's, by one edit.
TEST_F(Studios, APresetBeginsTheDocumentAnew) {
    json const preset = json::parse(page_parameters(""))["presets"][0];
    DocumentFolder document(at("doc"));
    std::string const before = recipe();
    document.edit({"preset", {ReplaceRecipe{preset["recipe"]}}});
    EXPECT_EQ(recipe(), preset["recipe"]) << "nothing of it is without effect";
    EXPECT_TRUE(document.undo());
    EXPECT_EQ(recipe(), before);
    EXPECT_FALSE(document.undo());
}

TEST_F(Studios, ANewDocumentHasThePresetAsked) {
    std::string const name = recipe::presets().front().name;
    json const printed = json::parse(page_parameters(""))["presets"][0]["recipe"];
    EXPECT_EQ(document_for("", at("new"), false, name), at("new"));
    EXPECT_EQ(test::bytes_of(at("new/recipe.toml")), printed);
    document_for(at("land.toml"), at("around"), false, name);
    std::string const around = test::bytes_of(at("around/recipe.toml"));
    EXPECT_TRUE(test::has(around, "prune = 6.0", "uplift_pattern = 'domes'")) << around;
    document_for("", at("sheet"), true, name);
    std::string const sheet = test::bytes_of(at("sheet/recipe.toml"));
    EXPECT_TRUE(test::has(sheet, "source = 'lines'", "uplift_pattern = 'domes'")) << sheet;
    EXPECT_TRUE(test::has(test::error_of([&] { document_for(at("doc"), "", false, name); }), "--preset"));
    EXPECT_TRUE(test::has(test::error_of([&] { document_for("", at("doc"), false, name); }), "BadInput"));
    EXPECT_TRUE(test::has(test::error_of([&] { document_for("", at("no"), false, "hils"); }), "Did you mean"));
    EXPECT_FALSE(fs::exists(at("no")));
}

TEST_F(Studios, FindTheDocumentMeant) {
    EXPECT_EQ(document_for(at("doc"), ""), at("doc"));
    EXPECT_EQ(document_for(at("land.toml"), at("fresh")), at("fresh"));
    EXPECT_TRUE(fs::exists(at("fresh/recipe.toml")));
    EXPECT_EQ(document_for("", at("fresh")), at("fresh")) << "it is there";
    EXPECT_FALSE(test::error_of([&] { document_for(at("land.toml"), at("fresh")); }).empty())
        << "what is there is not replaced";
    fs::path const before = fs::current_path();
    fs::current_path(folder_.path());
    EXPECT_EQ(document_for("land.toml", ""), "studio");
    EXPECT_EQ(document_for("", ""), "studio") << "opened";
    EXPECT_EQ(document_for("land.toml", ""), "studio-2");
    fs::current_path(before);
}

} // namespace studio_test
