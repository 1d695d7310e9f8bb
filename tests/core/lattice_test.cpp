// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/lattice.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>

namespace lattice_test {

using namespace thalweg;

namespace {

float const hole = std::numeric_limits<float>::quiet_NaN();

Raster<float> hills(std::int64_t width, std::int64_t height) {
    return test::raster_of(test::frame(width, height, 10.0), [](Cell c) {
        return static_cast<float>((c.col * 37 + c.row * 91 + c.col * c.row * 13) % 101);
    });
}

/// Mean of the linear interpolant of z around x, by the trapezium rule between kinks.
double mean_around(std::vector<double> const& z, double x, double half) {
    auto const at = [&](double p) {
        auto const k = std::min(static_cast<std::size_t>(p), z.size() - 2);
        return z[k] + (z[k + 1] - z[k]) * (p - static_cast<double>(k));
    };
    if (half == 0.0) {
        return at(x);
    }
    double sum = 0.0;
    double from = x - half;
    while (from < x + half) {
        double const to = std::min(x + half, std::floor(from) + 1.0);
        sum += 0.5 * (at(from) + at(to)) * (to - from);
        from = to;
    }
    return sum / (2.0 * half);
}

/// Cubic convolution as Keys 1981 writes it: with a kernel, and a cell added at either end.
double cubic_at(std::vector<double> z, double x) {
    z.insert(z.begin(), 2.0 * z[0] - z[1]);
    z.push_back(2.0 * z[z.size() - 1] - z[z.size() - 2]);
    double sum = 0.0;
    for (std::size_t k = 0; k < z.size(); ++k) {
        double const s = std::fabs(x + 1.0 - static_cast<double>(k));
        double const u = s <= 1.0   ? 1.5 * s * s * s - 2.5 * s * s + 1.0
                         : s <= 2.0 ? -0.5 * s * s * s + 2.5 * s * s - 4.0 * s + 2.0
                                    : 0.0;
        sum += u * z[k];
    }
    return sum;
}

std::vector<double> along(std::vector<double> const& z, std::int64_t count) {
    std::vector<double> out;
    double const last = static_cast<double>(z.size() - 1);
    double const step = last / static_cast<double>(count - 1);
    for (std::int64_t i = 0; i < count; ++i) {
        double const x = static_cast<double>(i) * last / static_cast<double>(count - 1);
        out.push_back(step < 1.0 ? cubic_at(z, x)
                                 : mean_around(z, x, step == 1.0 ? 0.0 : std::min({0.5 * step, x, last - x})));
    }
    return out;
}

/// Row by row, then column by column, without limits of overshoot.
Raster<double> slowly(Raster<float> const& dem, std::int64_t width, std::int64_t height) {
    Raster<double> wide(test::frame(width, dem.height()));
    for (std::int64_t r = 0; r < dem.height(); ++r) {
        auto const row = along({dem.row(r).begin(), dem.row(r).end()}, width);
        std::copy(row.begin(), row.end(), wide.row(r).begin());
    }
    Raster<double> out(test::frame(width, height));
    for (std::int64_t c = 0; c < width; ++c) {
        std::vector<double> column;
        for (std::int64_t r = 0; r < dem.height(); ++r) {
            column.push_back(wide[Cell{c, r}]);
        }
        column = along(column, height);
        for (std::int64_t r = 0; r < height; ++r) {
            out[Cell{c, r}] = column[static_cast<std::size_t>(r)];
        }
    }
    return out;
}

using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// How often triangles run through each edge.
std::map<Edge, int> edges_of(LatticeMesh const& mesh) {
    std::map<Edge, int> edges;
    for (auto const& t : mesh.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            ++edges[{t[k], t[(k + 1) % 3]}];
        }
    }
    return edges;
}

double volume_of(LatticeMesh const& mesh) {
    double volume = 0.0;
    for (auto const& t : mesh.triangles) {
        volume += dot(mesh.vertices[t[0]], cross(mesh.vertices[t[1]], mesh.vertices[t[2]])) / 6.0;
    }
    return volume;
}

} // namespace

TEST(Lattice, TooSmallDemsAndSizesAreRefused) {
    EXPECT_TRUE(test::has(test::message_of<BadInput>([] { lattice(hills(5, 1), 5, 5); }), "5 x 1"));
    for (std::int64_t const side : {-1, 0, 1, 16386}) {
        EXPECT_NE(test::message_of<BadParameter>([&] { lattice(hills(5, 5), side, 5); }), "") << side;
        EXPECT_NE(test::message_of<BadParameter>([&] { lattice(hills(5, 5), 5, side); }), "") << side;
    }
}

TEST(Lattice, AsManyVerticesAsCellsAreTheCells) {
    Raster<float> dem = hills(7, 5);
    dem[Cell{3, 2}] = hole;
    Lattice const same = lattice(dem, 7, 5);
    EXPECT_TRUE(test::same_bits(same.z, dem));
    EXPECT_EQ(same.row_step_m, 10.0);
    EXPECT_EQ(same.z.grid(), dem.grid());
}

