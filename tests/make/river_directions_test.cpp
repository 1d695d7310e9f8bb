// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/import/import_lines.hpp>

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>
#include <io/scratch_folder.hpp>
#include <make/ascii_grid.hpp>
#include <network/rivers.hpp>
#include <support.hpp>

#include <thalweg/commands/check.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/flow/extract_streams.hpp>
#include <thalweg/flow/route.hpp>
#include <thalweg/io/network/read_rivers.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/make/make.hpp>

// The share of rivers of known direction that is oriented wrong without their fields and directions:
// docs/algorithms/river_directions.md.
namespace river_directions_test {

using namespace thalweg;

namespace {

using test::step;

/// Rivers drawn downstream, without fields or heights.
struct KnownRivers {
    std::string name;
    RiverLines lines;
    Raster<float> dem; ///< without cells where there is none
};

KnownRivers of_dem(std::string const& name, std::string const& path, double length_m) {
    KnownRivers known{name, {}, io::read_dem(path)};
    flow::FlowField const drainage = flow::route(known.dem);
    flow::ExtractedStreams const streams =
        flow::extract_streams(drainage, known.dem, {flow::support_for_length(drainage, length_m)});
    known.lines.name = name;
    for (Arc const& arc : streams.network.planform.arcs()) {
        RiverLine& line = known.lines.lines.emplace_back();
        line.feature = static_cast<std::int64_t>(known.lines.lines.size());
        for (Vec2 const v : arc.line) {
            line.vertices.push_back({v.x, v.y, std::numeric_limits<double>::quiet_NaN()});
        }
    }
    return known;
}

KnownRivers of_file(std::string const& name, std::string const& path) {
    KnownRivers known{name, io::read_rivers({.path = path, .filter = io::LineFilter::natural}), {}};
    for (RiverLine& line : known.lines.lines) {
        std::vector<Vec3> const vertices = std::move(line.vertices);
        line = {line.feature, vertices, ""};
        for (Vec3& v : line.vertices) {
            v.z = std::numeric_limits<double>::quiet_NaN();
        }
    }
    known.lines.has_z = false;
    return known;
}

enum class Drawn { random_1, random_2, random_3, pieces, third, few, upstream, downstream };

/// The same rivers, drawn from spring to mouth: at each place the line with the most length above it goes on.
RiverLines uncut(RiverLines const& cut) {
    using Place = std::pair<double, double>;
    auto const first = [](RiverLine const& line) { return Place(line.vertices.front().x, line.vertices.front().y); };
    auto const last = [](RiverLine const& line) { return Place(line.vertices.back().x, line.vertices.back().y); };
    std::multimap<Place, std::size_t> arriving;
    std::multimap<Place, std::size_t> leaving;
    for (std::size_t l = 0; l < cut.lines.size(); ++l) {
        arriving.emplace(last(cut.lines[l]), l);
        leaving.emplace(first(cut.lines[l]), l);
    }
    std::vector<double> above_m(cut.lines.size(), -1.0);
    auto const length_above = [&](auto const& self, std::size_t l) -> double {
        if (above_m[l] < 0.0) {
            above_m[l] = 0.0; // where lines run in a circle
            double sum_m = length_in_plan(cut.lines[l].vertices);
            auto const [begin, end] = arriving.equal_range(first(cut.lines[l]));
            for (auto it = begin; it != end; ++it) {
                sum_m += self(self, it->second);
            }
            above_m[l] = sum_m;
        }
        return above_m[l];
    };
    constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
    std::vector<std::size_t> next(cut.lines.size(), none);
    std::vector<char> is_continued(cut.lines.size(), 0);
    for (auto it = leaving.begin(); it != leaving.end(); it = leaving.upper_bound(it->first)) {
        auto const [begin, end] = arriving.equal_range(it->first);
        if (begin == end) {
            continue;
        }
        auto const main = std::max_element(begin, end, [&](auto const& a, auto const& b) {
            return length_above(length_above, a.second) < length_above(length_above, b.second);
        });
        if (main->second != it->second) {
            next[main->second] = it->second;
            is_continued[it->second] = 1;
        }
    }
    RiverLines result = cut;
    result.lines.clear();
    for (std::size_t l = 0; l < cut.lines.size(); ++l) {
        if (is_continued[l] != 0) {
            continue;
        }
        RiverLine stem{static_cast<std::int64_t>(result.lines.size()) + 1, cut.lines[l].vertices, ""};
        for (std::size_t n = next[l]; n != none; n = next[n]) {
            auto const& below = cut.lines[n].vertices;
            stem.vertices.insert(stem.vertices.end(), below.begin() + 1, below.end());
        }
        result.lines.push_back(std::move(stem));
    }
    return result;
}

/// Cut at random vertices, as vectorised rasters are.
void cut(RiverLines& lines) {
    std::vector<RiverLine> parts;
    for (RiverLine const& line : lines.lines) {
        RiverLine part{static_cast<std::int64_t>(parts.size()) + 1, {}, ""};
        for (std::size_t i = 0; i < line.vertices.size(); ++i) {
            part.vertices.push_back(line.vertices[i]);
            bool const ends = i > 0 && (i + 1 == line.vertices.size() ||
                                        unit(random_word(1, static_cast<std::uint64_t>(line.feature), i)) < 0.1);
            if (ends) {
                parts.push_back(part);
                part = {static_cast<std::int64_t>(parts.size()) + 1, {line.vertices[i]}, ""};
            }
        }
    }
    lines.lines = std::move(parts);
}

RiverLines redrawn(RiverLines lines, Drawn how) {
    if (how == Drawn::pieces) {
        cut(lines);
    }
    for (std::size_t l = 0; l < lines.lines.size(); ++l) {
        double const dice = unit(random_word(2 + static_cast<std::uint64_t>(how), l));
        bool const turned = how == Drawn::upstream || (how == Drawn::third && l % 3 == 0) ||
                            (how == Drawn::few && dice < 0.05) || (how < Drawn::third && dice < 0.5);
        if (turned) {
            std::ranges::reverse(lines.lines[l].vertices);
        }
    }
    return lines;
}

struct Wrong {
    double wrong_m = 0.0;
    double length_m = 0.0;
    double share() const { return wrong_m / length_m; }
    Wrong& operator+=(Wrong const& o) {
        wrong_m += o.wrong_m;
        length_m += o.length_m;
        return *this;
    }
};

Wrong wrong_of(KnownRivers const& known, network::ImportedNetwork const& imported) {
    std::set<test::Step> downstream;
    for (RiverLine const& line : known.lines.lines) {
        for (std::size_t i = 1; i < line.vertices.size(); ++i) {
            downstream.insert(step(in_plan(line.vertices[i - 1]), in_plan(line.vertices[i])));
        }
    }
    Wrong wrong;
    for (Arc const& arc : imported.network.arcs()) {
        for (std::size_t i = 1; i < arc.line.size(); ++i) {
            double const m = distance(arc.line[i - 1], arc.line[i]);
            wrong.length_m += m;
            wrong.wrong_m += downstream.contains(step(arc.line[i], arc.line[i - 1])) ? m : 0.0;
        }
    }
    return wrong;
}

std::vector<KnownRivers> const& networks() {
    static std::vector<KnownRivers> const all = [] {
        std::string const samples = THALWEG_SOURCE_DIR "/samples/";
        std::vector<KnownRivers> known;
        known.push_back(of_dem("Big Tujunga", samples + "bigtujunga_srtm1_utm11.tif", 668e3));
        known.push_back(of_dem("Jacksboro", samples + "jacksboro_utm16.tif", 539e3));
        known.push_back(of_dem("Big Tujunga, coarse", samples + "bigtujunga_srtm1_utm11.tif", 250e3));
        known.push_back(of_dem("Jacksboro, fine", samples + "jacksboro_utm16.tif", 900e3));
        known.push_back(of_file("Walker", samples + "walker_nhdplus.gpkg"));
        known.push_back(of_file("coastal", samples + "coastal_nhdplus.gpkg"));
        return known;
    }();
    return all;
}

enum class Stems { cut, uncut };

void expect_bars(Drawn how, char const* name, bool with_dem, double pooled_share, double most_share,
                 Stems stems = Stems::cut) {
    Wrong pooled;
    std::string row = fmt::format("{:<12}", name);
    for (KnownRivers const& known : networks()) {
        if (with_dem && known.dem.cells() == 0) {
            continue;
        }
        RiverLines const lines = stems == Stems::uncut ? uncut(known.lines) : known.lines;
        Wrong const wrong =
            wrong_of(known, network::import_lines(redrawn(lines, how), {.dem = with_dem ? &known.dem : nullptr}));
        row += fmt::format("  {} {:.2f} % of {:.0f} km", known.name, 100.0 * wrong.share(), wrong.length_m / 1000.0);
        EXPECT_LE(wrong.share(), most_share) << known.name << ", " << name;
        pooled += wrong;
    }
    std::printf("%s  pooled %.2f %%\n", row.c_str(), 100.0 * pooled.share());
    EXPECT_LE(pooled.share(), pooled_share) << name;
}

constexpr double pooled_bar = 0.02;
constexpr double any_bar = 0.06;
constexpr double dem_bar = 0.005;

} // namespace

TEST(RiverDirections, HoldTheirBarsHoweverLinesAreDrawn) {
    expect_bars(Drawn::random_1, "random 1", false, pooled_bar, any_bar);
    expect_bars(Drawn::random_2, "random 2", false, pooled_bar, any_bar);
    expect_bars(Drawn::random_3, "random 3", false, pooled_bar, any_bar);
    expect_bars(Drawn::pieces, "pieces", false, pooled_bar, any_bar);
    expect_bars(Drawn::third, "third", false, pooled_bar, any_bar);
    expect_bars(Drawn::few, "few", false, dem_bar, pooled_bar);
    expect_bars(Drawn::upstream, "upstream", false, pooled_bar, any_bar);
    expect_bars(Drawn::downstream, "downstream", false, pooled_bar, any_bar);
}

// Each river is one line from its spring to its mouth or confluence.
TEST(RiverDirections, HoldTheirBarsWhereStemsAreUncut) {
    expect_bars(Drawn::random_1, "stems 1", false, pooled_bar, any_bar, Stems::uncut);
    expect_bars(Drawn::random_2, "stems 2", false, pooled_bar, any_bar, Stems::uncut);
    expect_bars(Drawn::random_3, "stems 3", false, pooled_bar, any_bar, Stems::uncut);
    expect_bars(Drawn::third, "stems third", false, pooled_bar, any_bar, Stems::uncut);
    expect_bars(Drawn::downstream, "stems down", false, pooled_bar, any_bar, Stems::uncut);
}

TEST(RiverDirections, HoldTheirBarsWithADem) {
    expect_bars(Drawn::random_1, "random 1, DEM", true, dem_bar, any_bar);
    expect_bars(Drawn::upstream, "upstream, DEM", true, dem_bar, any_bar);
    expect_bars(Drawn::pieces, "pieces, DEM", true, dem_bar, any_bar);
}

TEST(RiverDirections, AColumnThatIsRightIsNotDoubted) {
    for (KnownRivers const& known : networks()) {
        RiverLines lines = redrawn(known.lines, Drawn::random_1);
        for (std::size_t l = 0; l < lines.lines.size(); ++l) {
            lines.lines[l].runs =
                in_plan(lines.lines[l].vertices[0]) == in_plan(known.lines.lines[l].vertices[0]) ? 1 : -1;
        }
        network::ImportedNetwork const imported = network::import_lines(lines);
        EXPECT_EQ(wrong_of(known, imported).wrong_m, 0.0) << known.name;
        for (Finding const& doubt : imported.directions.doubts) {
            ADD_FAILURE() << known.name << ": " << doubt.text;
        }
    }
}

// Ranks of which a third is wrong are refused where they lead into pits, else doubted.
TEST(RiverDirections, RanksThatAreAThirdWrong) {
    for (KnownRivers const& known : networks()) {
        if (known.dem.cells() == 0) {
            continue; // its lines have loops
        }
        RiverLines lines = known.lines;
        std::map<std::pair<double, double>, std::size_t> leaving;
        auto const place = [](Vec3 const& v) { return std::pair(v.x, v.y); };
        for (std::size_t l = 0; l < lines.lines.size(); ++l) {
            leaving[place(lines.lines[l].vertices.front())] = l;
        }
        for (RiverLine& line : lines.lines) {
            line.rank = 1;
            for (auto next = leaving.find(place(line.vertices.back())); next != leaving.end();
                 next = leaving.find(place(lines.lines[next->second].vertices.back()))) {
                ++line.rank;
            }
        }
        EXPECT_TRUE(network::import_lines(lines).directions.doubts.empty()) << known.name;
        for (std::size_t l = 0; l < lines.lines.size(); ++l) {
            std::uint64_t const word = random_word(30, l);
            lines.lines[l].rank = word % 3 == 0 ? static_cast<std::int64_t>(word / 3 % 60) + 1 : lines.lines[l].rank;
        }
        try {
            EXPECT_GE(test::count(network::import_lines(lines).directions.doubts, "contradicted_direction"), 1)
                << known.name;
        } catch (BadInput const& refused) {
            EXPECT_TRUE(test::has(refused.what(), "by rank"));
        }
    }
}

// A direction column of which a third is wrong: it is doubted, and what the angles say with it holds the same bars.
TEST(RiverDirections, AColumnThatIsAThirdWrong) {
    Wrong pooled;
    for (KnownRivers const& known : networks()) {
        RiverLines lines = known.lines;
        for (std::size_t l = 0; l < lines.lines.size(); ++l) {
            lines.lines[l].runs = unit(random_word(20, l)) < 1.0 / 3.0 ? -1 : 1;
            if (unit(random_word(21, l)) < 0.5) {
                std::ranges::reverse(lines.lines[l].vertices);
                lines.lines[l].runs = -lines.lines[l].runs;
            }
        }
        network::ImportedNetwork const imported = network::import_lines(lines);
        EXPECT_EQ(test::count(imported.directions.doubts, "contradicted_direction"), 1) << known.name;
        Wrong const wrong = wrong_of(known, imported);
        std::printf("column: %s %.2f %%\n", known.name.c_str(), 100.0 * wrong.share());
        EXPECT_LE(wrong.share(), any_bar) << known.name;
        pooled += wrong;
    }
    EXPECT_LE(pooled.share(), pooled_bar);
}

namespace {

/// Seven lines, each drawn from the mouth of the river at (500000, 5000000) upward, but for those that are turned.
std::string from_the_mouth(std::set<std::size_t> const& turned = {}) {
    std::vector<std::vector<std::string>> lines{{"[500000,5000000]", "[500200,5002000]", "[500000,5004000]"},
                                                {"[500000,5004000]", "[498500,5006000]", "[497500,5008000]"},
                                                {"[500000,5004000]", "[501200,5006000]", "[501500,5007000]"},
                                                {"[501500,5007000]", "[501000,5009000]", "[501200,5011000]"},
                                                {"[501500,5007000]", "[503000,5008000]", "[504500,5009000]"},
                                                {"[497500,5008000]", "[497500,5009500]", "[497000,5011500]"},
                                                {"[497500,5008000]", "[495500,5008500]", "[493500,5009500]"}};
    std::string text;
    for (std::size_t l = 0; l < lines.size(); ++l) {
        if (turned.contains(l)) {
            std::ranges::reverse(lines[l]);
        }
        text += (l == 0 ? "" : ",") + test::line(fmt::format("{}", fmt::join(lines[l], ",")));
    }
    return text;
}
constexpr double from_the_mouth_m = 27668.0;

struct Logged {
    make::MakeResult made;
    std::vector<std::string> log;

