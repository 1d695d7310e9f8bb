// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/choose_cell.hpp>

#include <thalweg/core/cells_along.hpp>
#include <thalweg/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace thalweg::network {

namespace {

constexpr double margin_share = 0.05;
constexpr double most_shared = 0.01;

struct Extent {
    double west = std::numeric_limits<double>::infinity();
    double south = std::numeric_limits<double>::infinity();
    double east = -std::numeric_limits<double>::infinity();
    double north = -std::numeric_limits<double>::infinity();

    double margin() const { return margin_share * std::max(east - west, north - south); }
    double wide() const { return east - west + 2.0 * margin(); }
    double tall() const { return north - south + 2.0 * margin(); }
};

Extent extent_of(RiverLines const& rivers) {
    Extent box;
    for (RiverLine const& line : rivers.lines) {
        for (Vec3 const& p : line.vertices) {
            box = {std::min(box.west, p.x), std::min(box.south, p.y), std::max(box.east, p.x),
                   std::max(box.north, p.y)};
        }
    }
    return box;
}

double cells_of(Extent const& box, double cell_m) {
    return std::ceil(box.wide() / cell_m) * std::ceil(box.tall() / cell_m);
}

/// Round numbers of metres in order, from a millimetre on. Quotients of whole numbers are the nearest doubles.
std::vector<double> round_numbers() {
    constexpr std::array<double, 11> steps{100, 125, 150, 200, 250, 300, 400, 500, 600, 750, 900};
    std::vector<double> out;
    for (double unit = 100000.0; unit > 1.0; unit /= 10.0) { // 1 mm to 900 m
        for (double const step : steps) {
            out.push_back(step / unit);
        }
    }
    for (double unit = 1.0; unit <= 1e4; unit *= 10.0) {
        for (double const step : steps) {
            out.push_back(step * unit);
        }
    }
    std::sort(out.begin(), out.end());
    return out;
}

double median_step(RiverLines const& rivers) {
    std::vector<double> steps;
    for (RiverLine const& line : rivers.lines) {
        for (std::size_t i = 1; i < line.vertices.size(); ++i) {
            Vec3 const& a = line.vertices[i - 1];
            Vec3 const& b = line.vertices[i];
            if (double const step = distance({a.x, a.y}, {b.x, b.y}); step > 0.0) {
                steps.push_back(step);
            }
        }
    }
    auto const middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
    std::nth_element(steps.begin(), middle, steps.end());
    return *middle;
}

double length_of(RiverLines const& rivers) {
    double sum = 0.0;
    for (RiverLine const& line : rivers.lines) {
        for (std::size_t i = 1; i < line.vertices.size(); ++i) {
            sum += distance({line.vertices[i - 1].x, line.vertices[i - 1].y}, {line.vertices[i].x, line.vertices[i].y});
        }
    }
    return sum;
}

Grid grid_of(Extent const& box, double cell_m) {
    Grid grid;
    grid.cell_m = cell_m;
    grid.west = box.west - box.margin();
    grid.north = box.north + box.margin();
    grid.width = static_cast<std::int64_t>(std::ceil(box.wide() / cell_m)) + 1;
    grid.height = static_cast<std::int64_t>(std::ceil(box.tall() / cell_m)) + 1;
    return grid;
}

/// 1 near the ends of lines, where rivers meet.
std::vector<std::uint8_t> near_ends(RiverLines const& rivers, Grid const& grid) {
    constexpr std::int64_t reach = 3;
    std::vector<std::uint8_t> near(static_cast<std::size_t>(grid.cells()));
    for (RiverLine const& line : rivers.lines) {
        for (Vec3 const& end : {line.vertices.front(), line.vertices.back()}) {
            Cell const at = grid.cell_of({end.x, end.y});
            for (std::int64_t row = std::max<std::int64_t>(0, at.row - reach);
                 row <= std::min(grid.height - 1, at.row + reach); ++row) {
                for (std::int64_t col = std::max<std::int64_t>(0, at.col - reach);
                     col <= std::min(grid.width - 1, at.col + reach); ++col) {
                    near[static_cast<std::size_t>(grid.index({col, row}))] = 1;
                }
            }
        }
    }
    return near;
}

double shared_share(RiverLines const& rivers, Grid const& grid, Run const& run) {
    std::vector<std::uint8_t> const near = near_ends(rivers, grid);
    std::vector<std::int32_t> owner(static_cast<std::size_t>(grid.cells()), -1);
    constexpr std::int32_t counted = -2;
    std::int64_t cells = 0;
    std::int64_t shared = 0;
    std::vector<Vec2> plan;
    for (std::size_t i = 0; i < rivers.lines.size(); ++i) {
        run.check();
        plan.clear();
        for (Vec3 const& p : rivers.lines[i].vertices) {
            plan.push_back({p.x, p.y});
        }
        auto const own = static_cast<std::int32_t>(i);
        for (Cell const c : cells_along(plan, grid)) {
            auto const cell = static_cast<std::size_t>(grid.index(c));
            cells += owner[cell] == -1;
            if (owner[cell] == -1) {
                owner[cell] = own;
            } else if (owner[cell] != own && owner[cell] != counted && near[cell] == 0) {
                owner[cell] = counted;
                ++shared;
            }
        }
    }
    return static_cast<double>(shared) / static_cast<double>(std::max<std::int64_t>(cells, 1));
}

/// The least round number that is allowed by a predicate that holds for all larger ones.
template <class Allowed> std::size_t first_allowed(std::vector<double> const& rounds, Allowed allowed) {
    auto const at = std::find_if(rounds.begin(), rounds.end(), allowed);
    return static_cast<std::size_t>(std::min(at, rounds.end() - 1) - rounds.begin());
}

} // namespace

ChosenCell choose_cell(RiverLines const& rivers, ChooseCellParams const& params, Run const& run) {
    Extent const box = extent_of(rivers);
    if (!(box.wide() > 0.0 || box.tall() > 0.0)) {
        throw BadInput(fmt::format("network.choose_cell: {}: {}", rivers.name,
                                   rivers.lines.empty() ? "there are no lines"
                                                        : "all vertices lie at one place: there is no river"));
    }
    std::vector<double> const rounds = round_numbers();
    ChosenCell chosen;
    chosen.lines = static_cast<std::int64_t>(rivers.lines.size());
    chosen.length_m = length_of(rivers);
    chosen.spacing_m = box.wide() * box.tall() / chosen.length_m;
    std::size_t at = 0;
    if (params.width > 0 && params.height > 0) {
        double const least =
            std::max(box.wide() / static_cast<double>(params.width), box.tall() / static_cast<double>(params.height));
        chosen.cell_m = rounds[first_allowed(rounds, [&](double cell) { return cell >= least; })];
    } else {
        constexpr double finest_of_step = 0.1;
        constexpr double fewest_cells = 1000.0;
        double const drawn =
            std::min(finest_of_step * median_step(rivers), std::max(box.wide(), box.tall()) / fewest_cells);
        auto const usual = static_cast<double>(params.usual_cells);
        auto const most = static_cast<double>(params.most_cells);
        at = first_allowed(rounds, [&](double cell) { return cell >= drawn && cells_of(box, cell) <= usual; });
        chosen.shared_share = shared_share(rivers, grid_of(box, rounds[at]), run);
        while (at > 0 && chosen.shared_share > most_shared && cells_of(box, rounds[at - 1]) <= most) {
            --at;
            chosen.shared_share = shared_share(rivers, grid_of(box, rounds[at]), run);
        }
        chosen.cell_m = rounds[at];
    }
    return chosen;
}

} // namespace thalweg::network