TEST(Lattice, IsTheSlowOnesWithinTheCellsAround) {
    ASSERT_TRUE(rc::check("cubic or mean along each axis, clamped", [] {
        auto const side = [] { return *rc::gen::inRange<std::int64_t>(2, 24); };
        Raster<float> const dem = hills(side(), side());
        std::int64_t const width = side();
        std::int64_t const height = side();
        Lattice const fast = lattice(dem, width, height, test::on_threads(3));
        Raster<double> const slow = slowly(dem, width, height);
        for (std::int64_t i = 0; i < slow.cells(); ++i) {
            Cell const c = slow.grid().at(i);
            auto const x = static_cast<double>(c.col * (dem.width() - 1)) / static_cast<double>(width - 1);
            auto const y = static_cast<double>(c.row * (dem.height() - 1)) / static_cast<double>(height - 1);
            double const wide =
                std::max(1.0, 0.5 * static_cast<double>(dem.width() - 1) / static_cast<double>(width - 1));
            double const tall =
                std::max(1.0, 0.5 * static_cast<double>(dem.height() - 1) / static_cast<double>(height - 1));
            double low = 1e9;
            double high = -1e9;
            for (std::int64_t k = 0; k < dem.cells(); ++k) {
                Cell const near = dem.grid().at(k);
                if (std::fabs(static_cast<double>(near.col) - x) < wide + 1.0 &&
                    std::fabs(static_cast<double>(near.row) - y) < tall + 1.0) {
                    low = std::min(low, static_cast<double>(dem[k]));
                    high = std::max(high, static_cast<double>(dem[k]));
                }
            }
            auto const z = static_cast<double>(fast.z[i]);
            RC_ASSERT(z >= low);
            RC_ASSERT(z <= high);
            bool const is_limited = slow[i] < z - 1e-4 || slow[i] > z + 1e-4;
            // limited to a height of a cell
            RC_ASSERT((!is_limited || z == std::floor(z)));
        }
    }));
}

TEST(Lattice, KeepsPlanesCornersAndPosition) {
    Raster<float> const plane =
        test::raster_of(test::frame(33, 17, 30.0), [](Cell c) { return static_cast<float>(2 * c.col - 3 * c.row); });
    for (auto const& [width, height] : {std::pair{65, 33}, {129, 9}, {9, 5}, {5, 65}, {50, 11}, {2, 2}}) {
        Lattice const out = lattice(plane, width, height);
        for (std::int64_t i = 0; i < out.z.cells(); ++i) {
            Cell const c = out.z.grid().at(i);
            double const x = 32.0 * static_cast<double>(c.col) / (width - 1);
            double const y = 16.0 * static_cast<double>(c.row) / (height - 1);
            EXPECT_NEAR(out.z[i], 2.0 * x - 3.0 * y, 1e-4) << width << " x " << height;
        }
        EXPECT_EQ(out.north_west(), plane.grid().centre({0, 0}));
        EXPECT_NEAR(out.extent_m().x, 32.0 * 30.0, 1e-9);
        EXPECT_NEAR(out.extent_m().y, 16.0 * 30.0, 1e-9);
        Raster<float> const& z = out.z;
        EXPECT_EQ(z[Cell(width - 1, 0)], 64.0F);
        EXPECT_EQ(z[Cell(0, height - 1)], -48.0F);
    }
}

TEST(Lattice, ACliffDoesNotOvershoot) {
    Raster<float> const cliff = test::raster_of(test::frame(8, 8), [](Cell c) { return c.col < 4 ? 100.0F : 900.0F; });
    for (std::int64_t const side : {3, 8, 29, 64}) {
        Lattice const out = lattice(cliff, side, side);
        auto const [low, high] = std::ranges::minmax_element(out.z.values());
        EXPECT_EQ(*low, 100.0F) << side;
        EXPECT_EQ(*high, 900.0F) << side;
    }
}

TEST(Lattice, AHoleStaysAHoleAndPullsNothingDown) {
    Raster<float> dem(test::frame(20, 20), 500.0F);
    dem[Cell{10, 10}] = hole;
    for (std::int64_t const side : {39, 96}) {
        Lattice const out = lattice(dem, side, side);
        std::int64_t holes = 0;
        for (float const z : out.z.values()) {
            holes += std::isnan(z) ? 1 : 0;
            EXPECT_TRUE(std::isnan(z) || z == 500.0F);
        }
        EXPECT_GT(holes, 0);
        EXPECT_LT(holes, side * side / 100);
    }
}

TEST(Lattice, SameBytesForAnyThreadsAndStops) {
    Raster<float> const dem = hills(70, 41);
    for (std::int64_t const side : {33, 200}) {
        EXPECT_TRUE(test::same_bits(lattice(dem, side, side, test::on_threads(1)).z,
                                    lattice(dem, side, side, test::on_threads(3)).z));
    }
    EXPECT_THROW(lattice(dem, 33, 33, test::stopped_run()), Cancelled);
}

