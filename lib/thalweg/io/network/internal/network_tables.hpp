// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/height_unit.hpp>
#include <thalweg/core/ridge_lines.hpp>
#include <thalweg/core/river_lines.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/io/network/table.hpp>
#include <thalweg/io/network/write_network.hpp>

namespace thalweg::io {

/// Length [m] of a line and the heights of its vertices.
double length_in_space(std::vector<Vec2> const& line, std::vector<double> const& z);

/// The layer arcs of the network schema. The arguments must outlive the table.
/// short_names: of user columns, for a shapefile.
Table arcs_table(NetworkTables const& tables, bool short_names = false);

/// The layer nodes of the network schema. The arguments must outlive the table.
Table nodes_table(NetworkTables const& tables);

/// The layer ridges of the network schema. The argument must outlive the table; every ridge has a vertex.
Table ridges_table(RidgeLines const& ridges, HeightUnit unit = HeightUnit::metre);

/// The layer secondary: lines that are not in the network, in plan. The arguments must outlive the table.
Table secondary_table(std::vector<SecondaryLine> const& secondary, UserData const* user);

/// The table sources. The argument must outlive the table.
Table sources_table(UserData const& user);

} // namespace thalweg::io
