// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <algorithm>
#include <deque>
#include <utility>
#include <vector>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/lanes.hpp>
#include <thalweg/surface/equilibrium/internal/erodibility.hpp>
#include <thalweg/surface/equilibrium/internal/known_features.hpp>
#include <thalweg/surface/equilibrium/internal/rebuild_steps.hpp>
#include <thalweg/surface/equilibrium/internal/river_cells.hpp>

// Described in docs/algorithms/equilibrium_levels.md.

namespace thalweg::surface {
namespace {

constexpr std::uint64_t erodibility_stage = 0x726f636b; // "rock"
constexpr double shortest_wave = 2.0;
// Smooth interpolation of four uniform numbers has about half the variance of one, which is a twelfth.
constexpr double to_unit_variance = 5.0;
constexpr double stronger = 1.1; // from octave to octave: gullies need more amplitude than the long waves leave them

/// A row of cells in an octave's lattice: the place of its first cell and the steps to the next ones.
struct OctaveRow {
    float const* nodes;
    std::int64_t width; ///< of the lattice
    double x;
    double y;
    double x_per_col;
    double y_per_col;
    float weight;
};

#define THALWEG_KERNELS <thalweg/surface/equilibrium/internal/octave_lanes.inc>
#include <thalweg/core/run/lanes.inc>

/// One octave: its lattice, rotated and shifted against the grid, and the random numbers at the nodes in use.
class Octave {
public:
    Octave(TerrainLevel const& level, ErodibilityNoise const& params, std::uint64_t number, double wave, Run const& run)
        : Octave(params.strike + turn(number, params.stretch), std::sqrt(params.stretch), level.side / wave) {
        double const col = static_cast<double>(level.corner.col) / level.side - 0.5; // centre of the frame's corner
        double const row = static_cast<double>(level.corner.row) / level.side - 0.5;
        x0_ = x_per_col_ * col - x_per_row_ * row + 17.3 * static_cast<double>(number);
        y0_ = y_per_col_ * col + y_per_row_ * row + 91.7 * static_cast<double>(number);
        auto const across = static_cast<double>(level.width);
        auto const down = static_cast<double>(level.height);
        double const left = std::floor(x0_ + std::min(0.0, x_per_col_ * across) + std::min(0.0, -x_per_row_ * down));
        double const top = std::floor(y0_ + std::min(0.0, y_per_col_ * across) + std::min(0.0, y_per_row_ * down));
        double const reach_x = std::fabs(x_per_col_) * across + std::fabs(x_per_row_) * down;
        double const reach_y = std::fabs(y_per_col_) * across + std::fabs(y_per_row_) * down;
        width_ = static_cast<std::int64_t>(reach_x) + 4;
        auto const rows = static_cast<std::int64_t>(reach_y) + 4;
        nodes_.resize(static_cast<std::size_t>(width_ * rows));
        draw(params.seed, number, static_cast<std::int64_t>(left), static_cast<std::int64_t>(top), rows, run);
        x0_ -= left;
        y0_ -= top;
    }

    void add_to_row(std::int64_t row, double weight, float* out, std::int64_t count) const {
        auto* const add = widest_lanes() == Lanes::avx2 ? &avx2::octave_row : &plain::octave_row;
        add({nodes_.data(), width_, x0_ - x_per_row_ * static_cast<double>(row),
             y0_ + y_per_row_ * static_cast<double>(row), x_per_col_, y_per_col_, static_cast<float>(weight)},
            out, count);
    }

private:
    /// lattice: cells of the level per lattice width
    Octave(double angle, double stretch, double per_cell)
        : x_per_col_(portable::cos(angle) * per_cell / stretch), x_per_row_(portable::sin(angle) * per_cell / stretch),
          y_per_col_(portable::sin(angle) * per_cell * stretch), y_per_row_(portable::cos(angle) * per_cell * stretch) {
    }

    /// A random angle without grain; otherwise up to 17 degrees on either side of the strike.
    static double turn(std::uint64_t number, double stretch) {
        return stretch > 1.0 ? 0.15 * (static_cast<double>(number * 7919 % 5) - 2.0)
                             : 0.7 * static_cast<double>(number);
    }

