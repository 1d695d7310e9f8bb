// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/files/files.hpp>

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>

#include "full_disk.hpp"
#include "scratch_folder.hpp"

namespace files_test {

using namespace thalweg;
namespace fs = std::filesystem;

namespace {

using Names = std::vector<std::string>;
using test::error_of;
using test::has;

void put(std::string const& path, std::string const& text = "old") {
    fs::create_directories(fs::path(path).parent_path());
    test::write(path, text);
}

// Everything in a folder, with the contents: "a=old b/c=new ".
std::string content(fs::path const& folder) {
    Names names;
    for (auto const& entry : fs::recursive_directory_iterator(folder)) {
        std::string const name = entry.path().lexically_relative(folder).generic_string();
        names.push_back(entry.is_directory() ? name + "/" : name + "=" + bytes_of(entry.path().string()));
    }
    std::sort(names.begin(), names.end());
    std::string text;
    for (std::string const& name : names) {
        text += name + " ";
    }
    return text;
}

} // namespace

TEST(OutputFolder, BadPlacesAreRefused) {
    ScratchFolder const scratch;
    put(scratch / "file");
    put(scratch / "out/report.json");
    EXPECT_THROW(io::OutputFolder(""), BadParameter);
    EXPECT_THROW(io::OutputFolder(scratch / "file", io::Existing::replace, {"report.json"}), BadInput);
    EXPECT_THROW(io::OutputFolder(scratch / "out", io::Existing::refuse, {"report.json"}), BadInput);
    EXPECT_TRUE(has(error_of([&] { io::OutputFolder(scratch / "out", io::Existing::replace); }), "no report.json"));
    EXPECT_EQ(content(scratch.path()), "file=old out/ out/report.json=old ");
    EXPECT_TRUE(has(error_of([] { io::OutputFolder const out("/proc/thalweg/out"); }), "IoError", "/proc/thalweg: "));
}

TEST(OutputFolder, NothingIsLeftWithoutCommit) {
    ScratchFolder const scratch;
    {
        io::OutputFolder const out(scratch / "a/b/out");
        put(out.path("inputs/rivers.gpkg"));
        EXPECT_TRUE(fs::exists(scratch / "a/b"));
        EXPECT_FALSE(fs::exists(scratch / "a/b/out"));
    }
    EXPECT_EQ(content(scratch.path()), "");
}

TEST(OutputFolder, AppearsWholeAtCommit) {
    ScratchFolder const scratch;
    {
        io::OutputFolder out(scratch / "a/out/");
        put(out.path("dem.tif"), "1");
        put(out.path("inputs/rivers.gpkg"), "2");
        EXPECT_EQ(out.files(), (Names{"dem.tif", "inputs/rivers.gpkg"}));
        EXPECT_FALSE(fs::exists(scratch / "a/out"));
        out.commit();
    }
    EXPECT_EQ(content(scratch.path()), "a/ a/out/ a/out/dem.tif=1 a/out/inputs/ a/out/inputs/rivers.gpkg=2 ");
}

TEST(OutputFolder, EmptyFolderIsFilled) {
    ScratchFolder const scratch;
    fs::create_directory(scratch / "real");
    fs::create_directory_symlink(scratch / "real", scratch / "link");
    {
        io::OutputFolder out(scratch / "link");
        put(out.path("dem.tif"), "1");
        out.commit();
    }
    EXPECT_EQ(content(scratch / "real"), "dem.tif=1 ");
    EXPECT_TRUE(fs::is_symlink(scratch / "link"));
}

TEST(OutputFolder, OverwriteReplacesAndRemovesOnlyWhatIsListed) {
    ScratchFolder const scratch;
    put(scratch / "out/report.json");
    put(scratch / "out/dem.tif");
    put(scratch / "out/map.png");
    put(scratch / "out/inputs/rivers.gpkg");
    put(scratch / "out/notes/mine.txt", "mine");
    {
        io::OutputFolder out(scratch / "out", io::Existing::replace,
                             {"report.json", "dem.tif", "map.png", "inputs/rivers.gpkg", "gone.tif"});
        put(out.path("report.json"), "new");
        put(out.path("dem.tif"), "new");
        EXPECT_EQ(bytes_of(scratch / "out/dem.tif"), "old");
        out.commit();
    }
    EXPECT_EQ(content(scratch.path()), "out/ out/dem.tif=new out/notes/ out/notes/mine.txt=mine out/report.json=new ");
}

TEST(OutputFolder, AddsBesideWhatIsThereAndReplacesOnlyTheSameNames) {
    ScratchFolder const scratch;
    put(scratch / "out/mine.txt");
    put(scratch / "out/map.png");
    put(scratch / "out/other.png");
    {
        io::OutputFolder out(scratch / "out", io::Existing::add);
        io::write_text(out.path("new.png"), "new");
        out.commit();
    }
    EXPECT_EQ(content(scratch.path()), "out/ out/map.png=old out/mine.txt=old out/new.png=new out/other.png=old ");
    {
        io::OutputFolder out(scratch / "out", io::Existing::add);
        io::write_text(out.path("map.png"), "new");
        EXPECT_THROW(out.commit(), BadInput);
    }
    {
        io::OutputFolder out(scratch / "out", io::Existing::add, {"map.png", "other.png"});
        io::write_text(out.path("map.png"), "new");
        out.commit();
    }
    EXPECT_EQ(content(scratch.path()), "out/ out/map.png=new out/mine.txt=old out/new.png=new out/other.png=old ");
}

TEST(OutputFolder, AForeignFileIsNeverReplacedAndNothingChanges) {
    ScratchFolder const scratch;
    put(scratch / "out/report.json");
    put(scratch / "out/dem.tif", "mine");
    std::string const before = content(scratch.path());
    {
        io::OutputFolder out(scratch / "out", io::Existing::replace, {"report.json"});
        put(out.path("report.json"), "new");
        put(out.path("dem.tif"), "new");
        EXPECT_TRUE(has(error_of([&] { out.commit(); }), "BadInput", "dem.tif"));
    }
    EXPECT_EQ(content(scratch.path()), before);
}

TEST(OutputFolder, AFailedCommitTakesEveryMoveBack) {
    ScratchFolder const scratch;
    put(scratch / "out/report.json");
    put(scratch / "out/dem.tif");
    put(scratch / "out/sub", "a file where a folder must go");
    std::string const before = content(scratch.path());
    {
        io::OutputFolder out(scratch / "out", io::Existing::replace, {"report.json", "dem.tif"});
        put(out.path("dem.tif"), "new");
        put(out.path("new/x.tif"), "new");
        put(out.path("sub/y.tif"), "new");
        EXPECT_THROW(out.commit(), IoError);
    }
    EXPECT_EQ(content(scratch.path()), before);
}

TEST(OutputFolder, NamesOutsideTheFolderAreRefused) {
    ScratchFolder const scratch;
    put(scratch / "out/report.json");
    put(scratch / "precious");
    put(scratch / "elsewhere/precious");
    fs::create_directory(scratch / "out/folder");
    fs::create_directory_symlink(scratch / "elsewhere", scratch / "out/link");
    for (std::string const& name :
         {std::string("../precious"), scratch / "precious", std::string("a/../../precious"), std::string(""),
          std::string(".."), std::string("folder"), std::string("link/precious"), std::string("link")}) {
        EXPECT_THROW(io::OutputFolder(scratch / "out", io::Existing::replace, {"report.json", name}), BadInput) << name;
    }
    io::OutputFolder const out(scratch / "new");
    EXPECT_THROW(out.path("../x"), BadParameter);
    EXPECT_THROW(out.path("/x"), BadParameter);
    EXPECT_THROW(out.path(""), BadParameter);
    EXPECT_EQ(bytes_of(scratch / "elsewhere/precious"), "old");
}

TEST(OutputFolder, TwoAtOnceDoNotMeet) {
    ScratchFolder const scratch;
    io::OutputFolder one(scratch / "out");
    io::OutputFolder two(scratch / "out");
    EXPECT_NE(one.staging(), two.staging());
    put(one.path("dem.tif"), "one");
    put(two.path("dem.tif"), "two");
    one.commit();
    EXPECT_THROW(two.commit(), IoError);
    EXPECT_EQ(bytes_of(scratch / "out/dem.tif"), "one");
}

TEST(OutputFile, AppearsWholeOrNotAtAll) {
    ScratchFolder const folder;
    {
        io::OutputFile const file(folder / "a.txt");
        put(file.staging(), "half");
        EXPECT_EQ(folder.entries(), 1);
    }
    EXPECT_EQ(folder.entries(), 0);
    {
        io::OutputFile file(folder / "a.txt");
        put(file.staging(), "whole");
        file.commit();
    }
    EXPECT_EQ(bytes_of(folder / "a.txt"), "whole");
    EXPECT_EQ(folder.entries(), 1);
}

TEST(OutputFile, ReplacesOnlyWhenAsked) {
    ScratchFolder const folder;
    folder.write("a.txt", "old");
    EXPECT_THROW(io::OutputFile(folder / "a.txt"), BadInput);
    {
        io::OutputFile file(folder / "a.txt", io::Existing::replace);
        put(file.staging(), "new");
        EXPECT_EQ(bytes_of(folder / "a.txt"), "old");
        file.commit();
    }
    EXPECT_EQ(bytes_of(folder / "a.txt"), "new");
    io::OutputFile late(folder / "b.txt");
    put(late.staging(), "late");
    folder.write("b.txt", "early");
    EXPECT_THROW(late.commit(), BadInput);
    EXPECT_EQ(bytes_of(folder / "b.txt"), "early");
}

TEST(OutputFile, BadPlacesAreRefused) {
    ScratchFolder const folder;
    std::filesystem::create_symlink("elsewhere", folder / "link");
    EXPECT_THROW(io::OutputFile(""), BadParameter);
    EXPECT_THROW(io::OutputFile(folder / ""), BadParameter);
    for (std::string const& path : {folder / "none/a.txt", folder.path().string(), folder / "link"}) {
        EXPECT_THROW(io::OutputFile(path, io::Existing::replace), BadInput) << path;
    }
}

TEST(Files, TextComesBack) {
    ScratchFolder const scratch;
    std::string const text("a\0b\r\n\xff", 7);
    io::write_text(scratch / "a.txt", text);
    EXPECT_EQ(io::read_text(scratch / "a.txt", 100), text.substr(0, 7));
    io::write_text(scratch / "empty.txt", "");
    EXPECT_EQ(io::read_text(scratch / "empty.txt", 0), "");
}

TEST(Files, WhatCannotBeReadIsRefused) {
    ScratchFolder const scratch;
    EXPECT_THROW(io::read_text(scratch / "none", 10), BadInput);
    EXPECT_THROW(io::read_text(scratch.path().string(), 10), BadInput);
    put(scratch / "ten", "0123456789");
    EXPECT_EQ(io::read_text(scratch / "ten", 10), "0123456789");
    EXPECT_THROW(io::read_text(scratch / "ten", 9), BadInput);
    EXPECT_THROW(io::read_text("/dev/zero", 1000000), BadInput);
}

TEST(Files, NothingIsOverwritten) {
    ScratchFolder const scratch;
    put(scratch / "a", "mine");
    put(scratch / "b");
    EXPECT_THROW(io::write_text(scratch / "a", "x"), IoError);
    EXPECT_THROW(io::copy_file(scratch / "b", scratch / "a"), IoError);
    EXPECT_EQ(bytes_of(scratch / "a"), "mine");
    EXPECT_THROW(io::copy_file(scratch / "none", scratch / "c"), BadInput);
    EXPECT_THROW(io::copy_file(scratch.path().string(), scratch / "c"), BadInput);
    io::copy_file(scratch / "a", scratch / "c");
    EXPECT_EQ(bytes_of(scratch / "c"), "mine");
}

TEST(Files, FullDiskNamesPathAndReason) {
    ScratchFolder const scratch;
    put(scratch / "large", std::string(100000, 'x'));
    FullDisk const full(5000);
    EXPECT_TRUE(has(error_of([&] { io::write_text(scratch / "a", std::string(100000, 'x')); }), "IoError", "/a: "));
    EXPECT_THROW(io::copy_file(scratch / "large", scratch / "b"), IoError);
}

} // namespace files_test
