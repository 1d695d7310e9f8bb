// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <io/scratch_folder.hpp>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/export/internal/print_export.hpp>

namespace print_export_test {

using namespace thalweg;
using namespace thalweg::report;
using namespace thalweg::exports;

namespace {

using Place = std::array<float, 3>;
using Triangle = std::array<Place, 3>;

/// 7 x 5 cells of 10 m: a plane that rises to the east from 100 m.
Scene plane(float rise_m = 5.0F) {
    Scene scene;
    scene.dem =
        test::raster_of(test::frame(7, 5, 10.0), [&](Cell c) { return 100.0F + rise_m * static_cast<float>(c.col); });
    return scene;
}

struct Printed {
    PrintExport made;
    std::string bytes;
    std::vector<Triangle> triangles;
};

Printed print(Scene const& scene, PrintParams const& params = {}, int threads = 0) {
    ScratchFolder const folder;
    io::OutputFolder out(folder / "out");
    thalweg::Run run;
    run.threads = threads;
    Printed printed{write_print(scene, params, out, run), {}, {}};
    EXPECT_EQ(printed.made.files, out.files());
    out.commit();
    printed.bytes = test::bytes_of(folder / "out/terrain.stl");
    std::uint32_t count = 0;
    std::memcpy(&count, printed.bytes.data() + 80, sizeof count);
    EXPECT_EQ(printed.bytes.size(), 84 + 50 * std::size_t{count});
    printed.triangles.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        std::memcpy(&printed.triangles[i], printed.bytes.data() + 84 + 50 * i + 12, sizeof(Triangle));
    }
    EXPECT_EQ(printed.made.triangles, count);
    return printed;
}

void expect_box(std::vector<Triangle> const& triangles, Vec3 size_mm) {
    Place low{HUGE_VALF, HUGE_VALF, HUGE_VALF};
    Place high{-HUGE_VALF, -HUGE_VALF, -HUGE_VALF};
    for (Triangle const& t : triangles) {
        for (Place const& p : t) {
            for (std::size_t k = 0; k < 3; ++k) {
                low[k] = std::min(low[k], p[k]);
                high[k] = std::max(high[k], p[k]);
            }
        }
    }
    EXPECT_EQ(low, (Place{0.0F, 0.0F, 0.0F}));
    EXPECT_NEAR(high[0], size_mm.x, 1e-4);
    EXPECT_NEAR(high[1], size_mm.y, 1e-4);
    EXPECT_NEAR(high[2], size_mm.z, 1e-4);
}

void expect_closed(std::vector<Triangle> const& triangles) {
    std::map<std::pair<Place, Place>, int> edges;
    for (Triangle const& t : triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            ++edges[{t[k], t[(k + 1) % 3]}];
        }
    }
    for (auto const& [edge, count] : edges) {
        EXPECT_EQ(count, 1);
        EXPECT_TRUE(edges.contains({edge.second, edge.first}));
    }
}

double volume(std::vector<Triangle> const& triangles) {
    double sum = 0.0;
    for (auto const& [a, b, c] : triangles) {
        sum += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                a[2] * (b[0] * c[1] - b[1] * c[0])) /
               6.0;
    }
    return sum;
}

} // namespace

TEST(PrintExport, IsAClosedSolidInMillimetresFromTheOrigin) {
    Printed const printed = print(plane(), {.longest_mm = 120.0, .base_mm = 4.0, .exaggeration = 2.0});
    EXPECT_EQ(printed.bytes.substr(0, 27), "thalweg, millimetres, Z up ");
    PrintExport const& made = printed.made;
    EXPECT_DOUBLE_EQ(made.scale, 500.0);      // 60 m on 120 mm
    EXPECT_NEAR(made.relief_mm, 120.0, 1e-9); // 30 m, twice as high
    EXPECT_NEAR(made.size_mm.y, 80.0, 1e-9);
    expect_box(printed.triangles, {120.0, 80.0, 124.0});
    expect_closed(printed.triangles);
    EXPECT_NEAR(volume(printed.triangles), 120.0 * 80.0 * (60.0 + 4.0), 1.0);
    EXPECT_EQ(made.vertices, 7 * 5 + 20 + 1);
    EXPECT_TRUE(test::has(made.findings.at(0).text, "1 : 500", "120.0 x 80.0 x 124.0 mm"));
    EXPECT_EQ(made.findings.size(), 1U);
    // South is below: the corner at the origin is that of the south-west, and heights rise to the east.
    for (Triangle const& t : printed.triangles) {
        for (Place const& p : t) {
            if (p[2] > 0.0F) {
                EXPECT_NEAR(p[2], 4.0 + p[0], 1e-4);
            }
        }
    }
}

