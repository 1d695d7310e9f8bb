// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/studio/internal/messages.hpp>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/recipe/presets.hpp>

namespace messages_test {

using namespace thalweg;
using namespace thalweg::studio;

namespace {

using nlohmann::json;

/// A message of heights, taken apart.
struct Parts {
    json head;
    std::vector<float> values;
};

Parts parts_of(std::string const& message) {
    std::uint32_t length = 0;
    std::memcpy(&length, message.data(), sizeof length);
    std::string_view const payload = std::string_view(message).substr(sizeof length + length);
    Parts parts{json::parse(message.substr(sizeof length, length)), std::vector<float>(payload.size() / sizeof(float))};
    EXPECT_EQ(length % 4, 0U) << "the heights are aligned";
    std::memcpy(parts.values.data(), payload.data(), payload.size());
    return parts;
}

ShownHeights shown(Raster<float> const& dem) {
    return {dem.grid(), true, *report::live_heights(dem, dem.grid()), report::Sea{3.0, true}};
}

std::string wrong_with(std::string const& request) {
    return test::message_of<BadInput>([&] { request_of(request); });
}

} // namespace

TEST(Requests, HaveShortNames) {
    EXPECT_TRUE(test::has(wrong_with(R"({"id":1,"do":"edit","edit":{"name":")" + std::string(1001, 'a') +
                                     R"(","steps":[{"unset":"detail"}]}})"),
                          "the name of an edit has at most"));
}

TEST(Requests, AreBoundedInDepthAndWidth) {
    std::string const deep = "{\"id\":1,\"do\":" + std::string(300000, '[') + std::string(300000, ']') + "}";
    EXPECT_TRUE(test::has(wrong_with(deep), "nested"));
    EXPECT_EQ(id_of(deep), 0);
    std::string wide = R"({"id":1,"do":"draw","what":{)";
    for (int i = 0; i < 50000; ++i) {
        wide += "\"k" + std::to_string(i) + "\":1,";
    }
    EXPECT_TRUE(test::has(wrong_with(wide + "\"verb\":\"clear\"}}"), "names in an object"));
}

TEST(Requests, AreRead) {
    Request const edit = request_of(R"({"id": 3, "do": "edit", "edit": {"name": "a drag", "steps": [
        {"set": "network.prune", "value": "30"}, {"unset": "detail"}, {"recipe": "seed = 1\n"}]}})");
    EXPECT_EQ(edit.id, 3);
    EXPECT_EQ(edit.kind, Request::Kind::edit);
    EXPECT_EQ(edit.edit.name, "a drag");
    ASSERT_EQ(edit.edit.steps.size(), 3U);
    EXPECT_EQ(std::get<SetKey>(edit.edit.steps[0]).value, "30");
    EXPECT_EQ(std::get<UnsetKey>(edit.edit.steps[1]).key, "detail");
    EXPECT_EQ(std::get<ReplaceRecipe>(edit.edit.steps[2]).toml, "seed = 1\n");
    EXPECT_EQ(request_of(R"({"do": "try", "edit": {"steps": [{"unset": "detail"}]}})").kind, Request::Kind::attempt);
    EXPECT_EQ(request_of(R"({"do": "undo"})").kind, Request::Kind::undo);
    EXPECT_EQ(request_of(R"({"do": "redo"})").kind, Request::Kind::redo);
    EXPECT_EQ(request_of(R"({"do": "stop"})").kind, Request::Kind::stop);
    EXPECT_EQ(request_of(R"({"do": "export", "file": "dem.tif"})").file, "dem.tif");
}

TEST(Requests, ThatAreNoneAreRefusedInWords) {
    EXPECT_TRUE(test::has(wrong_with("{"), "JSON object"));
    EXPECT_TRUE(test::has(wrong_with("[]"), "JSON object"));
    EXPECT_TRUE(test::has(wrong_with(std::string(100000, '[')), "JSON object"));
    EXPECT_TRUE(test::has(wrong_with("{}"), "do must be a text"));
    EXPECT_TRUE(test::has(wrong_with(R"({"do": 1})"), "do must be a text"));
    EXPECT_TRUE(test::has(wrong_with(R"({"do": "format"})"), "do is one of edit, try"));
    EXPECT_TRUE(test::has(wrong_with(R"({"do": "edit"})"), "no edit"));
    EXPECT_TRUE(test::has(wrong_with(R"({"do": "edit", "edit": {"steps": []}})"), "1 to 1000 steps"));
    EXPECT_TRUE(test::has(wrong_with(R"({"do": "edit", "edit": {"steps": [1]}})"), "a step is an object"));
    EXPECT_TRUE(test::has(wrong_with(R"({"do": "edit", "edit": {"steps": [{}]}})"), "set and value"));
    EXPECT_TRUE(test::has(wrong_with(R"({"do": "edit", "edit": {"steps": [{"set": "seed", "value": 7}]}})"),
                          "value must be a text"));
    EXPECT_EQ(id_of(R"({"id": 9})"), 9);
    EXPECT_EQ(id_of("{"), 0);
    EXPECT_EQ(id_of(R"({"id": "9"})"), 0);
}