    std::vector<std::string> about(std::string const& words) const {
        std::vector<std::string> lines;
        std::ranges::copy_if(log, std::back_inserter(lines),
                             [&](std::string const& line) { return line.find(words) != std::string::npos; });
        return lines;
    }
};

Logged make_lines(ScratchFolder const& folder, std::string const& keys = "") {
    recipe::Recipe recipe = recipe::read_recipe(
        "[grid]\ncell = 60\n[network]\nsource = \"lines\"\n[network.lines]\npath = \"rivers.geojson\"\n" + keys,
        "test");
    recipe.folder = folder.path().string();
    Logged logged;
    Run run;
    run.log = [&](std::string_view line) { logged.log.emplace_back(line); };
    logged.made = make::make(recipe, run);
    return logged;
}

} // namespace

TEST(RiverDirections, AFileDrawnFromTheMouthIsTurned) {
    ScratchFolder const folder;
    folder.write("rivers.geojson", test::geojson(from_the_mouth()));
    Logged const logged = make_lines(folder);
    StreamNetwork const& network = logged.made.planform.file.imported;
    ASSERT_EQ(network.outlets().size(), 1U);
    EXPECT_EQ(network.node(network.outlets()[0]).at, (Vec2{500000, 5000000}));
    ASSERT_TRUE(logged.made.assessment.given);
    EXPECT_NEAR(logged.made.assessment.given->turned_m, from_the_mouth_m, 1.0);
    EXPECT_FALSE(logged.about("27.7 km reversed").empty());
    EXPECT_FALSE(logged.about("doubtful_directions").empty()) << "it may as well be a delta";
}

TEST(RiverDirections, OfAFileDrawnFromTheMouthAMendedCopyIsTurned) {
    ScratchFolder const folder;
    folder.write("rivers.geojson", test::geojson(from_the_mouth()));
    commands::CheckParams params;
    params.network = folder / "rivers.geojson";
    params.fix = folder / "mended.gpkg";
    commands::CheckResult const checked = commands::run_check(params);
    EXPECT_EQ(checked.written.size(), 1U);
    EXPECT_EQ(test::count(checked.mended, "reversed"), 7);
    EXPECT_EQ(test::count(checked.notes, "directions"), 1);
    EXPECT_EQ(test::count(checked.notes, "doubtful_directions"), 1);
}

// A line alone whose file is drawn in all directions: a warning, and a DEM decides, in make and in check --fix.
TEST(RiverDirections, WhatIsUncertainADemDecides) {
    ScratchFolder const folder;
    std::string lines = from_the_mouth({1, 3, 6});
    lines += "," + test::line("[496000,5003000],[496500,5003800],[497000,5004600]"); // to the north
    folder.write("rivers.geojson", test::geojson(lines));
    write_ascii_grid(folder / "dem.asc", {150, 150, 100, 491000, 4999000},
                     [](int, int row) { return 2.0 * (150 - row); }); // falls to the south
    Logged const without = make_lines(folder);
    ASSERT_EQ(without.about("is uncertain").size(), 1U);
    EXPECT_TRUE(test::has(without.about("is uncertain")[0], "network.lines.dem"));
    Logged const with = make_lines(folder, "dem = \"dem.asc\"\n");
    EXPECT_TRUE(with.about("is uncertain").empty());
    std::vector<Vec2> outlets;
    StreamNetwork const& network = with.made.planform.file.imported;
    for (NodeId const n : network.outlets()) {
        outlets.push_back(network.node(n).at);
    }
    std::ranges::sort(outlets, before);
    EXPECT_EQ(outlets, (std::vector<Vec2>{{496000, 5003000}, {500000, 5000000}}));

    commands::CheckParams params;
    params.network = folder / "rivers.geojson";
    params.fix = folder / "mended.gpkg";
    EXPECT_EQ(test::count(commands::run_check(params).notes, "doubtful_directions"), 1);
    params.dem = folder / "dem.asc";
    params.existing = io::Existing::replace;
    commands::CheckResult const checked = commands::run_check(params);
    EXPECT_EQ(test::count(checked.notes, "doubtful_directions"), 0);
    EXPECT_TRUE(
        std::ranges::any_of(checked.mended, [](Finding const& f) { return f.kind == "reversed" && f.feature == 8; }));
}

} // namespace river_directions_test
