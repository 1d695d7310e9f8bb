// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/import/choose_cell.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/error.hpp>

namespace thalweg::network {

namespace {

constexpr double margin_share = 0.05;
constexpr double most_crowded = 0.002;

struct LinesExtent {
    double west = std::numeric_limits<double>::infinity();
    double south = std::numeric_limits<double>::infinity();
    double east = -std::numeric_limits<double>::infinity();
    double north = -std::numeric_limits<double>::infinity();

    double margin() const { return margin_share * std::max(east - west, north - south); }
    double wide() const { return east - west + 2.0 * margin(); }
    double tall() const { return north - south + 2.0 * margin(); }
};

LinesExtent extent_of(RiverLines const& rivers) {
    LinesExtent box;
    for (RiverLine const& line : rivers.lines) {
        for (Vec3 const& p : line.vertices) {
            box = {std::min(box.west, p.x), std::min(box.south, p.y), std::max(box.east, p.x),
                   std::max(box.north, p.y)};
        }
    }
    return box;
}

double cells_of(LinesExtent const& box, double cell_m) {
    return std::ceil(box.wide() / cell_m) * std::ceil(box.tall() / cell_m);
}

/// Round numbers of metres in order, from a millimetre. Quotients of integers are the nearest doubles.
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

Grid grid_of(LinesExtent const& box, double cell_m) {
    Grid grid;
    grid.cell_m = cell_m;
    grid.west = box.west - box.margin();
    grid.north = box.north + box.margin();
    grid.width = static_cast<std::int64_t>(std::ceil(box.wide() / cell_m)) + 1;
    grid.height = static_cast<std::int64_t>(std::ceil(box.tall() / cell_m)) + 1;
    return grid;
}

using Place = std::pair<double, double>;

/// Positions where a line ends at a vertex of another: confluences.
std::vector<Vec2> joints_of(RiverLines const& rivers) {
    std::vector<Place> vertices;
    for (RiverLine const& line : rivers.lines) {
        std::size_t const first = vertices.size();
        for (Vec3 const& p : line.vertices) {
            vertices.emplace_back(p.x, p.y);
        }
        auto const own = vertices.begin() + static_cast<std::ptrdiff_t>(first);
        std::sort(own, vertices.end()); // a vertex counts once per line
        vertices.erase(std::unique(own, vertices.end()), vertices.end());
    }
    std::sort(vertices.begin(), vertices.end());
    std::vector<Vec2> joints;
    for (RiverLine const& line : rivers.lines) {
        for (Vec3 const& end : {line.vertices.front(), line.vertices.back()}) {
            auto const [first, last] = std::equal_range(vertices.begin(), vertices.end(), Place{end.x, end.y});
            if (last - first > 1) {
                joints.push_back({end.x, end.y});
            }
        }
    }
    return joints;
}

/// Calls visit(index of the cell) for the cells within a distance, the cell itself included.
template <class Visit> void around(Grid const& grid, Cell at, std::int64_t reach, Visit visit) {
    for (std::int64_t row = std::max<std::int64_t>(0, at.row - reach); row <= std::min(grid.height - 1, at.row + reach);
         ++row) {
        for (std::int64_t col = std::max<std::int64_t>(0, at.col - reach);
             col <= std::min(grid.width - 1, at.col + reach); ++col) {
            visit(grid.index({col, row}));
        }
    }
}

double crowded_share(RiverLines const& rivers, std::vector<Vec2> const& joints, Grid const& grid, Run const& run) {
    constexpr std::int64_t near_joint = 5;
    constexpr std::int32_t nobody = -1;
    constexpr std::int32_t several = -2;
    Mask near(grid, 0);
    for (Vec2 const& joint : joints) {
        around(grid, grid.cell_of(joint), near_joint, [&](std::int64_t cell) { near[cell] = 1; });
    }
    Raster<std::int32_t> owner(grid, nobody);
    std::vector<Cell> used;
    for (std::size_t i = 0; i < rivers.lines.size(); ++i) {
        run.check();
        for (Cell const c : cells_along(in_plan(rivers.lines[i].vertices), grid)) {
            std::int32_t& own = owner[c];
            if (own == nobody) {
                own = static_cast<std::int32_t>(i);
                used.push_back(c);
            } else if (own != static_cast<std::int32_t>(i)) {
                own = several;
            }
        }
    }
    std::int64_t crowded = 0;
    for (Cell const c : used) {
        std::int32_t const own = owner[c];
        bool other = own == several;
        around(grid, c, 1, [&](std::int64_t n) { other = other || (owner[n] != nobody && owner[n] != own); });
        crowded += other && near[c] == 0;
    }
    return static_cast<double>(crowded) / static_cast<double>(std::max<std::size_t>(used.size(), 1));
}

/// The least round number that satisfies a predicate that is true for all larger ones.
template <class AllowedValues> std::size_t first_allowed(std::vector<double> const& rounds, AllowedValues allowed) {
    auto const at = std::find_if(rounds.begin(), rounds.end(), allowed);
    return static_cast<std::size_t>(std::min(at, rounds.end() - 1) - rounds.begin());
}

} // namespace

ChosenCell choose_cell(RiverLines const& rivers, ChooseCellParams const& params, Run const& run) {
    LinesExtent const box = extent_of(rivers);
    if (!(box.wide() > 0.0 || box.tall() > 0.0)) {
        throw BadInput("network.choose_cell",
                       fmt::format("{}: {}", rivers.name,
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
        std::vector<Vec2> const joints = joints_of(rivers);
        auto const crowded = [&](std::size_t i) { return crowded_share(rivers, joints, grid_of(box, rounds[i]), run); };
        chosen.crowded_share = crowded(at);
        while (at > 0 && chosen.crowded_share > most_crowded && cells_of(box, rounds[at - 1]) <= most) {
            chosen.crowded_share = crowded(--at);
        }
        constexpr double most_tried = 3e7;
        double share = chosen.crowded_share;
        for (std::size_t i = at; i > 0 && share > most_crowded && cells_of(box, rounds[i - 1]) <= most_tried; --i) {
            share = crowded(i - 1);
            chosen.enough_m = share > most_crowded ? 0.0 : rounds[i - 1];
        }
        chosen.cell_m = rounds[at];
    }
    return chosen;
}

} // namespace thalweg::network
