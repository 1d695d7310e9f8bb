// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// thalweg make --ensemble: many terrains, one table.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <unistd.h>

#include "command.hpp"
#include "spawned.hpp"

namespace ensemble_test {

namespace fs = std::filesystem;

namespace {

std::string const few =
    "make --set grid.width=64 --set grid.height=48 --ensemble 6 --vary surface.mean_slope=10..30 -q ";

std::vector<std::vector<std::string>> rows_of(fs::path const& table) {
    std::vector<std::vector<std::string>> rows;
    std::ifstream in(table);
    for (std::string line; std::getline(in, line);) {
        std::stringstream fields(line);
        rows.emplace_back();
        for (std::string field; std::getline(fields, field, ',');) {
            rows.back().push_back(field);
        }
    }
    return rows;
}

/// The only journal of an ensemble.
fs::path journal_of(fs::path const& folder) {
    for (auto const& entry : fs::directory_iterator(folder / ".ensemble")) {
        if (entry.path().extension() == ".jsonl") {
            return entry.path();
        }
    }
    return {};
}

} // namespace

TEST(EnsembleCommand, TheTableIsTheSameForAnyNumberOfThreads) {
    Workplace const place;
    Outcome const one = expect_run(place, few + "--threads 1 -o one", 0);
    EXPECT_EQ(one.out, "one\n");
    expect_run(place, few + "--threads 2 -o two", 0);
    expect_run(place, few + "--threads 4 -o four", 0);
    std::string const table = file_bytes(place / "one/table.csv");
    EXPECT_TRUE(file_bytes(place / "two/table.csv") == table);
    EXPECT_TRUE(file_bytes(place / "four/table.csv") == table);
    auto const rows = rows_of(place / "one/table.csv");
    ASSERT_EQ(rows.size(), 7U);
    EXPECT_EQ(rows[0][0] + rows[0][1] + rows[0][2] + rows[0][3], "memberseedsurface.mean_slopestatus");
    EXPECT_EQ(rows[6][0] + " " + rows[6][1] + " " + rows[6][3], "5 12 ok");
    EXPECT_EQ(rows_of(place / "one/timings.csv").size(), 7U);
    // A member is what make makes.
    expect_run(place,
               "make --set grid.width=64 --set grid.height=48 -q -o alone --only dem,network --seed 12 --set "
               "surface.mean_slope=" +
                   rows[6][2],
               0);
    for (char const* const file : {"dem.tif", "network.gpkg", "network_arcs.shp", "network.tif", "recipe.toml"}) {
        EXPECT_TRUE(file_bytes(place / "two/member_00005" / file) == file_bytes(place / "alone" / file)) << file;
    }
    expect_run(place, "replay two/member_00005 --verify -q", 0);
}

TEST(EnsembleCommand, GoesOnWhereItStopped) {
    Workplace const place;
    expect_run(place, few + "-o out", 0);
    std::string const table = file_bytes(place / "out/table.csv");
    // As after kill -9: a folder not yet in place, and a row cut off.
    fs::remove_all(place / "out/member_00002");
    std::string const journal = file_bytes(journal_of(place / "out"));
    fs::path const path = journal_of(place / "out");
    std::ofstream(path, std::ios::binary | std::ios::trunc) << journal.substr(0, journal.size() - 40);
    fs::remove(place / "out/table.csv");
    fs::create_directory(place / "out/.thalweg-tmp-elsewhere-1");
    std::string const kept = "out/member_00000/report.json";
    auto const written = fs::last_write_time(place / kept);
    Outcome const again = expect_run(place, few + "--json -o out", 0);
    EXPECT_EQ(again.json()["made_now"], 2);
    EXPECT_EQ(again.json()["found"], 4);
    EXPECT_TRUE(file_bytes(place / "out/table.csv") == table);
    EXPECT_EQ(fs::last_write_time(place / kept), written);
    // More members of the same ensemble.
    std::string more = few;
    more.replace(more.find("--ensemble 6"), 12, "--ensemble 7");
    EXPECT_EQ(expect_run(place, more + "--json -o out", 0).json()["made_now"], 1);
    EXPECT_TRUE(file_bytes(place / "out/table.csv").starts_with(table));
}

TEST(EnsembleCommand, SharesMakeTheSameTable) {
    Workplace const place;
    expect_run(place, few + "-o whole", 0);
    for (char const* const share : {"1/4", "2/4", "4/4"}) {
        expect_run(place, few + "-o shared --share " + share, 0);
    }
    EXPECT_FALSE(fs::exists(place / "shared/table.csv"));
    EXPECT_EQ(expect_run(place, few + "--json -o shared", 0).json()["made_now"], 1); // share 3 of 4 was lost
    EXPECT_TRUE(file_bytes(place / "shared/table.csv") == file_bytes(place / "whole/table.csv"));
}

TEST(EnsembleCommand, FailedMembersAreRows) {
    Workplace const place;
    std::string const two = "make --set grid.width=64 --set grid.height=48 --ensemble 4 --vary "
                            "surface.mean_slope=25,95 --vary network.source=forest,forest,forest,tokunaga -o out ";
    Outcome const run =
        expect_run(place, two, 1, "2 of 4 members could not be made", "member 1: surface.mean_slope = 95");
    auto const rows = rows_of(place / "out/table.csv");
    ASSERT_EQ(rows.size(), 5U);
    EXPECT_EQ(rows[1][4], "ok");
    EXPECT_EQ(rows[2][4], "failed");
    EXPECT_TRUE(fs::exists(place / "out/member_00002/dem.tif"));
    EXPECT_FALSE(fs::exists(place / "out/member_00001"));
    std::string const table = file_bytes(place / "out/table.csv");
    expect_run(place, two + "-q", 1);
    EXPECT_TRUE(file_bytes(place / "out/table.csv") == table);
}

TEST(EnsembleCommand, TableAlone) {
    Workplace const place;
    expect_run(place, few + "-o out --only dem,table", 0);
    EXPECT_TRUE(fs::exists(place / "out/member_00005/dem.tif"));
    EXPECT_FALSE(fs::exists(place / "out/member_00005/network.gpkg"));
    expect_run(place, few + "-o bare --only table", 0);
    EXPECT_FALSE(fs::exists(place / "bare/member_00000"));
    EXPECT_TRUE(file_bytes(place / "bare/table.csv") == file_bytes(place / "out/table.csv"));
    EXPECT_EQ(expect_run(place, few + "-o bare --only table --json", 0).json()["made_now"], 0);
}

TEST(EnsembleCommand, ShardsHoldPairs) {
    Workplace const place;
    expect_run(place, few + "-o folders", 0);
    expect_run(place, few + "-o shards --shards 4", 0);
    EXPECT_TRUE(file_bytes(place / "shards/table.csv") == file_bytes(place / "folders/table.csv"));
    EXPECT_FALSE(fs::exists(place / "shards/member_00000"));
    place.shell(
        "mkdir all && cat shards/shard-000001.tar | tar tf - > names && tar xf shards/shard-000000.tar -C all && "
        "tar xf shards/shard-000001.tar -C all");
    EXPECT_EQ(file_bytes(place / "names"), "00000004.dem.tif\n00000004.rivers.png\n00000004.json\n"
                                           "00000005.dem.tif\n00000005.rivers.png\n00000005.json\n");
    EXPECT_TRUE(file_bytes(place / "all/00000003.dem.tif") == file_bytes(place / "folders/member_00003/dem.tif"));
    // The same cells are rivers; 255 in the picture, 1 in network.tif.
    place.shell(
        "gdal_translate -q -of XYZ all/00000003.rivers.png mask && gdal_translate -q -of XYZ "
        "folders/member_00003/network.tif rivers && cut -d' ' -f3 mask | sed s/255/1/ > a && cut -d' ' -f3 rivers > "
        "b && cmp a b && grep -q 1 a");
    auto const json = nlohmann::json::parse(file_bytes(place / "all/00000003.json"));
    EXPECT_EQ(json["seed"], 10);
    EXPECT_EQ(json["keys"]["surface.mean_slope"], rows_of(place / "folders/table.csv")[4][2]);
    // A lost shard is packed again, with the same bytes.
    std::string const shard = file_bytes(place / "shards/shard-000001.tar");
    fs::remove(place / "shards/shard-000001.tar");
    EXPECT_EQ(expect_run(place, few + "-o shards --shards 4 --json", 0).json()["made_now"], 2);
    EXPECT_TRUE(file_bytes(place / "shards/shard-000001.tar") == shard);
    EXPECT_FALSE(fs::exists(place / "shards/.ensemble/shard-000001"));
}

TEST(EnsembleCommand, FilesOfTheRecipeAreKeptOnce) {
    Workplace const place;
    fs::copy_file(samples + "walker_nhdplus.gpkg", place / "rivers.gpkg");
    std::string const around = "make rivers.gpkg --set grid.cell=400 --ensemble 2 -q -o out ";
    expect_run(place, around, 0);
    EXPECT_TRUE(file_bytes(place / "out/inputs/rivers.gpkg") == file_bytes(place / "rivers.gpkg"));
    expect_run(place, "replay out/member_00001 --verify -q", 0);
    place.shell("ogr2ogr -where 'OGC_FID < 0' fewer.gpkg rivers.gpkg || true; printf x >> rivers.gpkg");
    expect_run(place, around, 2, "holds another ensemble", "inputs/rivers.gpkg differs");
}

TEST(EnsembleCommand, ASecondRunInTheFolderIsRefused) {
    Workplace const place;
    expect_run(place, few + "-o out", 0);
    auto const before = content(place.path());
    int const lock = open((place / "out/.ensemble/run.lock").c_str(), O_RDWR);
    ASSERT_EQ(flock(lock, LOCK_EX), 0);
    expect_run(place, few + "-o out", 2, "another thalweg works in out");
    close(lock);
    expect_run(place, few + "--seed 8 -o out", 2, "holds another ensemble", "there: \"seed\": 7");
    expect_run(place, few + "--set surface.mean_slope=20 --set network.prune=9 -o out", 2, "holds another ensemble");
    fs::create_directory(place / "mine");
    place.write("mine/notes.txt", "x");
    expect_run(place, few + "-o mine", 2, "mine already exists and holds no ensemble");
    fs::remove_all(place / "mine");
    EXPECT_EQ(content(place.path()).size(), before.size());
}

TEST(EnsembleCommand, AFullDiskIsToldAndLeavesWholeMembers) {
    Workplace const place;
    expect_run(place, few + "-o out", 0);
    std::string const table = file_bytes(place / "out/table.csv");
    fs::remove_all(place / "out/member_00003");
    std::istringstream words(few + "-o out");
    std::vector<std::string> arguments{std::istream_iterator<std::string>(words), {}};
    Ended const ended = spawn(arguments, place.path(), [] {
        rlimit const limit{30000, 30000};
        setrlimit(RLIMIT_FSIZE, &limit);
    });
    EXPECT_EQ(ended.code, 1) << ended.err;
    EXPECT_TRUE(test::has(ended.err, "5 of 6 members are in out. The same command goes on")) << ended.err;
    EXPECT_FALSE(fs::exists(place / "out/member_00003"));
    expect_run(place, few + "-o out", 0);
    EXPECT_TRUE(file_bytes(place / "out/table.csv") == table);
    expect_run(place, few + "-o /proc/out", 1, "/proc/out");
}

TEST(EnsembleCommand, WrongOptionsAreRefused) {
    Workplace const place;
    expect_refused(place, "make --set grid.width=64 --set grid.height=48",
                   {"--vary surface.mean_slope=1..2",
                    "--shards 3",
                    "--share 1/2",
                    "--ensemble 0",
                    "--ensemble 3 --seeds 1-2",
                    "--seeds 5",
                    "--seeds 9-3",
                    "--seeds -1-3",
                    "--ensemble 3 --shards 0",
                    "--ensemble 3 --share 4/3",
                    "--ensemble 3 --share 0/3",
                    "--ensemble 3 --share 4",
                    "--ensemble 3 --vary surface.mean_slope=95",
                    "--ensemble 3 --overwrite",
                    "--ensemble 3 --shards --only table",
                    "--ensemble 3 --shards --only dem,pictures",
                    "--ensemble 3 --only tabel",
                    "--only table",
                    "--vary seed=1..2 --ensemble 3",
                    "--seeds 9223372036854775806-9223372036854775807",
                    "--ensemble 2 nofile.toml",
                    "--ensemble 2 --vary surface.mean_slope=1,2 --vary surface.mean_slope=2"});
    expect_run(place, "make --set grid.width=64 --set grid.height=48 --dry-run --seeds 3-12", 0);
    EXPECT_TRUE(fs::is_empty(place.path()));
}

} // namespace ensemble_test
