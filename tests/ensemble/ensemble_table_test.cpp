// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/ensemble/internal/ensemble_table.hpp>

#include <cmath>
#include <string>

#include <gtest/gtest.h>
#include <io/scratch_folder.hpp>
#include <rapidcheck.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/files/files.hpp>

namespace ensemble_table_test {

using namespace thalweg;
using ensemble::csv_records;
using ensemble::MembersTable;
using Records = std::vector<std::vector<std::string>>;

namespace {

MembersTable read(std::string const& text) {
    ScratchFolder const folder;
    std::string const path = folder / "table.csv";
    io::write_text(path, text);
    return ensemble::read_members_table(path);
}

std::string quoted(std::string const& text) {
    std::string out = "\"";
    for (char const c : text) {
        out += c == '"' ? "\"\"" : std::string(1, c);
    }
    return out + "\"";
}

} // namespace

TEST(EnsembleTable, RecordsAreThoseOfTheStandard) {
    EXPECT_EQ(csv_records("", "t"), Records{});
    EXPECT_EQ(csv_records("a,b\n1,2", "t"), (Records{{"a", "b"}, {"1", "2"}}));
    EXPECT_EQ(csv_records("\xEF\xBB\xBF"
                          "a,b\r\n1,\r\n",
                          "t"),
              (Records{{"a", "b"}, {"1", ""}}));
    EXPECT_EQ(csv_records("a,b\n\"x, \"\"y\"\"\r\nz\",\"\"\n", "t"), (Records{{"a", "b"}, {"x, \"y\"\r\nz", ""}}));
    for (std::string const bad :
         {"a,b\n1\n", "a,b\n1,2,3\n", "a\n\"1", "a\n\"1\"x\n", "a\n1\"2\n", "a\r1\n", "a\n\n\xFF\n"}) {
        EXPECT_THROW(csv_records(bad, "t"), BadInput) << bad;
    }
    EXPECT_THROW(csv_records(std::string("a\n\0\n", 4), "t"), BadInput);
}

TEST(EnsembleTable, AnyTextComesBack) {
    ASSERT_TRUE(rc::check([] {
        auto const letters = rc::gen::elementOf(std::string("ab,\"\n\r 1"));
        auto const rows = *rc::gen::container<std::vector<std::string>>(rc::gen::container<std::string>(letters));
        std::string text = "x,y\n";
        Records records = {{"x", "y"}};
        for (std::string const& row : rows) {
            text += quoted(row) + ",1\n";
            records.push_back({row, "1"});
        }
        RC_ASSERT(csv_records(text, "t") == records);
    }));
}

TEST(EnsembleTable, ColumnsHaveTheirPlaces) {
    MembersTable const table =
        read("member,seed,surface.mean_slope,network.source,status,reason,warnings,check.nan,law.hack,dem.mean\n"
             "0,7,12.5,dla,ok,,2,0,0.57,\n"
             "2,18446744073709551615,,forest,failed,\"a, b\",0,,,\n"
             "1,9,3,dla,check_failed,nan,0,1,-1e-3,250\n");
    EXPECT_EQ(table.keys, (std::vector<std::string>{"surface.mean_slope", "network.source"}));
    ASSERT_EQ(table.members.size(), 3U);
    EXPECT_EQ(table.members[1].number, 2);
    EXPECT_EQ(table.members[1].seed, "18446744073709551615");
    EXPECT_EQ(table.members[1].reason, "a, b");
    EXPECT_EQ(table.members[2].status, ensemble::DrawnStatus::check_failed);
    ASSERT_EQ(table.measures.size(), 2U);
    EXPECT_EQ(table.measures[0].name, "law.hack");
    EXPECT_DOUBLE_EQ(table.measures[0].values[2], -0.001);
    EXPECT_TRUE(std::isnan(table.measures[1].values[0]));
}

TEST(EnsembleTable, BadTablesAreRefused) {
    for (std::string const bad :
         {"", "member,law.hack\n", "seed,law.hack\n1,2\n", "member,law.hack\nx,1\n", "member,law.hack\n-1,1\n",
          "member,law.hack\n0,1\n0,2\n", "member,law.hack\n0,\n", "member,seed\n0,1\n", "member,law.hack\n0,one\n",
          "member,law.hack\n0,nan\n", "member,law.hack\n0,1e999\n", "member,law.hack,law.hack\n0,1,2\n",
          "member,status,law.hack\n0,fine,1\n", "\x89PNG\r\n\x1a\n"}) {
        EXPECT_THROW(read(bad), BadInput) << bad;
    }
    EXPECT_THROW(ensemble::read_members_table("nowhere.csv"), BadInput);
}

} // namespace ensemble_table_test
