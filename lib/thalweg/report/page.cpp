// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/report/page.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/flow/catchments.hpp>
#include <thalweg/flow/route.hpp>
#include <thalweg/io/crs/crs.hpp>
#include <thalweg/io/gdal/packed.hpp>
#include <thalweg/measure/topology/topology.hpp>
#include <thalweg/report/internal/page_template.hpp>

namespace thalweg::report {
namespace {

constexpr std::int64_t most_values = 1'500'000;
constexpr std::int64_t longest_side = 4096;
constexpr double steps = 65534.0; // values 1 .. 65535, 0: no data
constexpr std::size_t predictors = 4;

std::int64_t parts(std::int64_t cells, std::int64_t of) {
    return (cells + of - 1) / of;
}

/// Means of the squares, row-major; NaN: none.
std::vector<double> means(Raster<float> const& dem, PageHeights const& page, Run const& run) {
    auto const width = static_cast<std::size_t>(page.width);
    auto const side = static_cast<std::size_t>(page.cells);
    std::vector<double> mean(width * static_cast<std::size_t>(page.height));
    std::vector<double> sum(width);
    std::vector<std::int64_t> count(width);
    for (std::int64_t value_row = 0; value_row < page.height; ++value_row) {
        run.check();
        std::fill(sum.begin(), sum.end(), 0.0);
        std::fill(count.begin(), count.end(), 0);
        std::int64_t const end = std::min((value_row + 1) * page.cells, dem.height());
        for (std::int64_t r = value_row * page.cells; r < end; ++r) {
            auto const row = dem.row(r);
            for (std::size_t c = 0; c < row.size(); ++c) {
                refuse_if<BadInput>(std::isinf(row[c]), "report.page_heights",
                                    "the height at column {}, row {} is infinite; mark cells without data as NaN", c,
                                    r);
                if (!std::isnan(row[c])) {
                    sum[c / side] += static_cast<double>(row[c]);
                    ++count[c / side];
                }
            }
        }
        for (std::size_t v = 0; v < width; ++v) {
            mean[static_cast<std::size_t>(value_row) * width + v] =
                count[v] > 0 ? sum[v] / static_cast<double>(count[v]) : std::numeric_limits<double>::quiet_NaN();
        }
    }
    return mean;
}

std::vector<std::uint16_t> quantised(std::vector<double> const& mean, PageHeights const& page) {
    std::vector<std::uint16_t> values(mean.size(), 0);
    double const range = page.max - page.min;
    for (std::size_t i = 0; i < mean.size(); ++i) {
        if (!std::isnan(mean[i])) {
            double const share = range > 0.0 ? (mean[i] - page.min) / range : 0.0;
            values[i] = static_cast<std::uint16_t>(1.0 + std::floor(share * steps + 0.5));
        }
    }
    return values;
}

/// Predictions for a value from its neighbours in the west, north and north-west, before reduction modulo 2^16.
std::array<std::uint32_t, predictors> predictions(std::uint32_t west, std::uint32_t north, std::uint32_t corner) {
    return {north, west, west + north - corner, (west + north) / 2};
}

std::uint16_t zigzag(std::uint32_t difference) {
    auto const wrapped = static_cast<std::uint16_t>(difference);
    auto const doubled = static_cast<std::uint16_t>(wrapped << 1U);
    return wrapped < 0x8000U ? doubled : static_cast<std::uint16_t>(~doubled);
}

/// Residuals of one row under each predictor.
using Residuals = std::array<std::vector<std::uint16_t>, predictors>;

/// Computes the residuals of a row.
/// \return the predictor with the fewest binary digits in them
std::size_t predict(std::span<std::uint16_t const> row, std::span<std::uint16_t const> above, Residuals& residuals) {
    std::array<std::int64_t, predictors> cost{};
    std::uint32_t west = 0;
    std::uint32_t corner = 0;
    for (std::size_t c = 0; c < row.size(); ++c) {
        std::uint32_t const north = above.empty() ? 0 : above[c];
        auto const predicted = predictions(west, north, corner);
        for (std::size_t p = 0; p < predictors; ++p) {
            residuals[p][c] = zigzag(row[c] - predicted[p]);
            cost[p] += std::bit_width(residuals[p][c]);
        }
        west = row[c];
        corner = north;
    }
    return static_cast<std::size_t>(std::min_element(cost.begin(), cost.end()) - cost.begin());
}

std::vector<std::uint8_t> coded(std::vector<std::uint16_t> const& values, PageHeights const& page) {
    auto const width = static_cast<std::size_t>(page.width);
    auto const height = static_cast<std::size_t>(page.height);
    std::vector<std::uint8_t> bytes(height + 2 * values.size());
    std::span<std::uint16_t const> const all(values);
    Residuals residuals;
    residuals.fill(std::vector<std::uint16_t>(width));
    for (std::size_t r = 0; r < height; ++r) {
        auto const above = r > 0 ? all.subspan((r - 1) * width, width) : std::span<std::uint16_t const>{};
        std::size_t const best = predict(all.subspan(r * width, width), above, residuals);
        bytes[r] = static_cast<std::uint8_t>(best);
        for (std::size_t c = 0; c < width; ++c) {
            bytes[height + r * width + c] = static_cast<std::uint8_t>(residuals[best][c] & 0xFFU);
            bytes[height + values.size() + r * width + c] = static_cast<std::uint8_t>(residuals[best][c] >> 8U);
        }
    }
    return bytes;
}

/// The direction, counted from 1, in which the page's heights fall most steeply; 0: nowhere. Of equally steep ones the
/// lowest. Drops are compared squared, twice along a side, so that integers decide.
int steepest_on_page(PageHeights const& page, std::int64_t col, std::int64_t row) {
    auto const value = [&](std::int64_t c, std::int64_t r) {
        bool const inside = c >= 0 && r >= 0 && c < page.width && r < page.height;
        return inside ? std::int64_t{page.values[static_cast<std::size_t>(r * page.width + c)]} : 0;
    };
    std::int64_t const here = value(col, row);
    std::int64_t steepest = 0;
    int best = 0;
    for (std::size_t k = 0; k < d8_steps.size(); ++k) {
        std::int64_t const there = value(col + d8_steps[k].col, row + d8_steps[k].row);
        std::int64_t const drop = there > 0 && there < here ? here - there : 0;
        std::int64_t const steepness = drop * drop * (k % 2 == 0 ? 2 : 1);
        if (steepness > steepest) {
            steepest = steepness;
            best = static_cast<int>(k) + 1;
        }
    }
    return best;
}

constexpr double steps_a_square = 16.0;
constexpr double farthest = 0x1p29; // products of two differences are then below 2^62

/// A position in whole steps, x to the east and y to the south.
struct Point {
    std::int64_t x = 0;
    std::int64_t y = 0;
    friend bool operator==(Point const&, Point const&) = default;
};

/// Whether b lies on the straight line from a to c.
bool on_the_way(Point a, Point b, Point c) {
    Point const there{b.x - a.x, b.y - a.y};
    Point const on{c.x - b.x, c.y - b.y};
    return there.x * on.y == there.y * on.x && there.x * on.x + there.y * on.y > 0;
}

std::vector<Point> points_of(std::span<Vec2 const> line, Grid const& grid, double step_m, std::size_t number) {
    refuse_if<BadInput>(line.size() < 2, "report.page_lines", "line {} has {} vertices; give two or more", number,
                        line.size());
    std::vector<Point> points;
    for (std::size_t i = 0; i < line.size(); ++i) {
        double const x = std::floor((line[i].x - grid.west) / step_m + 0.5);
        double const y = std::floor((grid.north - line[i].y) / step_m + 0.5);
        if (!(std::fabs(x) < farthest && std::fabs(y) < farthest)) {
            throw BadInput("report.page_lines", fmt::format("vertex {} of line {} lies at ({}, {}), far from the grid",
                                                            i, number, line[i].x, line[i].y));
        }
        Point const p{static_cast<std::int64_t>(x), static_cast<std::int64_t>(y)};
        if (!points.empty() && points.back() == p) {
            continue;
        }
        if (points.size() > 1 && on_the_way(points[points.size() - 2], points.back(), p)) {
            points.back() = p;
        } else {
            points.push_back(p);
        }
    }
    if (points.size() == 1) {
        points.push_back(points.front());
    }
    return points;
}

void put(std::int64_t difference, std::vector<std::uint8_t>& bytes) {
    auto const magnitude = static_cast<std::uint64_t>(difference < 0 ? -(difference + 1) : difference);
    std::uint64_t rest = 2 * magnitude + (difference < 0 ? 1U : 0U);
    while (rest >= 0x80U) {
        bytes.push_back(static_cast<std::uint8_t>((rest & 0x7FU) | 0x80U));
        rest >>= 7U;
    }
    bytes.push_back(static_cast<std::uint8_t>(rest));
}

struct Place {
    std::size_t at;
    std::string_view marker;
    std::string const* part;
};

std::size_t find_once(std::string_view page, std::string_view marker) {
    std::size_t const at = page.find(marker);
    if (at == std::string_view::npos || page.find(marker, at + 1) != std::string_view::npos) {
        throw std::logic_error(fmt::format("report.fill_markers: the page holds {} {}; rebuild web/dist",
                                           at == std::string_view::npos ? "no" : "more than one", marker));
    }
    return at;
}

/// Replaces invalid UTF-8 by U+FFFD.
std::string with_replacements(std::string const& text) {
    using nlohmann::json;
    return json::parse(json(text).dump(-1, ' ', false, json::error_handler_t::replace)).get<std::string>();
}

/// Whether every vertex of the network lies on the DEM's grid, as required for areas.
bool lies_on(ElevatedNetwork const& network, Grid const& grid) {
    for (ArcId arc = 0; arc < network.planform.arc_count(); ++arc) {
        auto const& line = network.planform.arc(arc).line;
        if (!std::all_of(line.begin(), line.end(), [&](Vec2 p) { return grid.contains(grid.cell_of(p)); })) {
            return false;
        }
    }
    return true;
}

/// Makes a terrain of a scene's content.
make::Terrain terrain_of(Scene const& scene, Run const& run) {
    make::Terrain terrain;
    terrain.grid = scene.dem->grid();
    terrain.ground.dem = *scene.dem;
    terrain.water.drainage = flow::route(*scene.dem, run);
    if (scene.network) {
        StreamNetwork const& network = scene.network->planform;
        terrain.rivers.network = *scene.network;
        terrain.rivers.orders = scene.orders;
        if (lies_on(*scene.network, terrain.grid)) {
            terrain.water.areas = flow::areas_d8(network, terrain.water.drainage, run);
        } else {
            terrain.water.areas.us_area_m2.assign(network.arc_count(), 0.0);
            terrain.water.areas.ds_area_m2.assign(network.arc_count(), 0.0);
            terrain.water.areas.node_m2.assign(network.node_count(), 0.0);
        }
    }
    return terrain;
}

/// Measures it.
make::Assessment assessment_of(Scene const& scene, make::Terrain const& terrain, Run const& run) {
    make::Assessment found;
    found.statistics = measure::statistics(*scene.dem, run);
    found.hypsometry = measure::hypsometry(*scene.dem, run);
    found.pits = terrain.water.drainage.pits;
    found.pit_volume_m3 = terrain.water.drainage.pit_volume_m3;
    if (scene.network) {
        auto const topology =
            measure::check_topology(measure::as_file(terrain.rivers.network, terrain.rivers.orders), {}, run);
        found.checks = topology.checks;
        found.findings = topology.findings;
    }
    found.laws = make::laws_of_terrain(terrain, found.statistics->cells, run);
    found.relief = io::ground_cell(scene.dem->grid()).side_m == scene.dem->grid().cell_m
                       ? make::relief_of_dem(*scene.dem, terrain.water.drainage, run)
                       : make::relief_of_dem(*scene.dem, run);
    return found;
}

} // namespace

std::int64_t page_cells(Grid const& grid) {
    std::int64_t cells = 1;
    auto const too_many = [&] {
        std::int64_t const width = parts(grid.width, cells);
        std::int64_t const height = parts(grid.height, cells);
        return width > longest_side || height > longest_side || width * height > most_values;
    };
    while (too_many()) {
        ++cells;
    }
    return cells;
}

Raster<float> mean_of_squares(Raster<float> const& dem, std::int64_t cells) {
    PageHeights page;
    page.cells = cells;
    page.width = parts(dem.width(), cells);
    page.height = parts(dem.height(), cells);
    Grid grid = dem.grid();
    grid.width = page.width;
    grid.height = page.height;
    grid.cell_m *= static_cast<double>(cells);
    Raster<float> squares(grid);
    std::ranges::transform(means(dem, page, {}), squares.values().begin(),
                           [](double z) { return static_cast<float>(z); });
    return squares;
}

std::optional<PageHeights> page_values(Raster<float> const& dem, Run const& run) {
    PageHeights page;
    page.cells = page_cells(dem.grid());
    page.width = parts(dem.width(), page.cells);
    page.height = parts(dem.height(), page.cells);
    std::vector<double> const mean = means(dem, page, run);
    bool first = true;
    for (double const z : mean) {
        if (std::isnan(z)) {
            ++page.nodata;
            continue;
        }
        page.min = first ? z : std::min(page.min, z);
        page.max = first ? z : std::max(page.max, z);
        first = false;
    }
    if (first) {
        return std::nullopt;
    }
    page.values = quantised(mean, page);
    return page;
}

std::optional<PageHeights> page_heights(Raster<float> const& dem, Run const& run) {
    std::optional<PageHeights> page = page_values(dem, run);
    if (page) {
        page->bytes = coded(page->values, *page);
    }
    return page;
}

std::vector<std::uint8_t> page_water(flow::FlowField const& drainage, Mask const& lakes, PageHeights const& heights) {
    std::vector<std::uint8_t> bytes;
    if (heights.cells > 1) {
        return bytes;
    }
    constexpr int ways = 9; // eight neighbours and none
    constexpr int lake = 16;
    bytes.reserve(static_cast<std::size_t>(drainage.grid().cells()));
    for (std::int64_t row = 0; row < heights.height; ++row) {
        for (std::int64_t col = 0; col < heights.width; ++col) {
            flow::Direction const d = drainage.direction[Cell{col, row}];
            int const taken = flow::goes_on(d) ? static_cast<int>(flow::index_of(d)) + 1 : 0;
            int const residual = (taken - steepest_on_page(heights, col, row) + ways) % ways;
            bool const in_lake = lakes.cells() > 0 && lakes[Cell{col, row}] != 0;
            bytes.push_back(static_cast<std::uint8_t>(residual + (in_lake ? lake : 0)));
        }
    }
    return bytes;
}

PageLines page_lines(std::span<std::span<Vec2 const> const> lines, Grid const& grid) {
    PageLines page;
    page.step = static_cast<double>(page_cells(grid)) / steps_a_square;
    Point last;
    for (std::size_t number = 1; auto const line : lines) {
        std::vector<Point> const points = points_of(line, grid, page.step * grid.cell_m, number++);
        page.vertices.push_back(static_cast<std::int64_t>(points.size()));
        for (Point const p : points) {
            put(p.x - last.x, page.bytes);
            put(p.y - last.y, page.bytes);
            last = p;
        }
    }
    return page;
}

std::string fill_markers(std::string_view page, std::vector<PageMarker> const& markers) {
    std::vector<Place> places;
    std::size_t size = page.size();
    for (auto const& [marker, part] : markers) {
        places.push_back({find_once(page, marker), marker, part});
        size += part->size();
    }
    std::sort(places.begin(), places.end(), [](Place const& a, Place const& b) { return a.at < b.at; });
    std::string out;
    out.reserve(size);
    std::size_t done = 0;
    for (Place const& place : places) {
        out += page.substr(done, place.at - done);
        out += *place.part;
        done = place.at + place.marker.size();
    }
    out += page.substr(done);
    return out;
}

std::string fill_page(std::string_view page, PageParts const& parts) {
    return fill_markers(page, {{"@@TITLE@@", &parts.title},
                               {"@@DATA@@", &parts.data},
                               {"@@HEIGHTS@@", &parts.heights},
                               {"@@LINES@@", &parts.lines},
                               {"@@WATER@@", &parts.water},
                               {"@@STUDIO@@", &parts.studio}});
}

std::string html_text(std::string const& text) {
    std::string out;
    for (char const c : with_replacements(text)) {
        switch (c) {
        case '&': out += "&amp;"; break;
        case '<': out += "&lt;"; break;
        case '>': out += "&gt;"; break;
        case '"': out += "&quot;"; break;
        case '\'': out += "&#39;"; break;
        default: out += c;
        }
    }
    return out;
}

PageLines lines_of_page(make::MakeResult const& made) {
    StreamNetwork const& plan = made.terrain.rivers.network.planform;
    RidgeLines const& ridges = made.terrain.ground.ridges;
    std::vector<std::vector<Vec2>> ridges_in_plan;
    for (RidgeLine const& ridge : ridges.lines) {
        ridges_in_plan.push_back(in_plan(ridge.line));
    }
    std::vector<std::span<Vec2 const>> lines;
    for (ArcId arc = 0; arc < plan.arc_count(); ++arc) {
        lines.emplace_back(plan.arc(arc).line);
    }
    lines.insert(lines.end(), ridges_in_plan.begin(), ridges_in_plan.end());
    return page_lines(lines, made.terrain.grid);
}

std::string page(make::MakeResult const& made, PageParams const& params, Run const& run) {
    std::optional<PageHeights> const heights =
        made.terrain.has_surface() ? page_heights(made.terrain.ground.dem, run) : std::nullopt;
    run.check();
    PageLines const lines = lines_of_page(made);
    PageParts parts;
    parts.title = html_text(recipe::title_of(made.recipe));
    parts.data = page_data(made, params, heights, lines);
    parts.heights = heights ? io::packed(heights->bytes) : "";
    parts.lines = io::packed(lines.bytes);
    if (heights && made.terrain.has_surface()) {
        std::vector<std::uint8_t> const water = page_water(made.terrain.water.drainage, params.lakes, *heights);
        parts.water = water.empty() ? "" : io::packed(water);
    }
    return fill_page(page_template(), parts);
}

std::string scene_page(Scene const& scene, std::vector<std::string> const& notes, std::string const& command,
                       Run const& run) {
    refuse_if<BadInput>(!scene.dem, "report.scene_page", "there is no DEM to show");
    make::MakeResult made;
    made.recipe.output.title = scene.title;
    made.terrain = terrain_of(scene, run);
    made.assessment = assessment_of(scene, made.terrain, run);
    double const relief = made.assessment.statistics->max.z - made.assessment.statistics->min.z;
    PageParams params;
    params.contour_interval_m = scene.contour_interval_m > 0.0 ? scene.contour_interval_m : round_interval(relief);
    params.command = command;
    params.notes = notes;
    params.sea = scene.sea;
    params.lakes = scene.lakes;
    params.summits = summits(*scene.dem, summits_named, run);
    return page(made, params, run);
}

} // namespace thalweg::report
