// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/skeleton/ridges.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stop_token>
#include <string>
#include <tuple>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/geometry/crossings.hpp>
#include <thalweg/geometry/nearby.hpp>
#include <thalweg/growth/dla/grow_dla.hpp>
#include <thalweg/growth/tokunaga/embed_tree.hpp>
#include <thalweg/network/elevation/set_heights.hpp>
#include <thalweg/network/order/order.hpp>
#include <thalweg/network/vectorise/prune.hpp>
#include <thalweg/network/vectorise/vectorise.hpp>
#include <thalweg/recipe/frame.hpp>

namespace ridges_test {

using namespace thalweg;
using skeleton::ridges;
using skeleton::RidgesParams;
using Method = RidgesParams::Method;

namespace {

using test::full_message_of;
using test::on_threads;

constexpr Method methods[] = {Method::voronoi, Method::segments};

struct Land {
    ElevatedNetwork rivers;
    std::vector<std::int64_t> stream;
    Grid grid;
};

Land raised(StreamNetwork const& plan, Grid grid) {
    return {network::set_heights(plan).network, network::streams(plan, network::order(plan)), std::move(grid)};
}

/// A square filled with a Tokunaga network, far from the origin.
Land tokunaga(std::uint64_t seed, int generator, int order) {
    Grid const grid{200, 200, 10.0, 500000.0, 4500000.0, ""};
    growth::EmbedParams params;
    params.seed = seed;
    params.region = {{500040, 4498040}, {501960, 4498040}, {501960, 4499960}, {500040, 4499960}};
    params.mouth = {501000, 4498040};
    auto const tree = growth::grow_tokunaga({.seed = seed, .generator = generator, .order = order});
    return raised(growth::embed_tree(tree, params).network, grid);
}

/// A branch of a cluster: all vertices are centres of cells, whole circles full of them.
Land dla(std::uint64_t seed) {
    growth::Branch const branch = growth::pick_branch(growth::grow_dla({.particles = 6000, .seed = seed}));
    recipe::FramedBranch const framed = recipe::frame_branch(branch, {});
    StreamNetwork const traced = network::trace(network::thin(framed.mask), {framed.mouth});
    Grid const& grid = framed.mask.grid();
    return raised(network::prune(traced, {.length_m = 4 * grid.cell_m, .cell_m = grid.cell_m}).network, grid);
}

std::vector<Land> const& lands() {
    static std::vector<Land> const made = {tokunaga(3, 2, 5), tokunaga(4, 3, 4), tokunaga(5, 1, 7), dla(11)};
    return made;
}

/// Every ground and method: the ridges, and what the message of a failure begins with.
void everywhere(auto const& look) {
    for (std::size_t i = 0; i < lands().size(); ++i) {
        for (Method const method : methods) {
            SCOPED_TRACE("land " + std::to_string(i) + (method == Method::voronoi ? ", voronoi" : ", segments"));
            RidgesParams params;
            params.method = method;
            RidgeLines const made = ridges(lands()[i].rivers, lands()[i].stream, lands()[i].grid, params);
            ASSERT_GT(made.lines.size(), 20U);
            look(lands()[i], params, made);
        }
    }
}

/// What is near a place: a river's point there, its height, its stream.
struct Near {
    double away = 0.0;
    double z = 0.0;
    std::int64_t stream = 0;
};

/// Rivers looked at one by one: as lines, or as the points set along them (voronoi).
class Rivers {
public:
    Rivers(Land const& land, Method method) {
        for (std::size_t a = 0; a < land.rivers.planform.arc_count(); ++a) {
            auto const& line = land.rivers.planform.arc(a).line;
            auto const& z = land.rivers.arc_z[a];
            for (std::size_t i = 0; i + 1 < line.size(); ++i) {
                double const length = distance(line[i], line[i + 1]);
                double const parts = method == Method::segments ? 1.0 : std::ceil(length / land.grid.cell_m);
                auto const place = [&](double k) {
                    double const t = k / parts;
                    return Vec3{line[i].x + t * (line[i + 1].x - line[i].x),
                                line[i].y + t * (line[i + 1].y - line[i].y), z[i] + t * (z[i + 1] - z[i])};
                };
                for (double k = 0.0; k <= parts; k += 1.0) {
                    if (method == Method::voronoi) {
                        stretches_.push_back({place(k), place(k), land.stream[a]});
                    } else if (k < parts) {
                        stretches_.push_back({place(k), place(k + 1.0), land.stream[a]});
                    }
                }
            }
        }
    }

