// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// thalweg make --ensemble: many terrains, one table.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h> // NOLINT(modernize-deprecated-headers): kill is of POSIX
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
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
    expect_run(place, two + "-q", 1, "error: of 4 members 2 could not be made and 0 fail a check: see out/table.csv");
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

// Several first runs in one folder at once: one makes all members, the others say that it works there, or go on with
// it.
void first_runs_at_once(int rounds) {
    Workplace const place;
    std::string const tiny = "make --set grid.width=64 --set grid.height=48 --ensemble 3 "
                             "--only table --threads 1 -q -o ";
    expect_run(place, tiny + "alone", 0);
    std::string const table = file_bytes(place / "alone/table.csv");
    for (int round = 0; round < rounds; ++round) {
        std::string const folder = "out" + std::to_string(round);
        std::vector<Outcome> runs(3);
        {
            std::vector<std::jthread> threads;
            for (Outcome& run : runs) {
                threads.emplace_back([&] { run = thalweg_run(tiny + folder, place.path()); });
            }
        }
        int done = 0;
        for (Outcome const& run : runs) {
            done += run.code == 0 ? 1 : 0;
            EXPECT_TRUE(run.code == 0 || (run.code == 2 && test::has(run.err, "another thalweg works in " + folder)))
                << round << " " << run.code << " " << run.err;
        }
        EXPECT_GE(done, 1) << round;
        EXPECT_EQ(file_bytes(place / folder / "table.csv"), table) << round;
        std::string journals;
        for (auto const& entry : fs::directory_iterator(place / folder / ".ensemble")) {
            journals += entry.path().extension() == ".jsonl" ? file_bytes(entry.path()) : "";
        }
        EXPECT_EQ(std::ranges::count(journals, '\n'), 3) << round << ": each member was made once";
    }
}

TEST(EnsembleCommand, OfFirstRunsAtOnceOneWorks) {
    first_runs_at_once(5);
}

TEST(SoakEnsembleCommand, OfFirstRunsAtOnceOneWorks) {
    first_runs_at_once(50);
}

TEST(EnsembleCommand, AFirstRunThatFailsLeavesNothing) {
    Workplace const place;
    place.write("recipe.toml", "[grid]\nwidth = 24\nheight = 20\n[network]\nsource = \"lines\"\n[network.lines]\n"
                               "path = \"gone.gpkg\"\n[surface]\n");
    expect_run(place, "make recipe.toml --ensemble 2 -o out", 2, "gone.gpkg");
    EXPECT_EQ(names_in(place.path()), (std::vector<std::string>{"recipe.toml"}));
}

TEST(EnsembleCommand, ThatFailedForAReasonThatPassedIsMadeAgainInShardsToo) {
    Workplace const place;
    expect_run(place, few + "-o whole --shards 4", 0);
    // As written by a run in which memory lacked for member 2: its row says so, and the shard has nothing of it.
    expect_run(place, few + "-o out --shards 4", 0);
    std::string const journal = file_bytes(journal_of(place / "out"));
    std::istringstream lines(journal);
    std::string changed;
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("{\"member\":2,")) {
            line.replace(line.find("\"status\":\"ok\""), 13, "\"status\":\"failed\"");
            std::size_t const end = line.find(",\"sum\":");
            line = line.substr(0, end);
            std::uint64_t hash = 0xcbf29ce484222325;
            for (char const c : line) {
                hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
            }
            std::ostringstream sum;
            sum << std::hex << std::setw(16) << std::setfill('0') << hash;
            line += ",\"sum\":\"" + sum.str() + "\"}";
        }
        changed += line + "\n";
    }
    std::ofstream(journal_of(place / "out"), std::ios::binary | std::ios::trunc) << changed;
    place.shell("mkdir x && cd x && tar xf ../out/shard-000000.tar && rm 00000002.* && "
                "tar cf ../out/shard-000000.tar --format=ustar --blocking-factor=1 $(ls | sort -t. -k1,1n)");
    Outcome const again = expect_run(place, few + "-o out --shards 4 --json", 0);
    EXPECT_EQ(again.json()["made_now"], 1);
    EXPECT_TRUE(file_bytes(place / "out/table.csv") == file_bytes(place / "whole/table.csv"));
    place.shell(
        "for f in whole out; do mkdir $f.x && tar xf $f/shard-000000.tar -C $f.x; done && diff -r whole.x out.x");
    EXPECT_EQ(expect_run(place, few + "-o out --shards 4 --json", 0).json()["made_now"], 0);
    // A row that tells of the member, and a shard that was not written yet.
    place.shell("cd x && tar cf ../out/shard-000000.tar --format=ustar --blocking-factor=1 $(ls | sort -t. -k1,1n)");
    EXPECT_EQ(expect_run(place, few + "-o out --shards 4 --json", 0).json()["made_now"], 1);
    place.shell("mkdir y && tar xf out/shard-000000.tar -C y && diff -r whole.x y");
}

