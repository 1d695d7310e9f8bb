// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/studio/engine.hpp>

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/io/files/files.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/studio/document.hpp>
#include <thalweg/studio/drawing_files.hpp>

#include "random_edits.hpp"

namespace engine_test {

using namespace thalweg;
using namespace thalweg::studio;

namespace {

std::string const forest = "[grid]\nwidth = 96\nheight = 80\n[network]\nsource = \"forest\"\nprune = 6\n"
                           "[network.forest]\noutlet_spacing = 40\nspacing = 8\n[surface]\n";
std::string const cluster = "[grid]\nwidth = 90\nheight = 90\n[network]\nsource = \"dla\"\nprune = 5\n"
                            "[network.dla]\nparticles = 1200\n[surface]\nmethod = \"dilate\"\n";
std::string const tree = "[grid]\nwidth = 80\nheight = 80\n[network]\nsource = \"tokunaga\"\n"
                         "[network.tokunaga]\norder = 3\n[surface]\nmethod = \"diffuse\"\n";
std::string const numbers = "[grid]\nwidth = 64\nheight = 64\n[statistics]\nmean = 500\nstd = 80\n";

/// An engine that notes what happens.
class Watched {
public:
    /// What an engine said of one job.
    struct Told {
        std::set<std::string> stages; ///< that ran
        std::vector<std::pair<Raster<float>, bool>> heights;
        int rivers = 0;
        int made = 0;
        std::shared_ptr<make::MakeResult const> measured;
        std::string failed;
        bool stopped = false;
    };

    Engine& engine() { return engine_; }

    std::int64_t begin(Document const& document) {
        return engine_.make({document.revision, document.recipe, document.toml});
    }
    /// What becomes of a document.
    Told make(Document const& document) {
        std::int64_t const number = begin(document);
        engine_.wait(number);
        return told(number);
    }
    Told told(std::int64_t number) {
        std::unique_lock lock(guard_);
        changed_.wait(lock, [&] { return ended_.contains(number); });
        return jobs_[number];
    }
    /// Holds jobs at a stage; "": lets them go on.
    void hold_at(std::string stage) {
        std::scoped_lock const lock(guard_);
        held_ = std::move(stage);
        changed_.notify_all();
    }
    /// Waits until a job runs a stage.
    void wait_for(std::int64_t number, std::string const& stage) {
        std::unique_lock lock(guard_);
        changed_.wait(lock, [&] { return jobs_[number].stages.contains(stage) || ended_.contains(number); });
    }

private:
    template <class Note> void note(Job const& job, Note const& what) {
        std::scoped_lock const lock(guard_);
        what(jobs_[job.number]);
        changed_.notify_all();
    }
    void end(Job const& job) {
        std::scoped_lock const lock(guard_);
        ended_.insert(job.number);
        changed_.notify_all();
    }

    Watcher watcher() {
        return {.at =
                    [this](Job const& job, std::string_view stage, double) {
                        note(job, [&](Told& told) { told.stages.emplace(stage); });
                        std::unique_lock lock(guard_);
                        changed_.wait(lock, [&] { return stage != held_; });
                    },
                .rivers = [this](Job const& job, recipe::Recipe const&, make::Planform const&,
                                 Run const&) { note(job, [](Told& told) { ++told.rivers; }); },
                .heights =
                    [this](Job const& job, Heights const& seen) {
                        note(job, [&](Told& told) { told.heights.emplace_back(seen.dem, seen.is_finished); });
                    },
                .made = [this](Job const& job, make::MakeResult const&) { note(job, [](Told& told) { ++told.made; }); },
                .measured =
                    [this](Job const& job, std::shared_ptr<make::MakeResult const> const& made) {
                        note(job, [&](Told& told) { told.measured = made; });
                        end(job);
                    },
                .failed =
                    [this](Job const& job, std::string_view error) {
                        note(job, [&](Told& told) { told.failed = error; });
                        end(job);
                    },
                .stopped =
                    [this](Job const& job) {
                        note(job, [](Told& told) { told.stopped = true; });
                        end(job);
                    }};
    }

