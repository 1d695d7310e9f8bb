// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/blend/internal/region.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/numbers/sums.hpp>
#include <thalweg/core/run/refuse.hpp>

namespace thalweg::blend {
namespace {

using solver::fixed_cell;
using solver::free_cell;

std::array<Cell, 4> neighbours_of(Cell c) {
    return {Cell{c.col - 1, c.row}, Cell{c.col + 1, c.row}, Cell{c.col, c.row - 1}, Cell{c.col, c.row + 1}};
}

struct Box {
    Cell first;
    Cell last;
};

// Includes its ring.
Box box_of(Mask const& changes, std::string const& stage) {
    Box box{{changes.width(), changes.height()}, {-1, -1}};
    for (std::int64_t row = 0; row < changes.height(); ++row) {
        auto const cells = changes.row(row);
        auto const is_set = [](std::uint8_t m) { return m != 0; };
        auto const first = std::ranges::find_if(cells, is_set);
        if (first == cells.end()) {
            continue;
        }
        auto const last = std::find_if(cells.rbegin(), cells.rend(), is_set);
        box.first = {std::min(box.first.col, first - cells.begin()), std::min(box.first.row, row)};
        box.last = {std::max(box.last.col, cells.rend() - last - 1), row};
    }
    refuse_if<BadInput>(box.last.row < 0, stage,
                        "no cell of the target would change: take a mask that holds cells with heights");
    return {{std::max<std::int64_t>(box.first.col - 1, 0), std::max<std::int64_t>(box.first.row - 1, 0)},
            {std::min(box.last.col + 1, changes.width() - 1), std::min(box.last.row + 1, changes.height() - 1)}};
}

Grid frame_of(Grid const& target, Box const& box) {
    Grid frame = target;
    frame.width = box.last.col - box.first.col + 1;
    frame.height = box.last.row - box.first.row + 1;
    frame.west = target.west + static_cast<double>(box.first.col) * target.cell_m;
    frame.north = target.north - static_cast<double>(box.first.row) * target.cell_m;
    return frame;
}

// Every connected part of the free cells needs a fixed neighbour.
void require_held(EditRegion const& edit_region, Grid const& target, std::string const& stage, Run const& run) {
    Grid const& grid = edit_region.kind.grid();
    Mask seen(grid);
    std::vector<std::int64_t> reached;
    for (std::int64_t start = 0; start < grid.cells(); ++start) {
        if (edit_region.kind[start] != free_cell || seen[start] != 0) {
            continue;
        }
        run.check();
        bool held = false;
        std::int64_t cells = 0;
        seen[start] = 1;
        reached.assign(1, start);
        while (!reached.empty()) {
            Cell const c = grid.at(reached.back());
            reached.pop_back();
            ++cells;
            for (Cell const n : neighbours_of(c)) {
                if (!grid.contains(n)) {
                    continue;
                }
                held = held || edit_region.kind[n] == fixed_cell;
                if (edit_region.kind[n] == free_cell && seen[n] == 0) {
                    seen[n] = 1;
                    reached.push_back(grid.index(n));
                }
            }
        }
        if (held) {
            continue;
        }
        refuse_if<BadInput>(cells == target.cells(), stage,
                            "all {} x {} cells of the target would change: leave at least one that keeps its height",
                            target.width, target.height);
        Cell const c = grid.at(start);
        Cell const there{c.col + edit_region.corner.col, c.row + edit_region.corner.row};
        Vec2 const p = target.centre(there);
        throw BadInput(stage, fmt::format("the part of {} cells at column {}, row {} ({:.3f}, {:.3f}) has no neighbour "
                                          "with a height to join: take a part that reaches one",
                                          cells, there.col, there.row, p.x, p.y));
    }
}

using solver::outside_cell;

struct Mean {
    double sum = 0.0;
    double cells = 0.0;
    Mean& operator+=(Mean const& other) {
        sum += other.sum;
        cells += other.cells;
        return *this;
    }
};

// The unknown is the difference from the carrier.
void set_values(solver::GridProblem& problem, Raster<double> const& fixed, Raster<double> const& carrier,
                Run const& run) {
    std::int64_t const width = fixed.width();
    auto const mean = sum_rows(run, fixed.height(), [&](std::int64_t row) {
        Mean of_row;
        for (std::int64_t i = row * width; i < (row + 1) * width; ++i) {
            if (problem.kind[i] == fixed_cell) {
                problem.value[i] = fixed[i] - carrier[i];
                of_row += {problem.value[i], 1.0};
            }
        }
        return of_row;
    });
    double const guess = mean.cells > 0.0 ? mean.sum / mean.cells : 0.0;
    parallel_ranges(run, fixed.cells(), 1 << 16, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i) {
            if (problem.kind[i] == free_cell) {
                problem.value[i] = guess;
            }
        }
    });
}

void set_source(solver::GridProblem& problem, Raster<double> const& carrier, Guidance const& guidance, Run const& run) {
    problem.source = Raster<double>(carrier.grid());
    std::int64_t const width = carrier.width();
    parallel_ranges(run, carrier.height(), 8, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin * width; i < end * width; ++i) {
            if (problem.kind[i] != free_cell) {
                continue;
            }
            // How much each wanted difference exceeds the carrier's own.
            auto const more = [&](Raster<double> const& wanted, std::int64_t here, std::int64_t there) {
                return problem.kind[here] == outside_cell || problem.kind[there] == outside_cell
                           ? 0.0
                           : wanted[here] - (carrier[there] - carrier[here]);
            };
            std::int64_t const col = i % width;
            double const to_east = col + 1 < width ? more(guidance.east, i, i + 1) : 0.0;
            double const from_west = col > 0 ? more(guidance.east, i - 1, i) : 0.0;
            double const to_south = i + width < carrier.cells() ? more(guidance.south, i, i + width) : 0.0;
            double const from_north = i >= width ? more(guidance.south, i - width, i) : 0.0;
            problem.source[i] = (from_west - to_east) + (from_north - to_south);
        }
    });
}