    void draw(std::uint64_t seed, std::uint64_t number, std::int64_t left, std::int64_t top, std::int64_t rows,
              Run const& run) {
        constexpr std::int64_t a_block = 8;
        parallel_ranges(run, rows, least_rows(width_), [&](std::int64_t begin, std::int64_t end) {
            for (std::int64_t row = begin; row < end; ++row) {
                std::array<std::uint64_t, 4> words{};
                std::int64_t held = -1;
                for (std::int64_t col = 0; col < width_; ++col) {
                    // Counted from far to the left, so that the position of blocks does not depend on the grid.
                    std::int64_t const at = left + col + (std::int64_t{1} << 40);
                    if (at / a_block != held) {
                        held = at / a_block;
                        words = random_block(seed, erodibility_stage, number, static_cast<std::uint64_t>(top + row),
                                             static_cast<std::uint64_t>(held));
                    }
                    auto const k = static_cast<std::uint64_t>(at % a_block);
                    auto const half = static_cast<std::uint32_t>(words[k / 2] >> (32 * (k % 2)));
                    nodes_[row * width_ + col] = static_cast<float>(static_cast<double>(half) * 0x1p-32 - 0.5);
                }
            }
        });
    }

    double x_per_col_; ///< along the strike, in widths of the lattice
    double x_per_row_;
    double y_per_col_; ///< across
    double y_per_row_;
    double x0_ = 0.0;
    double y0_ = 0.0;
    std::int64_t width_ = 0;
    Cells<float> nodes_;
};

// Smooth noise of mean 0: value noise on lattices from the longest wave down to two cells, each half as wide as the
// previous one, slightly stronger and rotated against it, all stretched along the strike; without waves that a level's
// cells cannot resolve. The variance of the first octaves is about 1. Depends on position and seed alone.
Cells<float> erodibility_noise(TerrainLevel const& level, ErodibilityNoise const& params, Run const& run) {
    Cells<float> noise(static_cast<std::size_t>(level.cells()));
    double variance = 0.0;
    double part = 1.0;
    for (int octave = 0; octave < params.octaves; ++octave, part *= stronger * stronger) {
        variance += part;
    }
    double weight = to_unit_variance / std::sqrt(variance);
    double wave = params.longest_wave;
    double const shortest = std::max(shortest_wave, 1.5 * static_cast<double>(level.side));
    for (std::uint64_t number = 0; wave >= shortest; ++number, wave /= 2.0, weight *= stronger) {
        Octave const octave(level, params, number, wave, run);
        parallel_ranges(run, level.height, least_rows(level.width), [&](std::int64_t begin, std::int64_t end) {
            for (std::int64_t row = begin; row < end; ++row) {
                octave.add_to_row(row, weight, &noise[row * level.width], level.width);
            }
        });
    }
    return noise;
}

/// Mean of a field over a block of finest cells, without cells that have no value.
float mean_over(Raster<float> const& field, Cell from, std::int64_t side) {
    double sum = 0.0;
    double count = 0.0;
    for (std::int64_t r = from.row; r < from.row + side; ++r) {
        for (std::int64_t c = from.col; c < from.col + side; ++c) {
            Cell const at{std::clamp<std::int64_t>(c, 0, field.width() - 1),
                          std::clamp<std::int64_t>(r, 0, field.height() - 1)};
            if (float const value = field[at]; !std::isnan(value)) {
                sum += static_cast<double>(value);
                count += 1.0;
            }
        }
    }
    return count > 0.0 ? static_cast<float>(sum / count) : 1.0F;
}

Cells<float> level_of(Raster<float> const& field, TerrainLevel const& level) {
    auto const side = static_cast<std::int64_t>(level.side);
    Cells<float> out(static_cast<std::size_t>(level.cells()), 1.0F);
    for (std::int64_t row = 1; row + 1 < level.height; ++row) {
        for (std::int64_t col = 1; col + 1 < level.width; ++col) {
            Cell const from{level.corner.col + (col - 1) * side, level.corner.row + (row - 1) * side};
            out[row * level.width + col] = mean_over(field, from, side);
        }
    }
    return out;
}

constexpr float tolerated = 0.2F; // [cells of the level] tolerated deficit of the terrain beside a river
constexpr float rate = 0.5F;      // largest change per call
// share of the decrease by which the cap increases: slopes steeper than at the fields' erodibility, but not walls
constexpr float of_cap = 0.4F;
constexpr float reach_cells = 4.0F;   // [finest cells] beside a flow path
constexpr std::size_t longest = 4096; // [cells] of a flow path

/// The lowest land cell in the second ring of a river cell, without banks.
std::optional<std::size_t> lowest_beside(TerrainLevel const& level, std::uint32_t cell) {
    std::optional<std::size_t> lowest;
    each_of_second_ring(level, cell, [&](std::size_t n) {
        bool const dry = level.type[n] == CellType::land || level.type[n] == CellType::rim;
        if (dry && (!lowest || level.z[n] < level.z[*lowest])) {
            lowest = n;
        }
    });
    return lowest;
}

/// The graded or prescribed height of a river cell, regardless of the terrain.
float wanted_height(TerrainLevel const& level, EquilibriumLaw const& law, std::size_t n) {
    RiverCells const& rivers = level.rivers;
    if (!rivers.asked.empty() && !std::isnan(rivers.asked[n])) {
        return rivers.asked[n];
    }
    if (rivers.is_held(n)) {
        return level.z[rivers.cell[n]];
    }
    float const below = level.z[rivers.cell[rivers.receiver[n]]];
    float const length = level.side * step_lengths[rivers.direction[n]];
    return below + graded_tangent(level, law, n) * length;
}

/// Marks the flow path beside a river cell with the deficit of the terrain there.
void mark_lack(TerrainLevel const& level, EquilibriumLaw const& law, std::size_t n, SomeCells& marks) {
    RiverCells const& rivers = level.rivers;
    auto const lowest = lowest_beside(level, rivers.cell[n]);
    float const wanted = lowest ? wanted_height(level, law, n) : 0.0F;
    if (!lowest || level.z[*lowest] + tolerated * level.side >= wanted) {
        return;
    }
    auto const offsets = level.offsets();
    std::vector<std::size_t> path;
    std::size_t at = *lowest;
    while (is_land(level.type[at]) && level.direction[at] >= 0 && path.size() < longest) {
        path.push_back(at);
        at = moved(at, offsets[level.direction[at]]);
    }
    constexpr int steps = 12;
    if (runs_through(rivers, n, at, steps)) { // it falls as its own river does
        return;
    }
    constexpr float least = 1e-3F; // [cells of the level]
    float const base = std::isinf(level.z[at]) ? 0.0F : level.z[at];
    float const has = std::max(level.z[*lowest] - base, least * level.side);
    auto const lack = static_cast<float>(portable::log(static_cast<double>(std::max((wanted - base) / has, 1.0F))));
    for (std::size_t const i : path) {
        marks.set(i, std::max(marks.or_zero(i), rate * std::min(1.0F, lack)), level.type.size());
    }
}

/// Sums of the marks within reach along a row, and their numbers; empty: there are none.
struct RowOfMarks {
    std::vector<float> sums;
    std::vector<float> counts;
};

RowOfMarks row_of(SomeCells const& marks, std::size_t first, std::int64_t width, std::int64_t reach) {
    std::vector<float> values(static_cast<std::size_t>(width), 0.0F);
    marks.write(first, values);
    if (std::ranges::all_of(values, [](float mark) { return mark == 0.0F; })) {
        return {};
    }
    RowOfMarks out{std::vector<float>(values.size()), std::vector<float>(values.size())};
    for (std::int64_t col = 0; col < width; ++col) {
        for (std::int64_t c = std::max<std::int64_t>(0, col - reach); c <= std::min(width - 1, col + reach); ++c) {
            out.sums[col] += values[c];
            out.counts[col] += values[c] > 0.0F ? 1.0F : 0.0F;
        }
    }
    return out;
}

/// Calls take(cell, mean) for the cells that have marks in a square around them, with their mean.
template <class Take> void spread(SomeCells const& marks, TerrainLevel const& level, std::int64_t reach, Take take) {
    std::deque<RowOfMarks> rows; // within reach of a row: few, as a level of them would take more than all else
    std::vector<float> sums(static_cast<std::size_t>(level.width));
    std::vector<float> counts(sums.size());
    for (std::int64_t row = -reach; row < level.height; ++row) {
        if (std::int64_t const next = row + reach; next < level.height) {
            rows.push_back(row_of(marks, static_cast<std::size_t>(next * level.width), level.width, reach));
        }
        if (row > reach) {
            rows.pop_front();
        }
        if (row < 0 || std::ranges::all_of(rows, [](RowOfMarks const& of) { return of.sums.empty(); })) {
            continue;
        }
        std::ranges::fill(sums, 0.0F);
        std::ranges::fill(counts, 0.0F);
        for (RowOfMarks const& of : rows) {
            for (std::size_t col = 0; col < of.sums.size(); ++col) {
                sums[col] += of.sums[col];
                counts[col] += of.counts[col];
            }
        }
        for (std::size_t col = 0; col < sums.size(); ++col) {
            if (counts[col] > 0.0F) {
                take(static_cast<std::size_t>(row * level.width) + col, sums[col] / counts[col]);
            }
        }
    }
}

} // namespace

void set_erodibility(TerrainLevel& level, ErodibilityFields const& fields, ErodibilityParams const& params,
                     Run const& run) {
    Cells<float> values = erodibility_noise(level, params.noise, run);
    for (std::uint32_t const river : level.rivers.cell) {
        values[river] = 0.0F;
    }
    Cells<float> rock;
    if (fields.erodibility.cells() > 0) {
        rock = level_of(fields.erodibility, level);
        std::transform(rock.begin(), rock.end(), rock.begin(),
                       [](float of) { return static_cast<float>(portable::pow(static_cast<double>(of), 0.2)); });
    }
    if (fields.uplift.cells() > 0) {
        level.uplift = level_of(fields.uplift, level);
    }
    auto* const turn = widest_lanes() == Lanes::avx2 ? &avx2::fifth_root_row : &plain::fifth_root_row;
    std::vector<float> const even(rock.empty() ? static_cast<std::size_t>(level.width) : 0, 1.0F);
    auto const roughness = static_cast<float>(params.roughness);
    parallel_ranges(run, level.height, least_rows(level.width), [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin; row < end; ++row) {
            auto const first = static_cast<std::size_t>(row * level.width);
            turn(&values[first], rock.empty() ? even.data() : &rock[first], roughness, level.width);
        }
    });
    level.rock = Rock(std::move(values));
}