    std::mutex guard_;
    std::condition_variable changed_;
    std::map<std::int64_t, Told> jobs_;
    std::set<std::int64_t> ended_;
    std::string held_;
    Engine engine_{watcher(), 2};
};

Document edited(Document const& document, std::string const& key, std::string const& value) {
    return apply(document, {"", {SetKey{key, value}}}).document;
}

/// Whether two terrains are the same in all that make writes of them.
testing::AssertionResult are_same(make::MakeResult const& a, make::MakeResult const& b) {
    if (a.terrain.has_surface() != b.terrain.has_surface() ||
        (a.terrain.has_surface() && !test::same_bits(a.terrain.ground.dem, b.terrain.ground.dem))) {
        return testing::AssertionFailure() << "other heights";
    }
    StreamNetwork const& one = a.terrain.rivers.network.planform;
    StreamNetwork const& other = b.terrain.rivers.network.planform;
    bool same = one.arc_count() == other.arc_count() &&
                a.terrain.rivers.network.arc_z == b.terrain.rivers.network.arc_z &&
                a.terrain.water.areas.ds_area_m2 == b.terrain.water.areas.ds_area_m2;
    for (ArcId arc = 0; same && arc < one.arc_count(); ++arc) {
        same = one.arc(arc).line == other.arc(arc).line && one.arc(arc).type == other.arc(arc).type;
    }
    if (!same) {
        return testing::AssertionFailure() << "other rivers";
    }
    bool checks = a.assessment.checks.size() == b.assessment.checks.size();
    for (std::size_t i = 0; checks && i < a.assessment.checks.size(); ++i) {
        checks = a.assessment.checks[i].name == b.assessment.checks[i].name &&
                 test::same_bits(a.assessment.checks[i].value, b.assessment.checks[i].value);
    }
    if (!checks || recipe::write_recipe(a.recipe) != recipe::write_recipe(b.recipe)) {
        return testing::AssertionFailure() << "other checks or recipe";
    }
    auto const texts = [](make::MakeResult const& made) {
        std::vector<std::string> all;
        for (Finding const& finding : make::findings_of(made)) {
            all.push_back(std::string(finding.kind.name()) + ": " + finding.text);
        }
        return all;
    };
    if (std::vector<std::string> const one_says = texts(a), other_says = texts(b); one_says != other_says) {
        return testing::AssertionFailure()
               << "other findings: " << testing::PrintToString(one_says) << " / " << testing::PrintToString(other_says);
    }
    return testing::AssertionSuccess();
}

/// Pearson's r of heights on coarse cells and those of the finished terrain in the middle of each.
double correlation(Raster<float> const& coarse, Raster<float> const& fine) {
    double n = 0.0;
    double sx = 0.0;
    double sy = 0.0;
    double sxx = 0.0;
    double syy = 0.0;
    double sxy = 0.0;
    for (std::int64_t i = 0; i < coarse.cells(); ++i) {
        Cell const at = fine.grid().cell_of(coarse.grid().centre(coarse.grid().at(i)));
        if (!fine.grid().contains(at) || std::isnan(coarse[i]) || std::isnan(fine[at])) {
            continue;
        }
        double const x = coarse[i];
        double const y = fine[at];
        n += 1.0;
        sx += x;
        sy += y;
        sxx += x * x;
        syy += y * y;
        sxy += x * y;
    }
    return (n * sxy - sx * sy) / std::sqrt((n * sxx - sx * sx) * (n * syy - sy * sy));
}

/// Files that recipes name: rivers with heights, of which one ends before another begins and one has a single height,
/// points, and a DEM with a gap.
class Files {
public:
    Files() {
        std::filesystem::create_directory(folder_.path() / "inputs");
        test::write(folder_.path() / "inputs/rivers.geojson",
                    R"({"type": "FeatureCollection", "crs": {"type": "name", "properties": {"name": )"
                    R"("urn:ogc:def:crs:EPSG::32631"}}, "features": [)"
                    R"({"type": "Feature", "properties": {"name": "a"}, "geometry": {"type": "LineString", )"
                    R"("coordinates": [[500010, 4999790, 210], [500250, 4999600, 140], [500400, 4999500, 120]]}}, )"
                    R"({"type": "Feature", "properties": {"name": "b"}, "geometry": {"type": "LineString", )"
                    R"("coordinates": [[500560, 4999400, 90], [500800, 4999300, 50], [500990, 4999010, 10]]}}, )"
                    R"({"type": "Feature", "properties": {"name": "c"}, "geometry": {"type": "LineString", )"
                    R"("coordinates": [[500900, 4999900, 150], [500850, 4999600, 80], [500800, 4999300, 50]]}}, )"
                    R"({"type": "Feature", "properties": {"name": "d"}, "geometry": {"type": "LineString", )"
                    R"("coordinates": [[500300, 4999950], [500250, 4999600]]}}]})");
        test::write(folder_.path() / "inputs/points.csv", "x,y,z\n500300,4999200,300\n500600,4999800,260\n");
        Raster<float> dem(Grid{50, 50, 20.0, 500000.0, 5000000.0, "EPSG:32631"});
        Raster<float> hill(Grid{12, 12, 20.0, 500000.0, 5000000.0, "EPSG:32632"});
        for (Raster<float>* const raster : {&dem, &hill}) {
            for (std::int64_t i = 0; i < raster->cells(); ++i) {
                Cell const c = raster->grid().at(i);
                (*raster)[i] = static_cast<float>(200 - 2 * c.col - c.row + 9 * ((c.col * 7 + c.row * 5) % 4));
            }
        }
        dem[Cell{3, 45}] = std::numeric_limits<float>::quiet_NaN();
        io::write_dem(dem, (folder_.path() / "inputs/dem.tif").string());
        io::write_dem(hill, (folder_.path() / "inputs/hill.tif").string());
    }