constexpr float far = std::numeric_limits<float>::infinity();

// Along columns, row by row, each from the previous one.
void sweep_columns(Mask const& mask, Raster<float>& distance) {
    auto const step = [&](std::int64_t row, std::int64_t from) {
        for (std::int64_t col = 0; col < mask.width(); ++col) {
            float& d = distance[{col, row}];
            if (mask[{col, row}] == 0) {
                d = 0.0F;
            } else if (from >= 0 && from < mask.height() && distance[{col, from}] + 1.0F < d) {
                d = distance[{col, from}] + 1.0F;
            }
        }
    };
    for (std::int64_t row = 0; row < mask.height(); ++row) {
        step(row, row - 1);
    }
    for (std::int64_t row = mask.height() - 1; row >= 0; --row) {
        step(row, row + 1);
    }
}

/// The lower envelope of the parabolas v(c)^2 + (x - c)^2 of a row.
class Envelope {
public:
    void take(std::span<float> row) {
        centres_.clear();
        begins_.clear();
        heights_.clear();
        for (std::size_t c = 0; c < row.size(); ++c) {
            if (row[c] < far) {
                add(static_cast<double>(c), static_cast<double>(row[c]) * static_cast<double>(row[c]));
            }
        }
        if (centres_.empty()) {
            return;
        }
        std::size_t k = 0;
        for (std::size_t c = 0; c < row.size(); ++c) {
            auto const x = static_cast<double>(c);
            while (k + 1 < centres_.size() && begins_[k + 1] < x) {
                ++k;
            }
            double const dx = x - centres_[k];
            row[c] = static_cast<float>(std::sqrt(dx * dx + heights_[k]));
        }
    }

private:
    void add(double centre, double height) {
        double begin = -std::numeric_limits<double>::infinity();
        while (!centres_.empty()) {
            double const c = centres_.back();
            begin = 0.5 * ((height - heights_.back()) / (centre - c) + (centre + c));
            if (begin > begins_.back()) {
                break;
            }
            centres_.pop_back();
            begins_.pop_back();
            heights_.pop_back();
            begin = -std::numeric_limits<double>::infinity();
        }
        centres_.push_back(centre);
        begins_.push_back(begin);
        heights_.push_back(height);
    }

    std::vector<double> centres_;
    std::vector<double> begins_; // where each begins to be the lowest
    std::vector<double> heights_;
};

} // namespace

EditRegion edit_region_of(Raster<float> const& target, Mask const& changes, Mask const& given, std::string const& stage,
                          Run const& run) {
    Box const box = box_of(changes, stage);
    Grid const frame = frame_of(target.grid(), box);
    EditRegion edit_region{box.first, Raster<std::uint8_t>(frame), Raster<double>(frame)};
    auto const changes_there = [&](Cell c) { return target.grid().contains(c) && changes[c] != 0; };
    for (std::int64_t i = 0; i < frame.cells(); ++i) {
        Cell const c = frame.at(i);
        Cell const there{c.col + box.first.col, c.row + box.first.row};
        edit_region.target[i] = target[there];
        if (changes[there] != 0) {
            edit_region.kind[i] = free_cell;
            ++edit_region.cells;
            continue;
        }
        bool const is_given = given.cells() > 0 && given[there] != 0;
        bool const is_beside = std::ranges::any_of(neighbours_of(there), changes_there);
        if (!is_given && (!is_beside || std::isnan(target[there]))) {
            continue;
        }
        refuse_if<BadInput>(!is_given && std::isinf(target[there]), stage,
                            "the target's height at column {}, row {} is infinite: correct it", there.col, there.row);
        edit_region.kind[i] = fixed_cell;
        ++edit_region.neighbours;
    }
    require_held(edit_region, target.grid(), stage, run);
    return edit_region;
}

solver::GridSolution solve_guided(Raster<std::uint8_t> const& kind, Raster<double> const& fixed,
                                  Raster<double> const& carrier, Guidance const& guidance,
                                  solver::PoissonParams const& params, Run const& run) {
    solver::GridProblem problem{kind, Raster<double>(kind.grid()), {}};
    set_values(problem, fixed, carrier, run);
    if (guidance.east.cells() > 0) {
        set_source(problem, carrier, guidance, run);
    }
    solver::GridSolution solution = solver::solve_poisson(std::move(problem), params, run);
    parallel_ranges(run, kind.cells(), 1 << 16, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i) {
            if (kind[i] == free_cell) {
                solution.value[i] += carrier[i];
            } else if (kind[i] == fixed_cell) {
                solution.value[i] = fixed[i];
            }
        }
    });
    return solution;
}

Raster<float> distance_within(Mask const& mask, Run const& run) {
    Raster<float> distance(mask.grid(), far);
    sweep_columns(mask, distance);
    parallel_ranges(run, mask.height(), 8, [&](std::int64_t begin, std::int64_t end) {
        Envelope envelope;
        for (std::int64_t row = begin; row < end; ++row) {
            envelope.take(distance.row(row));
        }
    });
    return distance;
}

} // namespace thalweg::blend