void add_firmness(TerrainLevel& level, std::size_t i, float more) {
    if (more == 0.0F || level.type[i] == CellType::river) {
        return;
    }
    level.firmness.set(i, level.firmness.or_zero(i) + more, level.type.size());
    level.rock.set_erodibility(i, level.rock.erodibility(i) *
                                      static_cast<float>(portable::exp(static_cast<double>(-more))));
    level.rock.set_cap(i, level.rock.cap(i) * static_cast<float>(portable::exp(static_cast<double>(of_cap * more))));
}

void reduce_erodibility(TerrainLevel& level, EquilibriumLaw const& law, float firmest) {
    RiverCells const& rivers = level.rivers;
    SomeCells marks;
    for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
        if (rivers.number[n] >= 0 && !leaves_grid(rivers, n) && rivers.level[n] == 0) {
            mark_lack(level, law, n, marks);
        }
    }
    if (marks.empty()) {
        return;
    }
    auto const reach = std::max<std::int64_t>(1, static_cast<std::int64_t>(reach_cells / level.side));
    spread(marks, level, reach, [&](std::size_t i, float mean) {
        add_firmness(level, i, std::max(0.0F, std::min(mean, firmest - level.firmness.or_zero(i))));
    });
}

void change_erodibility_at_crests(TerrainLevel& level, Run const& run) {
    WallParams walls;
    walls.reach = reach_cells / level.side;
    constexpr float firmest = 2.0F; // [log]
    Cells<float> const lack = land_off_crests(level, walls, run);
    for (std::size_t i = 0; i < lack.size(); ++i) {
        float const has = level.firmness.or_zero(i);
        add_firmness(level, i, std::clamp(lack[i], -firmest - has, firmest - has));
    }
}

void copy_firmness(TerrainLevel& level, TerrainLevel const& coarser) {
    if (coarser.firmness.empty()) {
        return;
    }
    each_inner(level, [&](std::size_t i) {
        Cell const c = level.at(i);
        auto const value = [&](std::int64_t cell) { return coarser.firmness.or_zero(static_cast<std::size_t>(cell)); };
        add_firmness(level, i, value_between(coarser, value, place_in(coarser, level, c.col, c.row)));
    });
}

} // namespace thalweg::surface