    Document document(std::string const& recipe) const {
        Document document = document_of(recipe);
        document.recipe.folder = folder_.path().string();
        return document;
    }

private:
    io::TemporaryFolder folder_{"thalweg-engine"};
};

std::string const of_lines = "[grid]\nwidth = 50\nheight = 50\ncell = 20\norigin = [500000, 5000000]\n"
                             "[network]\nsource = \"lines\"\n{}[network.lines]\npath = \"inputs/rivers.geojson\"\n";

/// A recipe for each way to make terrain around rivers of a file, and a DEM.
std::vector<std::string> recipes_of_files() {
    auto const lines = [](std::string const& network, std::string const& rest) {
        std::string recipe = of_lines;
        return recipe.replace(recipe.find("{}"), 2, network) + rest;
    };
    std::string const points = "[skeleton]\npoints = \"inputs/points.csv\"\nridges = \"voronoi\"\n";
    std::string const patch = "[[patch]]\nsource = \"inputs/hill.tif\"\nat = [500500, 4999500]\n";
    return {lines("heights = \"graded\"\n", "[surface]\n" + patch),
            lines("", "[surface]\n[output]\nagainst = \"inputs/dem.tif\"\n"),
            lines("heights = \"straight\"\n", points + "[surface]\nmethod = \"diffuse\"\n"),
            lines("heights = \"straight\"\n", "[surface]\nmethod = \"dilate\"\n" + patch),
            lines("heights = \"straight\"\n", points + "[surface]\nmethod = \"tin\"\n"),
            lines("", "[surface]\nmethod = \"raster\"\nsource = \"inputs/dem.tif\"\n" + patch),
            "[surface]\nmethod = \"raster\"\nsource = \"inputs/dem.tif\"\n" + patch};
}

/// Makes a document and others that come of it, with the engine and anew.
void expect_same_after_edits(Document document, int edits, std::uint64_t seed) {
    Watched watched;
    std::mt19937_64 random(seed);
    std::string what = "as it begins";
    std::string all;
    for (int i = 0; i <= edits; ++i) {
        all += what + "\n";
        SCOPED_TRACE(testing::Message() << "seed " << seed << ", after\n" << all);
        Watched::Told const told = watched.make(document);
        std::optional<make::MakeResult> fresh;
        std::string const error = test::error_of([&] { fresh = make::make(document.recipe); });
        ASSERT_EQ(told.measured != nullptr, fresh.has_value()) << told.failed << " / " << error;
        if (fresh) {
            ASSERT_TRUE(are_same(*told.measured, *fresh));
            std::vector<std::string> stages;
            for (StageTime const& time : make::timings_of(*fresh)) {
                stages.push_back(time.stage);
            }
            ASSERT_EQ(recipe::forecast(document.recipe).stages, stages);
        }
        auto const [edit, after] = random_edit(document, random);
        what = name_of(edit);
        document = after;
    }
}

} // namespace

TEST(Engine, MakesWhatMakeMakes) {
    for (std::string const& recipe : {forest, cluster, tree, numbers}) {
        expect_same_after_edits(document_of(recipe), 6, 1);
    }
}

TEST(Engine, MakesWhatMakeMakesOfFiles) {
    Files const files;
    for (std::string const& recipe : recipes_of_files()) {
        expect_same_after_edits(files.document(recipe), 3, 2);
    }
}

TEST(Engine, GivesMissingHeightsByTheSlopeOfTheEdit) {
    Files const files;
    Watched watched;
    Document const first = files.document(recipes_of_files()[1]);
    for (Document const& document : {first, edited(first, "network.slope", "0.02")}) {
        auto const made = watched.make(document).measured;
        ASSERT_NE(made, nullptr);
        EXPECT_TRUE(are_same(*made, make::make(document.recipe)));
    }
}

TEST(Engine, SaysWhatMakeSaysOfAKeptStage) {
    Files const files;
    Watched watched;
    Document const first = files.document(recipes_of_files().front());
    Document const sinks = edited(first, "network.inland", "sink");
    Document const without = apply(first, {"", {UnsetKey{"patch.1"}}}).document;
    auto const has = [](make::MakeResult const& made, std::string_view kind) {
        return std::ranges::any_of(make::findings_of(made), [&](Finding const& found) { return found.kind == kind; });
    };
    for (Document const& document : {first, sinks, without, first}) {
        auto const made = watched.make(document).measured;
        ASSERT_NE(made, nullptr);
        EXPECT_TRUE(are_same(*made, make::make(document.recipe)));
        EXPECT_EQ(has(*made, "lake_without_outline"), document.recipe.network->inland == recipe::InlandEnds::carry);
        EXPECT_EQ(has(*made, "converted"), !document.recipe.patches.empty());
    }
}

TEST(SoakEngine, MakesWhatMakeMakesAfterRandomEdits) {
    std::uint64_t const seed = std::random_device()();
    for (std::string const& recipe : {forest, cluster, tree}) {
        expect_same_after_edits(document_of(recipe), 60, seed);
    }
    Files const files;
    for (std::string const& recipe : recipes_of_files()) {
        expect_same_after_edits(files.document(recipe), 45, seed);
    }
    expect_same_after_edits(document_of(numbers), 6, seed); // targets at random take minutes
}

TEST(Engine, RunsTheStagesThatAnEditTouches) {
    Watched watched;
    Document const first = document_of(cluster);
    std::set<std::string> const all = watched.make(first).stages;
    EXPECT_TRUE(all.contains("grow") && all.contains("prune") && all.contains("fill") && all.contains("drain"));

    Document const pruned = edited(first, "network.prune", "9");
    Watched::Told const second = watched.make(pruned);
    EXPECT_FALSE(second.stages.contains("grow")) << "the cluster is kept";
    EXPECT_TRUE(second.stages.contains("prune") && second.stages.contains("fill"));

    Watched::Told const third = watched.make(edited(pruned, "surface.drain", "fill"));
    EXPECT_FALSE(third.stages.contains("prune") || third.stages.contains("fill")) << "only drainage differs";
    EXPECT_TRUE(third.stages.contains("drain"));

    EXPECT_FALSE(watched.make(edited(pruned, "surface.relief", "300")).stages.contains("prune"));
    Watched::Told const other_arm = watched.make(edited(pruned, "network.dla.branch", "north"));
    EXPECT_TRUE(other_arm.stages.contains("thin"));

    Watched::Told const undone = watched.make(pruned);
    EXPECT_TRUE(undone.stages.empty()) << "the whole terrain is kept";
    EXPECT_EQ(undone.heights.size(), 1U);
    EXPECT_TRUE(are_same(*undone.measured, *second.measured));
}

TEST(Engine, ShowsTheCoarseTerrainThatTheFinishedRefines) {
    Watched watched;
    Document const document =
        document_of("[grid]\nwidth = 512\nheight = 448\ncell = 30\n[network]\nsource = \"forest\"\nprune = "
                    "20\n[network.forest]\noutlet_spacing = 200\nspacing = 25\n[surface]\n");
    Watched::Told const told = watched.make(document);
    ASSERT_EQ(told.heights.size(), 2U);
    auto const& [coarse, is_coarse_finished] = told.heights[0];
    auto const& [fine, is_finished] = told.heights[1];
    EXPECT_FALSE(is_coarse_finished);
    EXPECT_TRUE(is_finished);
    EXPECT_EQ(coarse.width(), 256);
    EXPECT_EQ(coarse.height(), 224);
    EXPECT_GE(correlation(coarse, fine), 0.95);
    auto const range = [](Raster<float> const& dem) { return *std::ranges::max_element(dem.values()); };
    EXPECT_NEAR(range(coarse) / range(fine), 1.0, 0.1) << "no jump";
    EXPECT_TRUE(test::same_bits(fine, told.measured->terrain.ground.dem));
    EXPECT_EQ(told.rivers, 1);
    EXPECT_EQ(told.made, 1);
}

TEST(Engine, StopsForALaterJob) {
    Watched watched;
    watched.hold_at("fill");
    std::int64_t const first = watched.begin(document_of(forest));
    watched.wait_for(first, "fill");
    std::int64_t const second = watched.begin(document_of(cluster));
    watched.hold_at("");
    EXPECT_EQ(second, first + 1);
    EXPECT_EQ(watched.engine().last(), second);
    EXPECT_TRUE(watched.told(first).stopped);
    Watched::Told const told = watched.told(second);
    ASSERT_NE(told.measured, nullptr);
    EXPECT_EQ(watched.engine().wait(second), told.measured);
    EXPECT_GT(watched.engine().slowest_stop_s(), 0.0);
}

TEST(Engine, StopsWhenItIsTold) {
    Watched watched;
    watched.hold_at("fill");
    std::int64_t const first = watched.begin(document_of(forest));
    watched.wait_for(first, "fill");
    watched.engine().stop();
    watched.hold_at("");
    EXPECT_TRUE(watched.told(first).stopped);
    EXPECT_EQ(watched.engine().wait(first), nullptr);
    EXPECT_NE(watched.make(document_of(forest)).measured, nullptr) << "it goes on";
}

TEST(Engine, TellsOfAJobThatIsStoppedBeforeItBegins) {
    Watched watched;
    watched.hold_at("fill");
    std::int64_t const first = watched.begin(document_of(forest));
    watched.wait_for(first, "fill");
    std::int64_t const second = watched.begin(document_of(cluster));
    watched.engine().stop();
    watched.hold_at("");
    EXPECT_TRUE(watched.told(first).stopped);
    EXPECT_TRUE(watched.told(second).stopped);
    EXPECT_TRUE(watched.told(second).stages.empty());
    EXPECT_EQ(watched.engine().wait(second), nullptr);
}

TEST(Engine, GivesTheTerrainOfTheJobAskedFor) {
    Watched watched;
    std::int64_t const first = watched.begin(document_of(numbers));
    EXPECT_EQ(watched.engine().wait(first), watched.told(first).measured);
    std::int64_t const second = watched.begin(document_of(cluster));
    EXPECT_EQ(watched.engine().wait(second), watched.told(second).measured);
    EXPECT_EQ(watched.engine().wait(first), nullptr) << "not that of another";
}

TEST(Engine, SeesThatAFileWasChanged) {
    io::TemporaryFolder const folder("thalweg-engine");
    Document document = document_of("[grid]\nwidth = 40\nheight = 40\ncell = 1\n[skeleton]\npoints = "
                                    "\"inputs/points.csv\"\n[surface]\nmethod = \"tin\"\n");
    document.recipe.folder = folder.path().string();
    std::filesystem::create_directory(folder.path() / "inputs");
    auto const written = [&](char const* top) {
        test::write(folder.path() / "inputs/points.csv", std::string("x,y,z\n500000,5000000,1\n500040,5000000,2\n"
                                                                     "500000,4999960,3\n500040,4999960,") +
                                                             top);
    };
    Watched watched;
    written("4\n");
    auto const low = watched.make(document).measured;
    written("4000\n");
    auto const high = watched.make(document).measured;
    ASSERT_NE(high, nullptr) << watched.told(2).failed;
    EXPECT_FALSE(test::same_bits(low->terrain.ground.dem, high->terrain.ground.dem));
    EXPECT_TRUE(are_same(*high, make::make(document.recipe)));
}

TEST(Engine, CutsRiversAtHolesOfADemThatItKept) {
    io::TemporaryFolder const folder("thalweg-engine");
    Grid const grid{60, 50, 10.0, 500000.0, 5000000.0, "EPSG:32631"};
    Raster<float> dem(grid);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        Cell const c = grid.at(i);
        dem[i] = c.col > 48 ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(100 - c.col);
    }
    std::filesystem::create_directory(folder.path() / "inputs");
    io::write_dem(dem, (folder.path() / "inputs/dem.tif").string());
    Drawing drawing;
    drawing.grid = grid;
    drawing.rivers = {{{{500020.0, 4999750.0}, {500600.0, 4999750.0}}}};
    write_drawing(drawing, (folder.path() / "inputs/drawing.gpkg").string());
    std::string const surface = "[surface]\nmethod = \"raster\"\nsource = \"inputs/dem.tif\"\n";
    std::string const rivers = "[network]\nsource = \"lines\"\n[network.lines]\npath = \"inputs/drawing.gpkg\"\n";
    Document alone = document_of(surface);
    Document cut = document_of("[grid]\nclip = true\n" + rivers + surface);
    alone.recipe.folder = cut.recipe.folder = folder.path().string();
    Watched watched;
    ASSERT_NE(watched.make(alone).measured, nullptr);
    Watched::Told const told = watched.make(cut);
    ASSERT_NE(told.measured, nullptr) << told.failed;
    EXPECT_TRUE(are_same(*told.measured, make::make(cut.recipe)));
}

