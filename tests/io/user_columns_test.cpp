// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/user_columns.hpp>

#include <string>
#include <vector>

#include <gtest/gtest.h>

using namespace thalweg;
using io::Schema;

namespace {

using Names = std::vector<std::string>;

AttributeTable columns_named(Names const& names) {
    AttributeTable table;
    for (std::string const& name : names) {
        table.columns.push_back({name, AttributeTable::Type::text});
    }
    return table;
}

} // namespace

TEST(UserColumns, WithoutColumnsThereAreNoNames) {
    EXPECT_TRUE(io::user_names({}, {"arc_id"}).empty());
    EXPECT_TRUE(io::short_user_names({}, {"arc_id"}).empty());
}

TEST(UserColumns, ColumnsOfAnotherSchemaGetAPrefixBesideAForeignOne) {
    AttributeTable const nhdplus = columns_named({"COMID", "GNIS_Name", "hydroseq", "ToNode", "LengthKM"});
    Names const taudem{"LINKNO", "DSLINKNO", "Length"};
    EXPECT_EQ(io::user_names(nhdplus, taudem, Schema::taudem),
              (Names{"u_COMID", "GNIS_Name", "u_hydroseq", "u_ToNode", "LengthKM"}));
    // The network schema is recognised whatever stands beside it, and half of what tells a schema tells nothing.
    EXPECT_EQ(io::user_names(nhdplus, {"arc_id"}, Schema::native),
              (Names{"COMID", "GNIS_Name", "hydroseq", "ToNode", "LengthKM"}));
    EXPECT_EQ(io::user_names(columns_named({"COMID", "next_down", "stream"}), taudem, Schema::taudem),
              (Names{"COMID", "next_down", "stream"}));
}

TEST(UserColumns, AColumnOfTheUserMayCompleteAnotherSchemaBesideTheLayersOwn) {
    EXPECT_EQ(io::user_names(columns_named({"next_stream", "other"}), {"LINKNO", "DSLINKNO", "stream"}, Schema::taudem),
              (Names{"u_next_stream", "other"}));
    EXPECT_EQ(io::user_names(columns_named({"from_node", "TO_NODE", "ds_arc", "arc_id"}), {"cat", "next_stream"},
                             Schema::grass),
              (Names{"u_from_node", "u_TO_NODE", "u_ds_arc", "u_arc_id"}));
}
