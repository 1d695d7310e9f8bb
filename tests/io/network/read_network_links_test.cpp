// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How the arcs of a file hang together: read_network against the obvious search of everything by everything.
#include <algorithm>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/io/network/read_network.hpp>

#include "vector_files.hpp"

namespace read_network_links_test {

using namespace thalweg;

namespace {

using FileArc = NetworkFile::FileArc;

/// An arc as the file has it: its key stands in rank, that of the arc downstream in basin.
using Drawn = std::vector<FileArc>;

/// Arcs on a small lattice, so that ends, ids and links often agree; some without vertices, some places -0.
Drawn any_arcs() {
    Drawn arcs(*rc::gen::inRange<std::size_t>(1, 12));
    for (FileArc& arc : arcs) {
        arc.id = *rc::gen::inRange(1, 8);
        arc.ds_arc = *rc::gen::inRange(-2, 9);
        arc.from_node = *rc::gen::inRange(0, 5);
        arc.to_node = *rc::gen::inRange(0, 5);
        arc.rank = *rc::gen::inRange(1, 9);
        arc.basin = *rc::gen::inRange(0, 9);
        int const vertices = *rc::gen::element(0, 2, 2, 3);
        for (int k = 0; k < vertices; ++k) {
            int const x = *rc::gen::inRange(-1, 3);
            arc.line.push_back({x < 0 ? -0.0 : x, static_cast<double>(*rc::gen::inRange(0, 2)),
                                static_cast<double>(*rc::gen::inRange(1, 3))});
        }
    }
    return arcs;
}

std::string text_of(std::vector<Vec3> const& line) {
    std::string text;
    for (Vec3 const& p : line) {
        text += fmt::format("{}[{},{},{}]", text.empty() ? "" : ",", p.x, p.y, p.z);
    }
    return text;
}

NetworkFile read(Drawn const& arcs, io::ReadNetworkParams const& params) {
    std::string features;
    for (FileArc const& arc : arcs) {
        features += fmt::format(
            R"({}{{"type":"Feature","properties":{{"i":{},"d":{},"f":{},"t":{},"k":{},"e":{}}},)"
            R"("geometry":{}}})",
            features.empty() ? "" : ",", arc.id, arc.ds_arc, arc.from_node, arc.to_node, arc.rank, arc.basin,
            arc.line.empty() ? "null" : R"({"type":"LineString","coordinates":[)" + text_of(arc.line) + "]}");
    }
    ScratchFolder const folder;
    folder.write("net.geojson", test::geojson(features));
    return io::read_network(folder / "net.geojson", params);
}

bool same_place(Vec3 const& a, Vec3 const& b) {
    return a.x == b.x && a.y == b.y;
}

FileArc const* first_with(Drawn const& arcs, std::int64_t FileArc::*number, std::int64_t value) {
    auto const found = std::ranges::find(arcs, value, number);
    return found == arcs.end() ? nullptr : &*found;
}

/// Turns all lines where more linked arcs are drawn upstream than downstream. Gives whether it did.
bool turn(Drawn& arcs) {
    int up = 0;
    int down = 0;
    for (FileArc const& arc : arcs) {
        FileArc const* const below = first_with(arcs, &FileArc::id, arc.ds_arc);
        if (below != nullptr && !arc.line.empty() && !below->line.empty()) {
            down += same_place(arc.line.back(), below->line.front()) ? 1 : 0;
            up += same_place(arc.line.front(), below->line.back()) ? 1 : 0;
        }
    }
    for (FileArc& arc : arcs) {
        if (up > down) {
            std::ranges::reverse(arc.line);
        }
    }
    return up > down;
}

/// Numbers the places where arcs begin and end, from 1 in the order of the arcs.
void name_ends(Drawn& arcs) {
    std::vector<Vec3> places;
    auto const number = [&](Vec3 const& at) {
        auto const found = std::ranges::find_if(places, [&](Vec3 const& place) { return same_place(place, at); });
        std::int64_t const n = found - places.begin() + 1;
        if (found == places.end()) {
            places.push_back(at);
        }
        return n;
    };
    for (FileArc& arc : arcs) {
        arc.from_node = arc.line.empty() ? 0 : number(arc.line.front());
        arc.to_node = arc.line.empty() ? 0 : number(arc.line.back());
    }
}

/// By node where most of its ends are, else the first of them.
std::map<std::int64_t, Vec3> places_of(Drawn const& arcs) {
    std::map<std::int64_t, std::vector<Vec3>> ends;
    for (FileArc const& arc : arcs) {
        if (!arc.line.empty()) {
            ends[arc.from_node].push_back(arc.line.front());
            ends[arc.to_node].push_back(arc.line.back());
        }
    }
    ends.erase(0);
    std::map<std::int64_t, Vec3> best;
    for (auto const& [node, at] : ends) {
        best[node] = *std::ranges::max_element(at, {}, [&](Vec3 const& p) { return std::ranges::count(at, p); });
    }
    return best;
}

} // namespace

TEST(ReadNetworkLinks, ArcsAreLinkedByIdsKeysOrNodes) {
    ASSERT_TRUE(rc::check([] {
        bool const has_ends = *rc::gen::arbitrary<bool>();
        bool const has_keys = *rc::gen::arbitrary<bool>();
        bool const has_links = has_keys || !has_ends || *rc::gen::arbitrary<bool>();
        io::ReadNetworkParams params{.fields = {{"arc_id", "i"}}};
        if (has_ends) {
            params.fields.insert({{"from_node", "f"}, {"to_node", "t"}});
        }
        if (has_keys) {
            params.fields.insert({{"key", "k"}, {"ds_key", "e"}});
            params.schema = io::Schema::nhdplus; // the schema with keys
        } else if (has_links) {
            params.fields.insert({"ds_arc", "d"});
        }
        Drawn arcs = any_arcs();
        NetworkFile const file = read(arcs, params);

        std::ptrdiff_t dropped = 0; // links that leave the file
        for (FileArc& arc : arcs) {
            FileArc const* const below =
                has_keys ? first_with(arcs, &FileArc::rank, arc.basin) : first_with(arcs, &FileArc::id, arc.ds_arc);
            dropped += has_links && below == nullptr && (has_keys ? arc.basin : arc.ds_arc) != 0 ? 1 : 0;
            arc.ds_arc = !has_links || below == nullptr ? 0 : below->id;
        }
        bool const turned = turn(arcs);
        if (!has_ends) {
            name_ends(arcs);
        }
        for (FileArc& arc : arcs) {
            FileArc const* const below =
                arc.to_node == 0 ? nullptr : first_with(arcs, &FileArc::from_node, arc.to_node);
            arc.ds_arc = has_links ? arc.ds_arc : below == nullptr ? 0 : below->id;
        }

        RC_ASSERT(file.arcs.size() == arcs.size());
        for (std::size_t i = 0; i < arcs.size(); ++i) {
            RC_ASSERT(file.arcs[i].id == arcs[i].id);
            RC_ASSERT(file.arcs[i].line == arcs[i].line);
            RC_ASSERT(file.arcs[i].ds_arc == arcs[i].ds_arc);
            RC_ASSERT(file.arcs[i].from_node == arcs[i].from_node);
            RC_ASSERT(file.arcs[i].to_node == arcs[i].to_node);
        }
        RC_ASSERT(count_of(file, "cut_below") == dropped);
        RC_ASSERT(count_of(file, "turned") == (turned ? 1 : 0));
        auto const places = places_of(arcs);
        RC_ASSERT(file.nodes.size() == places.size());
        for (std::size_t n = 0; auto const& [id, at] : places) {
            RC_ASSERT(file.nodes[n].id == id);
            RC_ASSERT(file.nodes[n].at == at);
            ++n;
        }
    }));
}

TEST(ReadNetworkLinks, ALineInShuffledPiecesIsTheLine) {
    ASSERT_TRUE(rc::check([] {
        auto const pieces = *rc::gen::inRange<std::size_t>(1, 8);
        std::vector<std::string> parts;
        std::vector<Vec3> whole{{0, 0, 9}};
        for (std::size_t i = 0; i < pieces; ++i) {
            std::vector<Vec3> part{whole.back()};
            auto const vertices = *rc::gen::inRange(1, 4);
            for (int k = 0; k < vertices; ++k) { // x always grows: no place twice
                part.push_back({part.back().x + *rc::gen::inRange(1, 4), double(*rc::gen::inRange(0, 4)), 1.0});
                whole.push_back(part.back());
            }
            parts.insert(parts.begin() + *rc::gen::inRange<std::ptrdiff_t>(0, std::ssize(parts) + 1),
                         "[" + text_of(part) + "]");
        }
        ScratchFolder const folder;
        folder.write("net.geojson", test::geojson(fmt::format(R"({{"type":"Feature","properties":{{}},"geometry":)"
                                                              R"({{"type":"MultiLineString","coordinates":[{}]}}}})",
                                                              fmt::join(parts, ","))));
        NetworkFile const file = io::read_network(folder / "net.geojson", {.any_lines = true});
        RC_ASSERT(file.arcs.size() == 1U);
        RC_ASSERT(file.arcs[0].line == whole);
        RC_ASSERT(finding_of(file, "multi_part").amount == (pieces > 1 ? static_cast<double>(pieces) : 0.0));
    }));
}

} // namespace read_network_links_test
