// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/internal/key_kinds.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_sections.hpp>

#include <thalweg/core/run/error.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace thalweg::pipeline {

namespace {

std::vector<Key> make_keys() {
    std::vector<Key> keys;

    Key seed = integer<std::uint64_t>(
        "seed", "", {0, endless},
        "random seed of the whole recipe; recorded in the network's run table and, without output.title, in the titles",
        in_recipe<std::uint64_t>([](Recipe& r) -> std::uint64_t& { return r.seed; }));
    keys.push_back(std::move(seed));

    keys.push_back(side("grid.width", "number of columns; left out: the network's extent and a margin of 5 %",
                        in_recipe<std::int64_t>([](Recipe& r) -> std::int64_t& { return r.grid.width; })));
    keys.push_back(side("grid.height", "number of rows; left out: the network's extent and a margin of 5 %",
                        in_recipe<std::int64_t>([](Recipe& r) -> std::int64_t& { return r.grid.height; })));
    keys.push_back(number("grid.cell", "m", {0, 1e6, true}, "cell size",
                          in_recipe<double>([](Recipe& r) -> double& { return r.grid.cell_m; })));
    keys.push_back(text("grid.crs", "EPSG code or WKT; projected, in metres",
                        "coordinate system; \"\": that of the line file or its UTM zone, else EPSG:32631",
                        in_recipe<std::string>([](Recipe& r) -> std::string& { return r.grid.crs; })));
    {
        Key key;
        key.help = {"grid.origin", "two numbers", "[west, north]", "m", "", "north-western corner of the grid"};
        key.put = [](Recipe& r, Value const& v) {
            auto const* p = std::get_if<Pair>(&v);
            if (p == nullptr || !std::isfinite((*p)[0]) || !std::isfinite((*p)[1]) || std::fabs((*p)[0]) > 1e9 ||
                std::fabs((*p)[1]) > 1e9) {
                throw BadParameter(
                    fmt::format("two numbers [west, north] within 1e9 are required, not {}", toml_text(v)));
            }
            r.grid.origin = *p;
        };
        key.take = [](Recipe const& r) -> std::optional<Value> {
            return r.grid.origin ? std::optional<Value>(*r.grid.origin) : std::nullopt;
        };
        keys.push_back(std::move(key));
    }
    keys.push_back(yes_no("grid.clip",
                          "cut rivers and polygons at the grid's edge instead of refusing those that cross it",
                          in_recipe<bool>([](Recipe& r) -> bool& { return r.grid.clip; })));

    add_network_keys(keys);
    add_skeleton_keys(keys);
    add_surface_keys(keys);
    add_statistics_keys(keys);
    add_detail_keys(keys);
    add_patch_keys(keys);

    keys.push_back(text("output.title", "text", "title of the pictures and the report; \"\": names the seed",
                        in_recipe<std::string>([](Recipe& r) -> std::string& { return r.output.title; })));
    keys.push_back(
        choice<HeightUnit>("output.units", {{"m", HeightUnit::metre}, {"ft", HeightUnit::foot}},
                           "unit of heights in dem.tif, networks, contours and TINs: metres or international feet",
                           in_recipe<HeightUnit>([](Recipe& r) -> HeightUnit& { return r.output.units; })));
    keys.push_back(number("output.contour_interval", "", {0, 1e5},
                          "contour interval in output.units; 0: a round number",
                          in_recipe<double>([](Recipe& r) -> double& { return r.output.contour_interval; })));
    keys.push_back(yes_no("output.catchments", "write the catchment of each arc: catchments.gpkg",
                          in_recipe<bool>([](Recipe& r) -> bool& { return r.output.catchments; })));
    keys.push_back(yes_no("output.accumulation", "write contributing areas by cell: area_d8.tif, area_dinf.tif",
                          in_recipe<bool>([](Recipe& r) -> bool& { return r.output.accumulation; })));
    Choices<io::Schema> schemas;
    for (io::SchemaTable const& table : io::all_schemas()) {
        schemas.emplace_back(table.name, table.schema);
    }
    keys.push_back(choice<io::Schema>("output.schema", schemas,
                                      "also write network_SCHEMA.gpkg in this schema, unless native",
                                      in_recipe<io::Schema>([](Recipe& r) -> io::Schema& { return r.output.schema; })));

    Recipe const standard = with_all_sections();
    for (Key& key : keys) {
        if (auto const value = key.take(standard)) {
            auto const* const number = std::get_if<double>(&*value); // for a reader: 0.087, not its 17 digits
            key.help.standard = number != nullptr ? fmt::format("{}", *number) : toml_text(*value);
        }
    }
    for (Key& key : keys) {
        key.use = use_of(key.help.path);
        key.help.used_by = key.use.text;
        if (key.help.path == "network.prune") {
            key.help.standard = "20 for dla and forest, else 0";
        } else if (key.help.path == "grid.origin") {
            key.help.standard = "[500000, 5000000], or the line file's box";
        }
    }
    return keys;
}

} // namespace

bool names_file(Key const& key) {
    return key.help.is_file;
}

Recipe with_all_sections() {
    Recipe recipe;
    recipe.network.emplace();
    recipe.skeleton.emplace();
    recipe.surface.emplace();
    recipe.statistics.emplace();
    recipe.detail.emplace();
    recipe.patches.emplace_back();
    return recipe;
}

std::vector<Key> const& all_keys() {
    static std::vector<Key> const keys = make_keys();
    return keys;
}

Key const* find_key(std::string const& path) {
    auto const& keys = all_keys();
    auto const at = std::find_if(keys.begin(), keys.end(), [&](Key const& k) { return k.help.path == path; });
    return at == keys.end() ? nullptr : &*at;
}

} // namespace thalweg::pipeline