TEST(LatticeMesh, IsFlatOnASquare) {
    Lattice square{Raster<float>(test::frame(2, 2, 4.0), 7.0F), 6.0};
    LatticeMesh const mesh = surface_mesh(square);
    EXPECT_EQ(mesh.vertices, (std::vector<Vec3>{{-2, 3, 0}, {2, 3, 0}, {-2, -3, 0}, {2, -3, 0}}));
    EXPECT_EQ(mesh.places, (std::vector<Vec2>{{0, 0}, {1, 0}, {0, 1}, {1, 1}}));
    EXPECT_EQ(mesh.triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 2, 3}, {0, 3, 1}}));
    EXPECT_EQ(mesh.origin.z, 7.0);
}

TEST(LatticeMesh, HasHolesAndNoVertexBesideThem) {
    Lattice land = lattice(hills(6, 5), 6, 5);
    EXPECT_EQ(surface_mesh(land).triangles.size(), 40U);
    land.z[Cell{0, 0}] = hole;
    LatticeMesh const mesh = surface_mesh(land);
    EXPECT_EQ(mesh.vertices.size(), 29U);
    EXPECT_EQ(mesh.triangles.size(), 39U); // one of the square's two remains
    for (auto const& t : mesh.triangles) {
        auto const at = [&](std::size_t k) { return in_plan(mesh.vertices[t[k]]); };
        EXPECT_GT(cross(at(0), at(1), at(2)), 0.0);
    }
    Lattice none{Raster<float>(test::frame(3, 3), hole), 1.0};
    none.z[0] = 5.0F;
    EXPECT_NE(test::message_of<BadInput>([&] { surface_mesh(none); }), "");
    EXPECT_NE(test::message_of<BadParameter>([&] { surface_mesh(land, 0.0); }), "");
}

TEST(LatticeMesh, HeightsOnItAreThoseOfItsTriangles) {
    Lattice land = lattice(hills(6, 5), 6, 5);
    land.z[Cell{2, 2}] = hole;
    LatticeMesh const mesh = surface_mesh(land);
    for (auto const& t : mesh.triangles) {
        Vec3 const middle = (1.0 / 3.0) * (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]);
        EXPECT_NEAR(height_on_mesh(land, in_plan(middle + mesh.origin)), middle.z + mesh.origin.z, 1e-9);
    }
    Vec2 const corner = land.z.grid().centre({5, 4});
    EXPECT_EQ(height_on_mesh(land, corner), static_cast<double>(land.z[Cell{5, 4}]));
    EXPECT_TRUE(std::isnan(height_on_mesh(land, {corner.x + 0.1, corner.y})));
    EXPECT_TRUE(std::isnan(height_on_mesh(land, land.z.grid().centre({2, 2}))));
    EXPECT_TRUE(std::isnan(height_on_mesh(land, {std::nan(""), 0.0})));
}

TEST(SolidMesh, IsClosedAndHoldsWhatLiesBelowTheSurface) {
    ASSERT_TRUE(rc::check("each edge twice, in opposite directions; volume", [] {
        auto const side = [] { return *rc::gen::inRange<std::int64_t>(2, 12); };
        Lattice const land = lattice(hills(9, 9), side(), side());
        LatticeMesh const solid = solid_mesh(land, 5.0, 2.0);
        auto const edges = edges_of(solid);
        for (auto const& [edge, count] : edges) {
            RC_ASSERT(count == 1);
            RC_ASSERT(edges.contains({edge.second, edge.first}));
        }
        // vertices - edges + triangles of a sphere
        RC_ASSERT(solid.vertices.size() + solid.triangles.size() == edges.size() / 2 + 2);
        double above = 0.0; // of prisms under the surface
        LatticeMesh const surface = surface_mesh(land, 2.0);
        for (auto const& t : surface.triangles) {
            auto const at = [&](std::size_t k) { return surface.vertices[t[k]]; };
            above += 0.5 * cross(in_plan(at(0)), in_plan(at(1)), in_plan(at(2))) *
                     ((at(0).z + at(1).z + at(2).z) / 3.0 + 10.0);
        }
        RC_ASSERT(std::fabs(volume_of(solid) - above) < 1e-6 * above);
    }));
}

TEST(SolidMesh, HolesAndThinBasesAreRefused) {
    Lattice land = lattice(hills(6, 5), 6, 5);
    for (double const base : {0.0, -1.0, std::nan("")}) {
        EXPECT_NE(test::message_of<BadParameter>([&] { solid_mesh(land, base); }), "");
    }
    land.z[Cell{2, 3}] = hole;
    EXPECT_TRUE(test::has(test::message_of<BadInput>([&] { solid_mesh(land, 5.0); }), "column 2, row 3"));
}

} // namespace lattice_test
