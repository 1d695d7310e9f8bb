// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/studio/document_folder.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>
#include <make/ascii_grid.hpp>
#include <signal.h> // NOLINT(modernize-deprecated-headers): kill is of POSIX
#include <support.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include <thalweg/commands/make.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/report/report.hpp>
#include <thalweg/studio/internal/journal.hpp>

namespace document_folder_test {

using namespace thalweg;
using namespace thalweg::studio;

namespace {

namespace fs = std::filesystem;
using test::bytes_of;
using test::error_of;
using test::has;

std::string const land = "[grid]\nwidth = 32\nheight = 32\n[skeleton]\nscatter = 9\n[surface]\nmethod = \"tin\"\n";

Edit seed(std::int64_t value) {
    return {"", {SetKey{"seed", std::to_string(value)}}};
}

class DocumentFolders : public testing::Test {
protected:
    DocumentFolders() { test::write(at("land.toml"), land); }

    std::string at(std::string const& name) const { return (folder_.path() / name).string(); }
    /// A document with a small land.
    std::string made(std::string const& name) const {
        new_document(at(name), at("land.toml"));
        return at(name);
    }
    /// The same with three edits, one of which is undone.
    std::string edited(std::string const& name) const {
        made(name);
        DocumentFolder document(at(name));
        document.edit(seed(1));
        document.edit({"a drag", {SetKey{"seed", "2"}, SetKey{"seed", "3"}}});
        document.edit(seed(4));
        document.undo();
        return at(name);
    }

private:
    io::TemporaryFolder folder_{"thalweg-studio"};
};

std::uint64_t seed_in(std::string const& folder) {
    return DocumentFolder(folder).document().recipe.seed;
}

/// Edits as fast as it can, and writes a byte after each edit, until it is killed.
[[noreturn]] void edit_until_killed(std::string const& folder, int said) {
    DocumentFolder document(folder);
    for (std::int64_t value = 1;; ++value) {
        document.edit(seed(value));
        if (::write(said, "x", 1) != 1) {
            _exit(1);
        }
    }
}

/// Kills such a process after so many edits and microseconds: no edit is lost that it had ended.
void expect_nothing_lost(std::string const& folder, int edits, unsigned int microseconds) {
    std::array<int, 2> ends{};
    ASSERT_EQ(pipe(ends.data()), 0);
    pid_t const child = fork();
    if (child == 0) {
        edit_until_killed(folder, ends[1]);
    }
    close(ends[1]);
    std::uint64_t said = 0;
    char byte = 0;
    while (said < static_cast<std::uint64_t>(edits) && read(ends[0], &byte, 1) == 1) {
        ++said;
    }
    usleep(microseconds);
    kill(child, SIGKILL);
    while (read(ends[0], &byte, 1) == 1) {
        ++said;
    }
    close(ends[0]);
    ASSERT_EQ(waitpid(child, nullptr, 0), child);
    ASSERT_GE(said, static_cast<std::uint64_t>(edits));
    DocumentFolder const again(folder);
    std::uint64_t const done = again.history().done.size();
    EXPECT_TRUE(done == said || done == said + 1) << done << " of " << said;
    EXPECT_EQ(again.document().recipe.seed, done == 0 ? 7 : done);
}

} // namespace

TEST_F(DocumentFolders, HoldARecipeItsInputsAndEveryEdit) {
    std::string const folder = edited("d");
    DocumentFolder document(folder);
    EXPECT_EQ(document.document().recipe.seed, 3U);
    EXPECT_EQ(document.history().done.size(), 2U);
    EXPECT_EQ(document.history().undone.size(), 1U);
    EXPECT_TRUE(document.notes().empty());
    EXPECT_EQ(bytes_of(folder + "/recipe.toml"), document.document().toml);
    EXPECT_TRUE(document.redo());
    EXPECT_FALSE(document.redo());
    EXPECT_EQ(document.document().recipe.seed, 4U);
    while (document.undo()) {
    }
    EXPECT_EQ(document.document().recipe.seed, 7U);
    EXPECT_EQ(bytes_of(folder + "/recipe.toml"), document.document().toml);
}

TEST_F(DocumentFolders, ARefusedEditChangesNothing) {
    std::string const folder = made("d");
    DocumentFolder document(folder);
    std::string const history = bytes_of(folder + "/history.jsonl");
    EXPECT_TRUE(has(error_of([&] { document.edit(seed(-1)); }), "BadParameter", "outside its range"));
    document.edit(seed(7)); // what it is
    EXPECT_FALSE(document.undo());
    EXPECT_EQ(bytes_of(folder + "/history.jsonl"), history);
}

TEST_F(DocumentFolders, BeginWithNothingARecipeRiversOrAFolderOfMake) {
    new_document(at("nothing"));
    EXPECT_EQ(DocumentFolder(at("nothing")).document().recipe.grid.width, 1024);
    test::write(at("rivers.geojson"), test::geojson(test::line("[0,0],[0,900]")));
    new_document(at("rivers"), at("rivers.geojson"));
    DocumentFolder const rivers(at("rivers"));
    std::string const name = rivers.document().recipe.network->lines.path;
    EXPECT_TRUE(name.starts_with("inputs/"));
    EXPECT_EQ(bytes_of(at("rivers/" + name)), bytes_of(at("rivers.geojson")));
    commands::run_make({at("land.toml"), at("made")});
    new_document(at("again"), at("made"));
    EXPECT_EQ(DocumentFolder(at("again")).document().recipe.skeleton->scatter, 9);
    EXPECT_TRUE(has(error_of([&] { new_document(at("made"), at("land.toml")); }), "BadInput"));
    EXPECT_TRUE(has(error_of([&] { new_document(at("no"), at("nowhere")); }), "BadInput"));
    EXPECT_FALSE(fs::exists(at("no")));
}

TEST_F(DocumentFolders, BeginWithADem) {
    write_ascii_grid(at("dem.asc"), {30, 20, 10, 500000, 4000000}, [](int c, int r) { return c + 0.3 * r; });
    new_document(at("d"), at("dem.asc"));
    DocumentFolder document(at("d"));
    recipe::Recipe const recipe = document.document().recipe;
    EXPECT_EQ(recipe.surface->method, recipe::Method::raster);
    EXPECT_EQ(recipe.surface->source, "inputs/source/dem.asc");
    EXPECT_EQ(recipe.grid.width, 30);
    EXPECT_EQ(recipe.grid.cell_m, 10.0);
    EXPECT_EQ(bytes_of(at("d/inputs/source/dem.asc")), bytes_of(at("dem.asc")));
    Raster<float> const dem = make::make(recipe).terrain.ground.dem;
    EXPECT_EQ((dem[Cell{7, 5}]), 7.0F + 1.5F);
    document.edit({"coarser", {SetKey{"grid.cell", "20"}, UnsetKey{"grid.width"}, UnsetKey{"grid.height"}}});
    EXPECT_EQ(recipe::resolve(document.document().recipe).grid->width, 15);
    document.edit({"the file's", {UnsetKey{"grid.cell"}}});
    EXPECT_EQ(recipe::resolve(document.document().recipe).grid->width, 30);
    test::write(at("dem.toml"), "[surface]\nmethod = \"raster\"\nsource = \"dem.asc\"\n");
    new_document(at("e"), at("dem.toml"));
    EXPECT_EQ(DocumentFolder(at("e")).document().recipe.grid.cell_m, 10.0);
}

TEST_F(DocumentFolders, InputsAreTakenIn) {
    std::string const folder = made("d");
    DocumentFolder document(folder);
    test::write(at("points.csv"), "x,y,z\n500100,4999900,5\n500200,4999800,9\n500300,4999500,1\n");
    TakeInput const first = document.take("skeleton.points", at("points.csv"));
    TakeInput const second = document.take("skeleton.points", at("points.csv"));
    EXPECT_EQ(first.file, "inputs/1/points.csv");
    EXPECT_EQ(second.file, "inputs/2/points.csv");
    document.edit({"points", {UnsetKey{"skeleton.scatter"}, second}});
    EXPECT_EQ(document.document().recipe.skeleton->points, second.file);
    EXPECT_EQ(bytes_of(folder + "/" + second.file), bytes_of(at("points.csv")));
    EXPECT_TRUE(document.undo());
    EXPECT_TRUE(fs::exists(folder + "/" + second.file));
    EXPECT_TRUE(has(error_of([&] { document.take("skeleton.points", at("none")); }), "BadInput", "no file"));
    EXPECT_FALSE(fs::exists(folder + "/inputs/3"));
}

TEST_F(DocumentFolders, AreOpenInOneProcessAlone) {
    std::string const folder = made("d");
    DocumentFolder const document(folder);
    EXPECT_TRUE(has(error_of([&] { DocumentFolder const second(folder); }), "BadInput studio.DocumentFolder",
                    "is open in another"));
}

TEST_F(DocumentFolders, WhatMakeMakesOfTheRecipeIsTheSame) {
    new_document(at("d"));
    DocumentFolder document(at("d"));
    document.edit({"", {ReplaceRecipe{recipe::write_recipe(recipe::default_recipe_on(64, 64))}}});
    document.edit({"", {SetKey{"network.heights", "graded"}, SetKey{"seed", "3"}}});
    commands::run_make({at("d/recipe.toml"), at("by_make")});
    make::MakeResult const shown = make::make(document.document().recipe);
    report::write_terrain(shown, at("shown"));
    for (std::string const name : {"dem.tif", "network.gpkg", "network.tif", "recipe.toml"}) {
        EXPECT_FALSE(bytes_of(at("by_make/" + name)).empty()) << name;
        EXPECT_EQ(bytes_of(at("by_make/" + name)), bytes_of(at("shown/" + name))) << name;
    }
}

TEST_F(DocumentFolders, AHistoryOpensWhereverItIsCut) {
    std::string const folder = edited("d");
    std::string const history = bytes_of(folder + "/history.jsonl");
    std::string const recipe = bytes_of(folder + "/recipe.toml");
    std::size_t const undo = history.rfind("{\"undo");
    for (std::size_t bytes = 0; bytes < history.size(); ++bytes) {
        Journal const journal = read_journal(std::string_view(history).substr(0, bytes), recipe);
        EXPECT_EQ(journal.fault, "") << bytes;
        EXPECT_EQ(journal.bytes == bytes, bytes == 0 || history[bytes - 1] == '\n') << bytes;
        if (bytes % 16 != 0 && bytes + 16 < undo) {
            continue; // it takes its time
        }
        test::write(folder + "/history.jsonl", history.substr(0, bytes));
        test::write(folder + "/recipe.toml", recipe);
        // The recipe is newer, but for the last cuts: after them it is a state that an edit came after.
        EXPECT_EQ(seed_in(folder), bytes < undo ? 3U : 4U) << bytes;
        EXPECT_EQ(DocumentFolder(folder).document().toml, bytes_of(folder + "/recipe.toml")) << bytes;
    }
}

TEST_F(DocumentFolders, TheHistoryIsNewerThanARecipeThatWasOneOfItsStates) {
    std::string const folder = edited("d");
    std::string const recipe = bytes_of(folder + "/recipe.toml");
    std::string const first = recipe::write_recipe(recipe::read_recipe(land, ""));
    test::write(folder + "/recipe.toml", first);
    EXPECT_EQ(seed_in(folder), 3U);
    EXPECT_EQ(bytes_of(folder + "/recipe.toml"), recipe);
    fs::remove(folder + "/recipe.toml");
    EXPECT_EQ(seed_in(folder), 3U);
    EXPECT_EQ(bytes_of(folder + "/recipe.toml"), recipe);
}

TEST_F(DocumentFolders, WhatWasChangedElsewhereIsAnEdit) {
    std::string const folder = edited("d");
    test::write(folder + "/recipe.toml", "# mine\nseed = 99\n" + land);
    DocumentFolder document(folder);
    EXPECT_EQ(document.document().recipe.seed, 99U);
    ASSERT_EQ(document.notes().size(), 1U);
    EXPECT_TRUE(has(document.notes()[0], "changed elsewhere"));
    EXPECT_TRUE(document.undo());
    EXPECT_EQ(document.document().recipe.seed, 3U);
}

TEST_F(DocumentFolders, ACommentIsNoEdit) {
    std::string const folder = edited("d");
    std::string const recipe = bytes_of(folder + "/recipe.toml");
    test::write(folder + "/recipe.toml", "# mine\n" + recipe);
    DocumentFolder document(folder);
    EXPECT_EQ(document.document().recipe.seed, 3U);
    EXPECT_TRUE(document.notes().empty());
    EXPECT_EQ(bytes_of(folder + "/recipe.toml"), recipe);
    EXPECT_TRUE(document.redo());
}

TEST_F(DocumentFolders, ARecipeWithFaultsIsRefusedAndStays) {
    std::string const folder = edited("d");
    test::write(folder + "/recipe.toml", "seeds = 99\n");
    EXPECT_TRUE(has(error_of([&] { DocumentFolder const document(folder); }), "BadParameter", "unknown key 'seeds'"));
    EXPECT_EQ(bytes_of(folder + "/recipe.toml"), "seeds = 99\n");
}

TEST_F(DocumentFolders, HostileHistoriesAreTrimmedInWords) {
    std::string const folder = edited("d");
    std::string const history = bytes_of(folder + "/history.jsonl");
    std::string const recipe = bytes_of(folder + "/recipe.toml");
    std::string const begin = R"({"edit":"","line":)";
    std::string const rest = R"(,"old":"","new":"","steps":[)";
    std::vector<std::string> const lines = {"garbage",
                                            std::string("\0\xFF{", 3),
                                            "[]",
                                            "{}",
                                            R"({"redo":1})",
                                            begin + "1e300" + rest + "]}",
                                            begin + "18446744073709551615" + rest + "]}",
                                            begin + "-1" + rest + "]}",
                                            begin + "99999" + rest + "]}",
                                            begin + "0" + rest + "7]}",
                                            begin + "0" + rest + R"({"take":"../../x","for":"surface.mask"}]})",
                                            begin + "0" + rest + R"({"take":"/etc/passwd","for":"surface.mask"}]})",
                                            R"({"edit":"","line":0,"old":"no such line\n","new":"","steps":[]})",
                                            std::string(100000, '['),
                                            R"({"edit":)" + std::string(100000, '[') + std::string(100000, ']') + "}"};
    for (std::string const& line : lines) {
        bool const is_redo = line.find("redo") != std::string::npos; // there is one, but not two
        std::string const before = history + (is_redo ? line + "\n" : "");
        test::write(folder + "/recipe.toml", recipe);
        test::write(folder + "/history.jsonl", before + line + "\n{\"undo\":1}\n");
        {
            DocumentFolder const document(folder);
            EXPECT_EQ(document.document().recipe.seed, is_redo ? 4U : 3U) << line.substr(0, 100);
            ASSERT_FALSE(document.notes().empty());
            EXPECT_TRUE(has(document.notes().back(), "cannot be read", "history.jsonl.damaged")) << line.substr(0, 100);
        }
        EXPECT_EQ(bytes_of(folder + "/history.jsonl.damaged"), before + line + "\n{\"undo\":1}\n");
        fs::remove(folder + "/history.jsonl.damaged");
        EXPECT_TRUE(DocumentFolder(folder).notes().empty());
    }
}

TEST_F(DocumentFolders, HostileFoldersAreRefusedInWords) {
    EXPECT_TRUE(
        has(error_of([&] { DocumentFolder const none(at("none")); }), "BadInput", "not the folder of a document"));
    std::string const folder = edited("d");
    fs::remove(folder + "/recipe.toml");
    test::write(folder + "/history.jsonl", "garbage\n");
    EXPECT_TRUE(has(error_of([&] { DocumentFolder const none(folder); }), "neither a recipe nor a history"));
    std::string const points = "[grid]\nwidth = 9\nheight = 9\n[surface]\nmethod = \"tin\"\n[skeleton]\npoints = ";
    test::write(folder + "/recipe.toml", points + "\"/etc/passwd\"\n");
    EXPECT_TRUE(has(error_of([&] { DocumentFolder const none(folder); }), "below inputs/"));
    test::write(folder + "/recipe.toml", points + "\"inputs/1/out.csv\"\n");
    fs::create_directories(folder + "/inputs/1");
    fs::create_symlink("/etc/passwd", folder + "/inputs/1/out.csv");
    EXPECT_TRUE(has(error_of([&] { DocumentFolder const none(folder); }), "by a link"));
}

TEST_F(DocumentFolders, WhatCanNoLongerBeRedoneIsDroppedNowAndThen) {
    std::string const folder = made("d");
    {
        DocumentFolder document(folder);
        for (int i = 0; i < 40; ++i) {
            document.edit(seed(100 + i));
            document.undo();
        }
    }
    auto const before = fs::file_size(folder + "/history.jsonl");
    EXPECT_EQ(DocumentFolder(folder).history().undone.size(), 1U);
    EXPECT_LT(2 * fs::file_size(folder + "/history.jsonl"), before);
    DocumentFolder document(folder);
    EXPECT_TRUE(document.redo());
    EXPECT_EQ(document.document().recipe.seed, 139U);
}

TEST_F(DocumentFolders, KilledAtTwentyMomentsLoseNothingThatWasDone) {
    for (int edits = 1; edits <= 20; ++edits) {
        expect_nothing_lost(made("d" + std::to_string(edits)), edits, 0);
    }
}

TEST(SoakDocumentFolders, KilledAtRandomMomentsLoseNothingThatWasDone) {
    io::TemporaryFolder const folder("thalweg-studio");
    test::write(folder.path() / "land.toml", land);
    std::mt19937 random(std::random_device{}());
    for (int i = 0; i < 50; ++i) {
        std::string const name = (folder.path() / std::to_string(i)).string();
        new_document(name, (folder.path() / "land.toml").string());
        expect_nothing_lost(name, static_cast<int>(random() % 30U), static_cast<unsigned int>(random() % 20000U));
    }
}

} // namespace document_folder_test
