// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/network/internal/read_network.hpp>

#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>
#include <ogr_geometry.h>
#include <rapidcheck.h>

namespace read_network_links_test {

using namespace thalweg;

// Each law against the obvious search of everything by everything.

namespace {

using FileArc = NetworkFile::FileArc;

// Arcs on a small lattice, so that ends, ids and links often agree; some without vertices, some places NaN or -0.
NetworkFile any_file() {
    NetworkFile file;
    auto const count = *rc::gen::inRange(0, 12);
    auto const place = [] {
        int const x = *rc::gen::inRange(-1, 3);
        int const y = *rc::gen::inRange(0, 2);
        int const z = *rc::gen::inRange(0, 2);
        return Vec3{x < 0 ? -0.0 : x, y == 1 && x == 2 ? std::nan("") : y, static_cast<double>(z)};
    };
    for (int i = 0; i < count; ++i) {
        FileArc arc;
        arc.id = *rc::gen::inRange(0, 8);
        arc.ds_arc = *rc::gen::inRange(-2, 9);
        arc.from_node = *rc::gen::inRange(0, 5);
        arc.to_node = *rc::gen::inRange(0, 5);
        int const vertices = *rc::gen::inRange(0, 4);
        for (int k = 0; k < vertices; ++k) {
            arc.line.push_back(place());
        }
        file.arcs.push_back(arc);
    }
    return file;
}

bool same(double a, double b) {
    return a == b || (std::isnan(a) && std::isnan(b));
}

bool same_place(Vec3 const& a, Vec3 const& b) {
    return same(a.x, b.x) && same(a.y, b.y);
}

struct End {
    Vec3 at;
    std::int64_t node = 0;
};

// In the order of the arcs.
std::vector<End> ends_of(NetworkFile const& file) {
    std::vector<End> ends;
    for (auto const& arc : file.arcs) {
        if (!arc.line.empty()) {
            ends.push_back({arc.line.front(), arc.from_node});
            ends.push_back({arc.line.back(), arc.to_node});
        }
    }
    return ends;
}

FileArc const* first_with(NetworkFile const& file, std::int64_t FileArc::*number, std::int64_t value) {
    auto const found = std::ranges::find(file.arcs, value, number);
    return found == file.arcs.end() ? nullptr : &*found;
}

} // namespace

TEST(ReadNetworkLinks, EndsAreOneNodeExactlyWhereTheyAreOnePlace) {
    ASSERT_TRUE(rc::check([] {
        NetworkFile file = any_file();
        io::name_ends(file);
        auto const ends = ends_of(file);
        std::int64_t most = 0;
        for (std::size_t i = 0; i < ends.size(); ++i) {
            RC_ASSERT(ends[i].node >= 1);
            RC_ASSERT(ends[i].node <= most + 1); // counted in the order of the arcs
            most = std::max(most, ends[i].node);
            for (std::size_t k = 0; k < i; ++k) {
                RC_ASSERT((ends[i].node == ends[k].node) == same_place(ends[i].at, ends[k].at));
            }
        }
        for (auto const& arc : file.arcs) {
            RC_ASSERT(!arc.line.empty() || (arc.from_node == 0 && arc.to_node == 0));
        }
    }));
}

TEST(ReadNetworkLinks, NodesAreWhereMostOfTheirEndsAre) {
    ASSERT_TRUE(rc::check([] {
        NetworkFile file = any_file();
        io::place_nodes(file);
        auto const ends = ends_of(file);
        std::map<std::int64_t, std::vector<Vec3>> claims;
        for (End const& end : ends) {
            if (end.node != 0) {
                claims[end.node].push_back(end.at);
            }
        }
        RC_ASSERT(file.nodes.size() == claims.size());
        std::size_t n = 0;
        for (auto const& [id, places] : claims) {
            Vec3 best = places.front();
            std::ptrdiff_t most = 0;
            for (Vec3 const& place : places) {
                auto const count = std::ranges::count_if(
                    places, [&](Vec3 const& other) { return same_place(place, other) && same(place.z, other.z); });
                if (count > most) {
                    best = place;
                    most = count;
                }
            }
            RC_ASSERT(file.nodes[n].id == id);
            RC_ASSERT(same_place(file.nodes[n].at, best));
            RC_ASSERT(same(file.nodes[n].at.z, best.z));
            ++n;
        }
    }));
}

TEST(ReadNetworkLinks, KeysLeadToTheArcThatHasThem) {
    ASSERT_TRUE(rc::check([] {
        NetworkFile file = any_file();
        std::vector<std::int64_t> keys;
        std::vector<std::int64_t> ds_keys;
        for (std::size_t i = 0; i < file.arcs.size(); ++i) {
            keys.push_back(*rc::gen::inRange(1, 9));
            ds_keys.push_back(*rc::gen::inRange(0, 9));
        }
        io::link_by_keys(file, keys, ds_keys);
        for (std::size_t i = 0; i < file.arcs.size(); ++i) {
            auto const found = std::ranges::find(keys, ds_keys[i]);
            std::int64_t const expected = ds_keys[i] == 0 ? 0
                                          : found == keys.end()
                                              ? -ds_keys[i]
                                              : file.arcs[static_cast<std::size_t>(found - keys.begin())].id;
            RC_ASSERT(file.arcs[i].ds_arc == expected);
        }
    }));
}

TEST(ReadNetworkLinks, LinksLeadToArcsOrNowhere) {
    ASSERT_TRUE(rc::check([] {
        NetworkFile file = any_file();
        NetworkFile const before = file;
        io::Notes notes(false);
        io::drop_links_out(file, "test", notes);
        std::size_t dropped = 0;
        for (std::size_t i = 0; i < file.arcs.size(); ++i) {
            std::int64_t const ds = before.arcs[i].ds_arc;
            bool const leads = ds == 0 || first_with(before, &FileArc::id, ds) != nullptr;
            RC_ASSERT(file.arcs[i].ds_arc == (leads ? ds : 0));
            dropped += leads ? 0U : 1U;
        }
        RC_ASSERT(notes.take().size() == dropped);
    }));
}

TEST(ReadNetworkLinks, AnArcFlowsIntoTheFirstThatBeginsAtItsEnd) {
    ASSERT_TRUE(rc::check([] {
        NetworkFile file = any_file();
        io::link_by_nodes(file);
        for (auto const& arc : file.arcs) {
            FileArc const* const below =
                arc.to_node == 0 ? nullptr : first_with(file, &FileArc::from_node, arc.to_node);
            RC_ASSERT(arc.ds_arc == (below == nullptr ? 0 : below->id));
        }
    }));
}

TEST(ReadNetworkLinks, LinesAreTurnedWhenMostLinkedArcsAreDrawnUp) {
    ASSERT_TRUE(rc::check([](bool drawn_upstream) {
        NetworkFile file = any_file();
        NetworkFile const before = file;
        io::Notes notes(false);
        io::turn_downstream(file, drawn_upstream, "test", notes);
        int up = 0;
        int down = 0;
        for (auto const& arc : before.arcs) {
            FileArc const* const below = first_with(before, &FileArc::id, arc.ds_arc);
            if (below != nullptr && !arc.line.empty() && !below->line.empty()) {
                Vec3 const a = arc.line.front();
                Vec3 const b = arc.line.back();
                Vec3 const c = below->line.front();
                Vec3 const d = below->line.back();
                down += b.x == c.x && b.y == c.y ? 1 : 0;
                up += a.x == d.x && a.y == d.y ? 1 : 0;
            }
        }
        bool const turned = up > down || (up == down && drawn_upstream);
        for (std::size_t i = 0; i < file.arcs.size(); ++i) {
            auto line = before.arcs[i].line;
            if (turned) {
                std::ranges::reverse(line);
            }
            RC_ASSERT(std::ranges::equal(line, file.arcs[i].line, [](Vec3 const& a, Vec3 const& b) {
                return same_place(a, b) && same(a.z, b.z);
            }));
        }
        RC_ASSERT(notes.take().empty() == (turned == drawn_upstream));
    }));
}

TEST(ReadNetworkLinks, ALineInShuffledPiecesIsTheLine) {
    ASSERT_TRUE(rc::check([] {
        auto const pieces = *rc::gen::inRange(1, 8);
        std::vector<std::vector<Vec3>> parts;
        std::vector<Vec3> whole{{0, 0, 9}};
        for (int i = 0; i < pieces; ++i) {
            std::vector<Vec3> part{whole.back()};
            auto const vertices = *rc::gen::inRange(1, 4);
            for (int k = 0; k < vertices; ++k) { // x always grows: no place twice
                Vec3 const p{whole.back().x + *rc::gen::inRange(1, 4), static_cast<double>(*rc::gen::inRange(0, 4)),
                             1.0};
                part.push_back(p);
                whole.push_back(p);
            }
            parts.push_back(part);
        }
        std::vector<std::size_t> order(parts.size());
        for (std::size_t i = 0; i < order.size(); ++i) {
            order[i] = i;
            std::swap(order[i], order[*rc::gen::inRange<std::size_t>(0, i + 1)]);
        }
        OGRMultiLineString shape;
        for (std::size_t const i : order) {
            OGRLineString line;
            for (Vec3 const& p : parts[i]) {
                line.addPoint(p.x, p.y, p.z);
            }
            shape.addGeometry(&line);
        }
        io::OtherShapes others;
        auto const drawn = io::drawn_line(&shape, 1, others);
        RC_ASSERT(others.count() == 0);
        RC_ASSERT(drawn.parts.size() == 1U);
        RC_ASSERT(drawn.parts.front() == whole);
        RC_ASSERT(drawn.drawn_parts == pieces);
    }));
}

} // namespace read_network_links_test