    /// All that is as near as the nearest, or farther by no more than so much.
    std::vector<Near> nearest(Vec2 p, double slack_m) const {
        std::vector<Near> all;
        double least = std::numeric_limits<double>::infinity();
        for (auto const& [a, b, stream] : stretches_) {
            auto const foot = geometry::foot_on({a.x, a.y}, {b.x, b.y}, p);
            double const away = distance(p, foot.at);
            least = std::min(least, away);
            if (away <= least + slack_m) {
                all.push_back({away, a.z + foot.along * (b.z - a.z), stream});
            }
        }
        std::erase_if(all, [&](Near const& near) { return near.away > least + slack_m; });
        return all;
    }

private:
    struct Stretch {
        Vec3 a;
        Vec3 b;
        std::int64_t stream = 0;
    };
    std::vector<Stretch> stretches_;
};

std::vector<std::vector<Vec2>> plan_of(RidgeLines const& made) {
    std::vector<std::vector<Vec2>> lines;
    for (RidgeLine const& ridge : made.lines) {
        auto& line = lines.emplace_back();
        for (Vec3 const& p : ridge.line) {
            line.push_back({p.x, p.y});
        }
    }
    return lines;
}

std::vector<std::vector<Vec2>> plan_of(StreamNetwork const& network) {
    std::vector<std::vector<Vec2>> lines;
    for (ArcId arc = 0; arc < network.arc_count(); ++arc) {
        lines.push_back(network.arc(arc).line);
    }
    return lines;
}

bool same(RidgeLines const& a, RidgeLines const& b) {
    return std::ranges::equal(a.lines, b.lines, [](RidgeLine const& r, RidgeLine const& s) {
        return r.left == s.left && r.right == s.right &&
               std::ranges::equal(r.line, s.line, [](Vec3 const& p, Vec3 const& q) {
                   return p.x == q.x && p.y == q.y && p.z == q.z; // no -0 among places far from the origin
               });
    });
}

double distance_to(std::vector<std::vector<Vec2>> const& lines, Vec2 p) {
    double least = std::numeric_limits<double>::infinity();
    for (auto const& line : lines) {
        for (std::size_t i = 0; i + 1 < line.size(); ++i) {
            least = std::min(least, distance(p, geometry::foot_on(line[i], line[i + 1], p).at));
        }
    }
    return least;
}

Grid const square{10, 10, 1.0, 0.0, 10.0, ""};

ElevatedNetwork straight(std::vector<std::vector<Vec2>> const& lines) {
    NetworkDraft plan;
    for (auto const& line : lines) {
        NodeId const from = plan.add_node(line.front());
        NodeId const to = plan.add_node(line.back());
        Arc arc;
        arc.line = line;
        plan.add_arc(from, to, std::move(arc));
    }
    return network::set_heights(plan).network;
}

} // namespace

TEST(Ridges, NothingToKeepApartHasNone) {
    ElevatedNetwork const two = straight({{{2, 8}, {2, 2}}, {{7, 8}, {7, 2}}});
    for (Method const method : methods) {
        RidgesParams params;
        params.method = method;
        EXPECT_TRUE(ridges({}, {}, square, params).lines.empty());
        EXPECT_TRUE(ridges(straight({{{2, 8}, {5, 2}}}), {1}, square, params).lines.empty());
        EXPECT_TRUE(ridges(two, {4, 4}, square, params).lines.empty());
        EXPECT_EQ(ridges(two, {4, 5}, square, params).lines.size(), 1U);
    }
}

TEST(Ridges, RefusesWhatDoesNotBelongTogether) {
    ElevatedNetwork const two = straight({{{2, 8}, {2, 2}}, {{7, 8}, {7, 2}}});
    for (Method const method : methods) {
        RidgesParams params;
        params.method = method;
        EXPECT_TRUE(test::has(full_message_of<BadInput>([&] { ridges(two, {1}, square, params); }),
                              "skeleton.ridges: 1 labels"));
        EXPECT_THROW(ridges(two, {1, 2, 3}, square, params), BadInput);
        EXPECT_THROW(ridges({}, {1}, square, params), BadInput);
        ElevatedNetwork other = two;
        other.arc_z.pop_back();
        EXPECT_THROW(ridges(other, {1, 2}, square, params), BadInput);
        other = two;
        other.arc_z[1].pop_back();
        EXPECT_TRUE(test::has(full_message_of<BadInput>([&] {
                                  ridges(other, {1, 2}, square, params);
                              }),
                              "arc 2 from (7.000, 8.000)"));
        other.arc_z[1].push_back(std::nan(""));
        EXPECT_THROW(ridges(other, {1, 2}, square, params), BadInput);
    }
    ElevatedNetwork const across = straight({{{2, 8}, {8, 2}}, {{2, 2}, {8, 8}}});
    RidgesParams params;
    params.method = Method::segments;
    EXPECT_TRUE(test::has(full_message_of<BadInput>([&] {
                              ridges(across, {1, 2}, square, params);
                          }),
                          "(5.000000, 5.000000)"));
}

TEST(Ridges, RefusesParametersOutOfRange) {
    ElevatedNetwork const two = straight({{{2, 8}, {2, 2}}, {{7, 8}, {7, 2}}});
    for (double RidgesParams::*const field : {&RidgesParams::gain, &RidgesParams::farthest_m, &RidgesParams::spacing_m,
                                              &RidgesParams::tolerance_m, &RidgesParams::clear_m}) {
        for (double const bad : {-1e-9, std::nan(""), std::numeric_limits<double>::infinity()}) {
            RidgesParams params;
            params.*field = bad;
            EXPECT_THROW(ridges(two, {1, 2}, square, params), BadParameter);
        }
    }
    for (Grid const& bad : {Grid{0, 5, 1.0, 0.0, 0.0, ""}, Grid{5, 5, 0.0, 0.0, 0.0, ""}}) {
        EXPECT_THROW(ridges(two, {1, 2}, bad), BadParameter);
    }
}

TEST(Ridges, TwoRiversHaveOneFromEdgeToEdge) {
    // Drawn southwards: label 9 lies in the west, on the right of whoever goes south.
    ElevatedNetwork two = straight({{{2, 12}, {2, -2}}, {{7, 12}, {7, -2}}});
    two.arc_z = {{30.0, 10.0}, {20.0, 20.0}};
    for (Method const method : methods) {
        RidgesParams params;
        params.method = method;
        RidgeLines const made = ridges(two, {9, 5}, square, params);
        ASSERT_EQ(made.lines.size(), 1U);
        RidgeLine const& ridge = made.lines.front();
        EXPECT_EQ(std::tuple(ridge.left, ridge.right), std::tuple(5, 9));
        EXPECT_EQ(std::tuple(ridge.line.front().x, ridge.line.front().y), std::tuple(4.5, 10.0));
        EXPECT_EQ(std::tuple(ridge.line.back().x, ridge.line.back().y), std::tuple(4.5, 0.0));
        EXPECT_NEAR(ridge.line.front().z, 30.0 - 20.0 * 2.0 / 14.0 + 0.3 * 2.5, 1e-12);
        EXPECT_NEAR(ridge.line.back().z, 20.0 + 0.3 * 2.5, 1e-12);
        for (Vec3 const& p : ridge.line) {
            EXPECT_NEAR(p.x, 4.5, 1e-12);
        }
    }
}

TEST(Ridges, MeetNoRiver) {
    everywhere([](Land const& land, RidgesParams const&, RidgeLines const& made) {
        auto drawn = plan_of(land.rivers.planform);
        std::size_t const rivers = drawn.size();
        for (auto& line : plan_of(made)) {
            drawn.push_back(std::move(line));
        }
        std::set<std::pair<double, double>> on_rivers;
        auto const found = geometry::crossings(drawn);
        for (auto const& c : found) { // entries of one point have the same place, rivers come first
            if (c.line < rivers) {
                on_rivers.emplace(c.at.x, c.at.y);
            } else {
                EXPECT_FALSE(on_rivers.contains({c.at.x, c.at.y})) << c.at.x << ' ' << c.at.y;
            }
        }
    });
}

TEST(Ridges, MeetOnlyInTheirEndsInsideTheGrid) {
    everywhere([](Land const& land, RidgesParams const&, RidgeLines const& made) {
        auto const drawn = plan_of(made);
        for (auto const& c : geometry::crossings(drawn)) {
            EXPECT_TRUE(c.at == drawn[c.line].front() || c.at == drawn[c.line].back()) << c.at.x << ' ' << c.at.y;
        }
        for (auto const& line : drawn) {
            for (std::size_t i = 0; i < line.size(); ++i) {
                EXPECT_TRUE(i == 0 || line[i] != line[i - 1]);
                EXPECT_TRUE(line[i].x >= land.grid.west && line[i].x <= land.grid.east());
                EXPECT_TRUE(line[i].y >= land.grid.south() && line[i].y <= land.grid.north);
            }
        }
    });
}

TEST(Ridges, AreSortedByStreams) {
    everywhere([](Land const&, RidgesParams const&, RidgeLines const& made) {
        auto const key = [](RidgeLine const& r) {
            return std::tuple(r.left, r.right, r.line.front().x, r.line.front().y, r.line[1].x, r.line[1].y);
        };
        EXPECT_TRUE(std::ranges::is_sorted(made.lines, {}, key));
        EXPECT_TRUE(std::ranges::all_of(made.lines, [](RidgeLine const& r) { return r.left < r.right; }));
    });
}

TEST(Ridges, KeepTwoStreamsApart) {
    everywhere([](Land const& land, RidgesParams const& params, RidgeLines const& made) {
        Rivers const rivers(land, params.method);
        // Chords leave their parabolas by a tenth of a cell.
        double const step = (params.method == Method::segments ? 0.25 : 0.001) * land.grid.cell_m;
        int looked_at = 0;
        for (RidgeLine const& ridge : made.lines) {
            for (std::size_t i = 0; i + 1 < ridge.line.size(); ++i) {
                Vec2 const a{ridge.line[i].x, ridge.line[i].y};
                Vec2 const b{ridge.line[i + 1].x, ridge.line[i + 1].y};
                double const length = distance(a, b);
                Vec2 const off{-(b.y - a.y) * step / length, (b.x - a.x) * step / length};
                auto const streams = [&](double side, double slack_m) {
                    std::set<std::int64_t> found;
                    Vec2 const p{0.5 * (a.x + b.x) + side * off.x, 0.5 * (a.y + b.y) + side * off.y};
                    for (Near const& near : rivers.nearest(p, slack_m)) {
                        found.insert(near.stream);
                    }
                    return found;
                };
                auto const around = streams(0.0, 3.0 * step);
                EXPECT_TRUE(around.contains(ridge.left) && around.contains(ridge.right)) << a.x << ' ' << a.y;
                if (around.size() > 2) {
                    continue; // a third may come first a step aside
                }
                EXPECT_EQ(streams(1.0, 1e-7), (std::set{ridge.left})) << a.x << ' ' << a.y;
                EXPECT_EQ(streams(-1.0, 1e-7), (std::set{ridge.right})) << a.x << ' ' << a.y;
                ++looked_at;
            }
        }
        EXPECT_GT(looked_at, 100);
    });
}

TEST(Ridges, StandMidwayAboveTheirRivers) {
    everywhere([](Land const& land, RidgesParams const& params, RidgeLines const& made) {
        Rivers const rivers(land, params.method);
        for (RidgeLine const& ridge : made.lines) {
            for (Vec3 const& p : ridge.line) {
                auto const near = rivers.nearest({p.x, p.y}, 1e-6);
                double away = std::numeric_limits<double>::infinity();
                for (Near const& n : near) {
                    away = std::min(away, n.away);
                }
                std::set<std::int64_t> streams;
                double least = -std::numeric_limits<double>::infinity(); // of those that are the nearest for certain
                double most = least;
                for (Near const& n : near) {
                    streams.insert(n.stream);
                    least = n.away <= away + 1e-9 ? std::max(least, n.z) : least;
                    most = std::max(most, n.z);
                    EXPECT_GT(p.z, n.z);
                }
                EXPECT_TRUE(streams.contains(ridge.left) && streams.contains(ridge.right)) << p.x << ' ' << p.y;
                EXPECT_GE(away, 0.5 * land.grid.cell_m - 1e-6);
                EXPECT_GE(p.z, least + params.gain * away - 1e-6) << p.x << ' ' << p.y;
                EXPECT_LE(p.z, most + params.gain * away + 1e-6) << p.x << ' ' << p.y;
            }
        }
    });
}

TEST(Ridges, GainAndBoundsChangeOnlyHeights) {
    Land const& land = lands().front();
    for (Method const method : methods) {
        RidgesParams params;
        params.method = method;
        RidgeLines const usual = ridges(land.rivers, land.stream, land.grid, params);
        params.gain = 0.0;
        RidgeLines const flat = ridges(land.rivers, land.stream, land.grid, params);
        params.gain = 0.3;
        params.farthest_m = 30.0;
        RidgeLines const bounded = ridges(land.rivers, land.stream, land.grid, params);
        ASSERT_TRUE(plan_of(flat) == plan_of(usual));
        ASSERT_TRUE(plan_of(bounded) == plan_of(usual));
        double most = 0.0;
        for (std::size_t i = 0; i < usual.lines.size(); ++i) {
            for (std::size_t k = 0; k < usual.lines[i].line.size(); ++k) {
                double const base = flat.lines[i].line[k].z;
                double const rise = usual.lines[i].line[k].z - base;
                EXPECT_NEAR(bounded.lines[i].line[k].z - base, std::min(rise, 9.0), 1e-9);
                most = std::max(most, rise);
            }
        }
        EXPECT_GT(most, 9.0);
    }
}

TEST(Ridges, BothMethodsAgree) {
    for (Land const& land : lands()) {
        double const cell = land.grid.cell_m;
        Grid wider = land.grid; // for what runs along the edges on one side or the other
        wider.width += 20;
        wider.height += 20;
        wider.west -= 10.0 * cell;
        wider.north += 10.0 * cell;
        auto const drawn = [&](Method method, Grid const& grid) {
            RidgesParams params;
            params.method = method;
            return plan_of(ridges(land.rivers, land.stream, grid, params));
        };
        auto const rivers = plan_of(land.rivers.planform);
        std::vector<Vec2> shared; // places of several streams, which nothing keeps apart
        for (NodeId n = 0; n < land.rivers.planform.node_count(); ++n) {
            if (land.rivers.planform.in(n).size() > 1) {
                shared.push_back(land.rivers.planform.node(n).at);
            }
        }
        int looked_at = 0;
        for (Method const method : methods) {
            auto const others = drawn(method == Method::voronoi ? Method::segments : Method::voronoi, wider);
            for (auto const& line : drawn(method, land.grid)) {
                for (Vec2 const p : line) {
                    double const away = distance_to(rivers, p);
                    // Half a cell beside a shared place both methods still take it for the nearest.
                    bool const at_shared = std::ranges::any_of(shared, [&](Vec2 s) {
                        double const d = distance(p, s);
                        return d * d <= away * away + 0.26 * cell * cell;
                    });
                    if (away > 1.5 * cell && !at_shared) { // nearer ones are left out, each method's own
                        EXPECT_LE(distance_to(others, p), cell) << p.x << ' ' << p.y;
                        ++looked_at;
                    }
                }
            }
        }
        EXPECT_GT(looked_at, 500);
    }
}

TEST(Ridges, SameForAnyThreadsAndAgain) {
    everywhere([](Land const& land, RidgesParams const& params, RidgeLines const& made) {
        std::vector<std::vector<double>> clutter; // lets meshes lie elsewhere in memory
        for (int const threads : {1, 4, 1, 2, 1}) {
            thalweg::Run const run = on_threads(threads);
            EXPECT_TRUE(same(made, ridges(land.rivers, land.stream, land.grid, params, run)));
            clutter.emplace_back(static_cast<std::size_t>(1000 * threads));
        }
    });
}

TEST(Ridges, StopWhenAsked) {
    Land const& land = lands().front();
    std::stop_source stopped;
    stopped.request_stop();
    thalweg::Run run;
    run.stop = stopped.get_token();
    for (Method const method : methods) {
        RidgesParams params;
        params.method = method;
        EXPECT_THROW(ridges(land.rivers, land.stream, land.grid, params, run), Cancelled);
    }
}

} // namespace ridges_test
