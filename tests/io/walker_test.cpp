// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Rivers that nobody here drew, from their file to a network.
#include <thalweg/io/read_rivers.hpp>

#include <algorithm>
#include <map>

#include <gtest/gtest.h>

#include <thalweg/network/adopt.hpp>

using namespace thalweg;

namespace {

RiverLines walker() {
    return io::read_rivers({.path = THALWEG_SOURCE_DIR "/samples/walker_nhdplus.gpkg"});
}

} // namespace

TEST(Walker, IsReadWhole) {
    auto const rivers = walker();
    EXPECT_EQ(rivers.lines.size(), 62U);
    EXPECT_EQ(rivers.crs, "EPSG:32610");
    std::size_t vertices = 0;
    for (auto const& line : rivers.lines) { vertices += line.vertices.size(); printf("%ld %zu rank %ld\n",(long)line.feature,line.vertices.size(),(long)line.rank); }
    printf("%zu %d\n", vertices, rivers.has_z);
    for (auto o: {network::Orientation::automatic, network::Orientation::rank, network::Orientation::as_drawn, network::Orientation::topology}) {
    auto a = network::adopt(rivers, {.orientation=o});
    NetworkIndex x(a.network);
    printf("arcs %zu basins %zu\n", x.arcs.size(), x.outlets.size());
    for (auto const& r : a.repairs) printf("%s: %s\n", r.kind.c_str(), r.text.c_str());
    }
}