TEST(HeightMessages, HoldTheTilesThatChanged) {
    Grid const grid = test::frame(100, 70, 10.0);
    Raster<float> const first =
        test::raster_of(grid, [](Cell c) { return static_cast<float>(c.col) + 0.5F * static_cast<float>(c.row); });
    Job const job{.revision = 2, .number = 4};
    Parts const all = parts_of(heights_message(job, shown(first), nullptr));
    EXPECT_EQ(all.head["kind"], "heights");
    EXPECT_EQ(all.head["job"], 4);
    EXPECT_EQ(all.head["revision"], 2);
    EXPECT_EQ(all.head["level"], "full");
    EXPECT_EQ(all.head["width"], 100);
    EXPECT_EQ(all.head["height"], 70);
    EXPECT_EQ(all.head["grid"]["cell_m"], 10.0);
    EXPECT_EQ(all.head["sea"]["level"], 3.0);
    EXPECT_EQ(all.head["tiles"], json({0, 1, 2, 3}));
    ASSERT_EQ(all.values.size(), 7000U);
    EXPECT_EQ(all.values[64 * 64], first[(Cell{64, 0})]) << "the second tile is cut at the edge";
    EXPECT_EQ(all.values[64 * 64 + 36], first[(Cell{64, 1})]);

    Raster<float> second = first;
    second[Cell{99, 69}] = std::numeric_limits<float>::quiet_NaN();
    ShownHeights const before = shown(first);
    Parts const changed = parts_of(heights_message(job, shown(second), &before));
    EXPECT_EQ(changed.head["tiles"], json({3}));
    EXPECT_EQ(changed.head["nodata"], 1);
    ASSERT_EQ(changed.values.size(), 36U * 6U);
    EXPECT_TRUE(std::isnan(changed.values.back()));

    ShownHeights const holed = shown(second);
    EXPECT_EQ(parts_of(heights_message(job, shown(second), &holed)).head["tiles"], json::array())
        << "holes are the same as before";

    ShownHeights elsewhere = before;
    elsewhere.grid.west += 1.0;
    EXPECT_EQ(parts_of(heights_message(job, shown(second), &elsewhere)).head["tiles"].size(), 4U);
}

TEST(Messages, SayWhatADocumentHolds) {
    Document const document = document_of("[grid]\nwidth = 60\nheight = 60\n[network]\nsource = \"dla\"\n[surface]\n");
    Session const session = edited({document, {}}, {"", {SetKey{"network.prune", "12"}}});
    json const said = json::parse(document_message(session.document, session.history, "thalweg make x"));
    EXPECT_EQ(said["type"], "document");
    EXPECT_EQ(said["revision"], session.document.revision);
    EXPECT_EQ(said["recipe"], session.document.toml);
    EXPECT_EQ(said["values"]["network.prune"], "12.0");
    EXPECT_EQ(said["values"]["network.dla.branch"], "largest") << "words stand without quotes, as on a command line";
    EXPECT_TRUE(said["values"].contains("network.rotate") && said["values"]["network.rotate"].is_null());
    EXPECT_FALSE(said["values"].contains("network.tokunaga.order"));
    EXPECT_EQ(said["undo"], "network.prune = 12");
    EXPECT_EQ(said["redo"], "");
    for (auto const& [path, text] : said["values"].items()) { // each value can be set as it stands
        if (!text.is_null()) {
            AppliedEdit const same = apply(session.document, {"", {SetKey{path, text.get<std::string>()}}});
            EXPECT_EQ(same.document.toml, session.document.toml) << path;
        }
    }
}

TEST(Messages, SayWhatIsDrawn) {
    Drawing drawing;
    drawing.grid = test::frame(100, 70, 10.0);
    Grid const& grid = drawing.grid;
    auto const at = [&](double x, double y) { return Vec2{grid.west + 10.0 * x, grid.north - 10.0 * y}; };
    drawing.pins = {{at(1.5, 2), 340.5}};
    drawing.ridges = {{{at(0, 0), at(1, 2), at(3, 4)}, {std::nullopt, 20.0, 9.0}}};
    json const said = json::parse(drawing_message(drawing, 4, true));
    EXPECT_EQ(said["kind"], "drawn");
    EXPECT_EQ(said["pins"], json::parse(R"([{"at": [1.5, 2.0], "height": 340.5}])"));
    EXPECT_EQ(said["ridges"], json::parse(R"([{"line": [0.0, 0.0, 1.0, 2.0, 3.0, 4.0], "from": null, "to": 9.0}])"));
    EXPECT_EQ(said["rivers"], json::array());
}

TEST(Messages, GiveThePageEveryKey) {
    json const given = json::parse(page_parameters("land of somebody"));
    EXPECT_EQ(given["folder"], "land of somebody");
    EXPECT_EQ(given["keys"].size(), recipe::recipe_keys().size());
    for (json const& key : given["keys"]) {
        EXPECT_FALSE(key["meaning"].get<std::string>().empty()) << key["path"];
        if (key["path"] == "network.dla.sticking") {
            EXPECT_EQ(key["low"], 0.0);
            EXPECT_EQ(key["high"], 1.0);
        }
        if (key["path"] == "seed") {
            EXPECT_TRUE(key["high"].is_null());
        }
    }
}

TEST(Messages, GiveThePageEveryPreset) {
    json const given = json::parse(page_parameters("land"))["presets"];
    ASSERT_EQ(given.size(), recipe::presets().size());
    for (std::size_t i = 0; i < given.size(); ++i) {
        recipe::Preset const& preset = recipe::presets()[i];
        EXPECT_EQ(given[i]["name"], preset.name);
        EXPECT_EQ(given[i]["meaning"], preset.meaning);
        EXPECT_EQ(given[i]["not_meant"], preset.not_meant);
        recipe::Recipe const recipe = recipe::with_preset(recipe::default_recipe(), preset.name);
        EXPECT_EQ(given[i]["recipe"], recipe::write_recipe(recipe)) << preset.name;
    }
}

} // namespace messages_test
