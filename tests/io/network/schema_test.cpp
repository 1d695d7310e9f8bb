// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/network/schema.hpp>

#include <algorithm>
#include <set>
#include <sstream>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>

namespace schema_test {

using namespace thalweg;
using io::Quantity;
using io::Schema;

namespace {

using test::error_of;
using test::has;

std::string lowered(std::string_view text) {
    std::string low(text);
    std::ranges::transform(low, low.begin(),
                           [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    return low;
}

std::set<std::string> words_of(std::string_view text) {
    std::istringstream stream{lowered(text)};
    std::set<std::string> words;
    for (std::string word; stream >> word;) {
        words.insert(word);
    }
    return words;
}

} // namespace

TEST(Schema, NamesLeadBackToWhatTheyName) {
    for (int q = 0; q < static_cast<int>(Quantity::constant); ++q) {
        auto const quantity = static_cast<Quantity>(q);
        EXPECT_EQ(io::quantity_of(io::name_of(quantity)), quantity) << io::name_of(quantity);
    }
    EXPECT_EQ(io::quantity_of("constant"), std::nullopt);
    EXPECT_EQ(io::quantity_of("ARC_ID"), std::nullopt);
    EXPECT_EQ(io::name_of(Quantity::braided), "braided");
    EXPECT_EQ(io::name_of(Quantity::us_arc_5), "us_arc_5");
    EXPECT_EQ(io::name_of(Quantity::own_area), "own_area");
    for (auto const& table : io::all_schemas()) {
        EXPECT_EQ(io::schema_named(std::string(table.name)), table.schema);
        EXPECT_EQ(&io::table_of(table.schema), &table);
    }
    EXPECT_TRUE(has(error_of([&] { io::schema_named("nhdpluss"); }), "BadInput", "'nhdplus'"));
}

TEST(Schema, NoTwoFieldsOfATableGoByOneName) {
    for (auto const& table : io::all_schemas()) {
        std::set<std::string> seen;
        for (auto const& field : table.fields) {
            for (auto const& word : words_of(std::string(field.name) + " " + std::string(field.also))) {
                EXPECT_TRUE(seen.insert(word).second) << table.name << ": " << word;
            }
        }
    }
}

TEST(Schema, AShortenedNameIsKnownToo) {
    for (auto const& table : io::all_schemas()) {
        for (auto const& field : table.fields) {
            if (field.name.size() > 10 && field.quantity != Quantity::constant) {
                EXPECT_TRUE(words_of(field.also).contains(lowered(field.name).substr(0, 10))) << field.name;
            }
        }
    }
}

TEST(Schema, WhatTellsASchemaIsAmongItsFields) {
    // r.stream.extract's stream_type says nothing that is read.
    std::set<std::string> const besides{"stream_type", "stream_typ"};
    for (auto const& table : io::all_schemas()) {
        std::set<std::string> names;
        for (auto const& field : table.fields) {
            names.merge(words_of(std::string(field.name) + " " + std::string(field.also)));
        }
        ASSERT_FALSE(table.told_by.empty());
        for (auto const& told : table.told_by) {
            for (auto const& word : words_of(told)) {
                EXPECT_TRUE(names.contains(word) || besides.contains(word)) << table.name << ": " << word;
            }
        }
    }
}

TEST(Schema, EverySchemaLinksItsArcs) {
    for (auto const& table : io::all_schemas()) {
        EXPECT_NE(io::field_of(table, Quantity::arc_id), nullptr) << table.name;
        EXPECT_NE(io::field_of(table, Quantity::ds_arc), nullptr) << table.name;
        EXPECT_EQ(io::field_of(table, Quantity::constant) == nullptr, table.schema == Schema::native);
    }
    EXPECT_EQ(io::field_of(io::table_of(Schema::taudem), Quantity::ds_arc)->unknown, -1.0);
    EXPECT_EQ(io::field_of(io::table_of(Schema::hydrorivers), Quantity::ds_area)->unit, 1e6);
    EXPECT_EQ(io::field_of(io::table_of(Schema::nhdplus), Quantity::z_up)->unit, 0.01);
    EXPECT_EQ(io::field_of(io::table_of(Schema::grass), Quantity::ds_area), nullptr);
}

} // namespace schema_test