TEST(EnsembleCommand, DamagedJournalsAreMendedOrRefusedInWords) {
    Workplace const place;
    std::string const run = few + "--only table -o out";
    expect_run(place, run, 0);
    std::string const table = file_bytes(place / "out/table.csv");
    fs::path const path = journal_of(place / "out");
    std::string const journal = file_bytes(path);
    for (std::size_t at = 7; at < journal.size(); at += journal.size() / 40) {
        if (journal[at] == '\n') {
            continue;
        }
        std::string changed = journal;
        changed[at] = changed[at] == '7' ? '8' : '7';
        for (auto const& entry : fs::directory_iterator(place / "out/.ensemble")) {
            fs::remove(entry.path());
        }
        std::ofstream(path, std::ios::binary | std::ios::trunc) << changed;
        Outcome const again = expect_run(place, few + "--only table --json -o out", 0);
        EXPECT_EQ(again.json()["made_now"], 1) << at;
        EXPECT_EQ(again.json()["findings"][0]["kind"], "rows_damaged") << at;
        EXPECT_EQ(file_bytes(place / "out/table.csv"), table) << at;
    }
    // Neither waits for others nor leads elsewhere.
    ASSERT_EQ(mkfifo((place / "out/.ensemble/rows-a.jsonl").c_str(), 0600), 0);
    expect_run(place, run, 2, "rows-a.jsonl", "remove it");
    fs::remove(place / "out/.ensemble/rows-a.jsonl");
    fs::create_symlink("/dev/zero", place / "out/.ensemble/rows-b.jsonl");
    expect_run(place, run, 2, "rows-b.jsonl", "remove it");
    fs::remove(place / "out/.ensemble/rows-b.jsonl");
    place.write("mine.txt", "mine");
    for (char const* const name : {"run.lock", "start.lock"}) {
        fs::remove(place / "out/.ensemble" / name);
        fs::create_symlink("../../mine.txt", place / "out/.ensemble" / name);
        expect_run(place, run, 2, name, "is a link: remove it");
        fs::remove(place / "out/.ensemble" / name);
        ASSERT_EQ(mkfifo((place / "out/.ensemble" / name).c_str(), 0600), 0);
        expect_run(place, run, 2, name, "is a pipe or a device");
        fs::remove(place / "out/.ensemble" / name);
    }
    fs::rename(place / "out/.ensemble", place / "elsewhere");
    fs::create_symlink("../elsewhere", place / "out/.ensemble");
    expect_run(place, run, 2, ".ensemble is a link");
    EXPECT_EQ(file_bytes(place / "mine.txt"), "mine");
}

TEST(EnsembleCommand, AMemberThatLostAFileIsMadeAgain) {
    Workplace const place;
    expect_run(place, few + "-o out", 0);
    auto const before = content(place / "out/member_00003");
    fs::remove(place / "out/member_00003/dem.tif");
    place.write("out/member_00003/notes.txt", "mine");
    EXPECT_EQ(expect_run(place, few + "--json -o out", 0).json()["made_now"], 1);
    auto after = content(place / "out/member_00003");
    EXPECT_EQ(after["dem.tif"], before.at("dem.tif"));
    EXPECT_EQ(after["notes.txt"], "mine");
    EXPECT_EQ(after.size(), before.size() + 1);
    EXPECT_EQ(expect_run(place, few + "--json -o out", 0).json()["made_now"], 0);
}

// The numbers of members take no memory of their own, and Ctrl-C is obeyed at once.
TEST(EnsembleCommand, ALargeOneStopsAtCtrlC) {
    Workplace const place;
    std::string const words = "make --set grid.width=64 --set grid.height=48 --ensemble "
                              "100000000 --only table --threads 1 -o out";
    std::istringstream stream(words);
    Spawned run({std::istream_iterator<std::string>(stream), {}}, place.path(), [] {
        rlimit const limit{std::uint64_t{1200} << 20U, std::uint64_t{1200} << 20U};
        setrlimit(RLIMIT_AS, &limit);
    });
    auto const has_members = [&] {
        return fs::exists(place / "out/.ensemble") && !journal_of(place / "out").empty() &&
               fs::file_size(journal_of(place / "out")) > 0;
    };
    for (int i = 0; i < 600 && !has_members(); ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    EXPECT_TRUE(has_members());
    auto const begin = std::chrono::steady_clock::now();
    kill(run.pid(), SIGINT);
    Ended const ended = run.wait(60.0);
    EXPECT_EQ(ended.code, 130) << ended.err;
    EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(), 3.0);
    EXPECT_TRUE(test::has(ended.err, "of 100000000 members are in out. The same command goes on")) << ended.err;
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