TEST(Engine, SaysWhyARecipeCannotBeMade) {
    Watched watched;
    Document const broken = document_of("[grid]\nwidth = 60\nheight = 60\n[network]\nsource = \"dla\"\nprune = 1e6\n"
                                        "[network.dla]\nparticles = 500\n[surface]\n");
    Watched::Told const told = watched.make(broken);
    EXPECT_EQ(told.measured, nullptr);
    EXPECT_EQ(told.failed.empty(), test::error_of([&] { make::make(broken.recipe); }).empty());
    EXPECT_NE(watched.make(document_of(forest)).measured, nullptr) << "it goes on";
}

TEST(Engine, KeepsNoMoreThanItMay) {
    ResultCache kept(100);
    kept.keep("a", std::make_shared<int>(1), 60);
    kept.keep("b", std::make_shared<int>(2), 30);
    EXPECT_NE(kept.find("a"), nullptr);
    kept.keep("c", std::make_shared<int>(3), 40); // "b" was used before "a"
    EXPECT_EQ(kept.find("b"), nullptr);
    EXPECT_NE(kept.find("a"), nullptr);
    EXPECT_EQ(kept.bytes(), 100);
    kept.keep("large", std::make_shared<int>(4), 1000);
    EXPECT_NE(kept.find("large"), nullptr) << "the newest stays";
    EXPECT_EQ(kept.find("a"), nullptr);
}

} // namespace engine_test