TEST(PrintExport, HasNoMoreVerticesThanAPrintShows) {
    Scene scene;
    scene.dem = test::raster_of(test::frame(301, 201, 10.0),
                                [](Cell c) { return 40.0F * std::sqrt(static_cast<float>(c.col + 3 * c.row)); });
    auto const surface = [&](PrintParams const& params) {
        Printed const printed = print(scene, params);
        expect_closed(printed.triangles);
        expect_box(printed.triangles, printed.made.size_mm);
        return printed.made.vertices;
    };
    auto const solid = [](std::int64_t width, std::int64_t height) {
        return width * height + 2 * (width + height) - 4 + 1;
    };
    EXPECT_EQ(surface({}), solid(301, 201));
    EXPECT_EQ(surface({.longest_mm = 20.0}), solid(201, 134)); // 0.1 mm apart
    EXPECT_EQ(surface({.most_vertices = 31}), solid(31, 21));
    EXPECT_EQ(surface({.most_vertices = 2}), solid(2, 2));
}

TEST(PrintExport, SaysHowToShowLowRelief) {
    PrintExport const low = print(plane(0.02F)).made; // 0.12 m on 60 m: 0.3 mm
    EXPECT_NEAR(low.relief_mm, 0.3, 1e-4);
    ASSERT_EQ(low.findings.size(), 2U);
    EXPECT_TRUE(test::has(low.findings[1].text, "0.3 mm", "--exaggeration 33 ", "10 mm"));
    EXPECT_NEAR(print(plane(0.02F), {.exaggeration = 33.0}).made.relief_mm, 10.0, 0.2);
    EXPECT_TRUE(test::has(print(plane(0.0002F)).made.findings.at(1).text, "--exaggeration 3300 "));
    EXPECT_TRUE(test::has(print(plane(0.0F)).made.findings.at(1).text, "flat"));
    expect_box(print(plane(0.0F)).triangles, {150.0, 100.0, 3.0});
}

TEST(PrintExport, TheSeaIsLevelAndOtherHolesAreRefused) {
    Scene scene = plane();
    (*scene.dem)[Cell{0, 0}] = std::numeric_limits<float>::quiet_NaN();
    (*scene.dem)[Cell{1, 0}] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_TRUE(
        test::has(test::message_of<BadInput>([&] { print(scene); }), "2 of 35 cells have no data", "close them first"));
    scene.sea = report::Sea{.level_m = 98.0};
    Printed const printed = print(scene);
    expect_closed(printed.triangles);
    expect_box(printed.triangles, {150.0, 100.0, 3.0 + 2.5 * 32.0});
    int at_sea_level = 0;
    for (Triangle const& t : printed.triangles) {
        for (Place const& p : t) {
            at_sea_level += std::fabs(p[2] - 3.0F) < 1e-4F && p[1] > 99.9F && p[0] < 25.1F ? 1 : 0;
        }
    }
    EXPECT_GT(at_sea_level, 4);
}

TEST(PrintExport, HasTheSameBytesOnAnyNumberOfThreads) {
    Scene scene;
    scene.dem = test::raster_of(test::frame(97, 83, 3.0),
                                [](Cell c) { return static_cast<float>((c.col * 37 + c.row * 91) % 53); });
    EXPECT_EQ(print(scene, {.most_vertices = 61}, 1).bytes, print(scene, {.most_vertices = 61}, 3).bytes);
}

TEST(PrintExport, BadInputIsRefused) {
    double const nan = std::numeric_limits<double>::quiet_NaN();
    for (PrintParams const& bad : std::vector<PrintParams>{{.longest_mm = 9.0},
                                                           {.longest_mm = 2001.0},
                                                           {.longest_mm = nan},
                                                           {.base_mm = 0.0},
                                                           {.base_mm = 101.0},
                                                           {.exaggeration = 0.0},
                                                           {.exaggeration = -1.0},
                                                           {.exaggeration = HUGE_VAL},
                                                           {.most_vertices = 1},
                                                           {.most_vertices = 2050}}) {
        EXPECT_TRUE(test::has(test::message_of<BadParameter>([&] { print(plane(), bad); }), "it must be"));
    }
    EXPECT_NE(test::message_of<BadInput>([] { print({}); }), "");
    Scene row;
    row.dem = Raster<float>(test::frame(3, 1), 1.0F);
    EXPECT_TRUE(test::has(test::message_of<BadInput>([&] { print(row); }), "3 x 1 cells"));
}

} // namespace print_export_test
