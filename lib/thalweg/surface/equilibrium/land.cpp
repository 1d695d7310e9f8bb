// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/surface/equilibrium/internal/steps.hpp>

namespace thalweg::surface {
namespace {

/// Cells by height, in buckets stored as linked lists in one array.
class Buckets {
public:
    Buckets(TerrainLevel const& level) : next_(level.z.size()), head_(count, none) {
        float low = std::numeric_limits<float>::infinity();
        float high = -low;
        for (std::size_t i = 0; i < level.z.size(); ++i) {
            if (level.type[i] != CellType::outside) {
                low = std::min(low, level.z[i]);
                high = std::max(high, level.z[i]);
            }
        }
        low_ = low;
        per_height_ = high > low ? static_cast<float>(count - 1) / (high - low) : 0.0F;
    }

    void push(std::size_t cell, float z) {
        float const place = std::min((z - low_) * per_height_, static_cast<float>(count - 1));
        std::size_t const bucket = std::max(at_, static_cast<std::size_t>(std::max(place, 0.0F)));
        next_[cell] = head_[bucket];
        head_[bucket] = static_cast<std::uint32_t>(cell);
    }

    /// \return a cell of the lowest bucket, or none.
    std::uint32_t pop() {
        while (at_ < count && head_[at_] == none) {
            ++at_;
        }
        if (at_ == count) {
            return none;
        }
        std::uint32_t const cell = head_[at_];
        head_[at_] = next_[cell];
        return cell;
    }

    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

private:
    static constexpr std::size_t count = 1 << 16;
    Cells<std::uint32_t> next_;
    std::vector<std::uint32_t> head_;
    std::size_t at_ = 0;
    float low_ = 0.0F;
    float per_height_ = 0.0F;
};

constexpr std::int8_t unreached = -2;

/// [least tangents] rise to a cell that a flood reaches, by its node's position, so that flow paths across flat floods
/// meander as on rough terrain.
float rise_to(TerrainLevel const& level, std::size_t i) {
    constexpr unsigned steps = 16;
    constexpr float most = 4.0F;
    return level.shift.empty() ? 1.0F : 1.0F + most / steps * static_cast<float>(5U * level.shift[i] % steps);
}

/// Directs a bank to the river beside it and raises it above all of its cells.
void settle_bank(TerrainLevel& level, std::size_t i, std::array<std::int64_t, 8> const& offsets) {
    float highest = -std::numeric_limits<float>::infinity();
    float steepest = -std::numeric_limits<float>::infinity();
    for (std::size_t k = 0; k < offsets.size(); ++k) {
        std::size_t const n = moved(i, offsets[k]);
        if (level.type[n] != CellType::river) {
            continue;
        }
        highest = std::max(highest, level.z[n]);
        if (float const slope = (level.z[i] - level.z[n]) / step_lengths[k]; slope > steepest) {
            steepest = slope;
            level.direction[i] = static_cast<std::int8_t>(k);
        }
    }
    level.z[i] = std::max(level.z[i], highest + 1.5F * bank_step * level.side);
}

} // namespace

void flood_terrain(TerrainLevel& level) {
    auto const offsets = level.offsets();
    level.direction.assign(level.type.size(), unreached);
    for (std::size_t n = 0; n < level.rivers.cell.size(); ++n) {
        level.direction[level.rivers.cell[n]] = level.rivers.direction[n];
    }
    each_inner(level, [&](std::size_t i) {
        if (is_bank(level.type[i])) {
            settle_bank(level, i, offsets);
        }
    });
    Buckets queue(level);
    auto const last_row = level.type.size() - static_cast<std::size_t>(level.width);
    for (std::size_t i = 0; i < level.type.size(); ++i) {
        if (!is_land(level.type[i])) {
            level.direction[i] = level.type[i] == CellType::river ? level.direction[i] : no_direction;
        }
        if (level.direction[i] != unreached && level.type[i] != CellType::outside) {
            queue.push(i, level.z[i]);
        }
    }
    auto const width = static_cast<std::size_t>(level.width);
    for (auto i = queue.pop(); i != Buckets::none; i = queue.pop()) {
        bool const top = i < width;
        bool const bottom = i >= last_row;
        bool const left = i % width == 0;
        bool const right = i % width == width - 1;
        for (std::size_t k = 0; k < offsets.size(); ++k) {
            Cell const step = d8_steps[k];
            if ((top && step.row < 0) || (bottom && step.row > 0) || (left && step.col < 0) ||
                (right && step.col > 0)) {
                continue;
            }
            std::size_t const n = moved(i, offsets[k]);
            if (level.direction[n] == unreached) {
                level.direction[n] = static_cast<std::int8_t>((k + 4) % 8);
                float const rise = rise_to(level, n) * least_tangent * level.side;
                level.z[n] = std::max(level.z[n], level.z[i] + rise * step_lengths[k]);
                queue.push(n, level.z[n]);
            }
        }
    }
    for (std::size_t i = 0; i < level.type.size(); ++i) {
        if (level.direction[i] == unreached) {
            level.direction[i] = no_direction;
            level.type[i] = CellType::outside;
            level.z[i] = std::numeric_limits<float>::infinity();
        }
    }
}

namespace {

std::int8_t steepest(TerrainLevel const& level, std::size_t i, std::array<std::int64_t, 8> const& offsets,
                     JitteredPerLength const& per_length) {
    float const z = level.z[i];
    int const here = level.shift[i];
    float best = 0.0F;
    std::int8_t way = level.direction[i];
    for (std::size_t k = 0; k < 8; ++k) {
        std::size_t const n = moved(i, offsets[k]);
        int const change = level.shift[n] - here;
        auto const code = static_cast<std::size_t>(jitter_codes + (k < 4 ? change : -change));
        float const slope = (z - level.z[n]) * per_length[k % 4][code];
        if (slope > best) {
            best = slope;
            way = static_cast<std::int8_t>(k);
        }
    }
    return way;
}

std::int8_t steepest_river(TerrainLevel const& level, std::size_t i, std::array<std::int64_t, 8> const& offsets) {
    float best = 0.0F;
    std::int8_t way = level.direction[i];
    for (std::size_t k = 0; k < 8; ++k) {
        std::size_t const n = moved(i, offsets[k]);
        float const slope = (level.z[i] - level.z[n]) * static_cast<float>(d8_per_length[k]);
        if (level.type[n] == CellType::river && slope > best) {
            best = slope;
            way = static_cast<std::int8_t>(k);
        }
    }
    return way;
}

} // namespace

void set_steepest_receivers(TerrainLevel& level, JitteredPerLength const& per_length, Run const& run) {
    auto const offsets = level.offsets();
    parallel_ranges(run, level.height - 2, 16, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin + 1; row < end + 1; ++row) {
            auto const first = static_cast<std::size_t>(row * level.width);
            for (std::size_t i = first + 1; i + 1 < first + static_cast<std::size_t>(level.width); ++i) {
                if (is_bank(level.type[i])) {
                    level.direction[i] = steepest_river(level, i, offsets);
                } else if (is_land(level.type[i])) {
                    level.direction[i] = steepest(level, i, offsets, per_length);
                }
            }
        }
    });
}

void set_stack_order(TerrainLevel& level) {
    constexpr std::uint8_t done = 255;
    auto const offsets = level.offsets();
    Cells<std::uint8_t> awaited(level.direction.size());
    for (std::size_t i = 0; i < awaited.size(); ++i) {
        if (level.direction[i] >= 0) {
            ++awaited[moved(i, offsets[level.direction[i]])];
        }
    }
    level.area.assign(level.direction.size(), 1);
    for (Inflow const& in : level.inflow) {
        level.area[in.cell] += in.area;
    }
    level.order.resize(level.direction.size());
    std::size_t count = 0;
    for (std::size_t i = 0; i < awaited.size(); ++i) {
        for (std::size_t at = i; awaited[at] == 0;) {
            awaited[at] = done;
            if (level.direction[at] < 0) {
                break;
            }
            if (is_land(level.type[at])) {
                level.order[count++] = static_cast<std::uint32_t>(at);
            }
            std::size_t const next = moved(at, offsets[level.direction[at]]);
            level.area[next] += level.area[at];
            --awaited[next];
            at = next;
        }
    }
    level.order.resize(count);
}

namespace {

// Weights of the nine-point Laplacian: side and corner neighbours.
constexpr float by_side = 4.0F / 6.0F;
constexpr float by_corner = 1.0F / 6.0F;

struct Creep {
    float gain;   ///< weighted heights of the neighbours
    float weight; ///< their weights
};

Creep creep_inside(float const* z, std::int64_t width) {
    float const sides = (z[1] + z[-1]) + (z[width] + z[-width]);
    float const corners = (z[width + 1] + z[width - 1]) + (z[-width + 1] + z[-width - 1]);
    return {by_side * sides + by_corner * corners, 4.0F * (by_side + by_corner)};
}

Creep creep_at_rim(TerrainLevel const& level, std::size_t i, std::array<std::int64_t, 8> const& offsets) {
    Creep creep{0.0F, 0.0F};
    for (std::size_t k = 0; k < offsets.size(); ++k) {
        std::size_t const n = moved(i, offsets[k]);
        if (level.type[n] != CellType::outside) {
            float const weight = k % 2 == 0 ? by_side : by_corner;
            creep.gain += weight * level.z[n];
            creep.weight += weight;
        }
    }
    return creep;
}

constexpr float tolerance = 1.5F; // relative to the cap

float greatest_height(TerrainLevel const& level, std::size_t i, std::array<std::int64_t, 8> const& offsets) {
    float const steepest = tolerance * level.cap[i] * level.side;
    float most = level.z[i];
    for (std::size_t k = 0; k < offsets.size(); ++k) {
        most = std::min(most, level.z[moved(i, offsets[k])] + steepest * step_lengths[k]);
    }
    return most;
}

} // namespace

void relax_terrain(TerrainLevel& level, EquilibriumLaw const& law) {
    auto const offsets = level.offsets();
    float const creep_rate = law.creep / (level.side * level.side);
    float const cell_area = level.side * level.side;
    for (std::size_t at = level.order.size(); at-- > 0;) {
        std::size_t const i = level.order[at];
        auto const way = static_cast<std::size_t>(level.direction[i]);
        float const length = level.side * step_lengths[way];
        float const below = level.z[moved(i, offsets[way])];
        CellType const type = level.type[i];
        bool const at_rim = type == CellType::rim || type == CellType::rim_bank;
        Creep const creep = at_rim ? creep_at_rim(level, i, offsets) : creep_inside(&level.z[i], level.width);
        float const cutting =
            law.land_power(static_cast<float>(level.area[i]) * cell_area) * level.erodibility[i] / length;
        float const uplift = level.uplift.empty() ? 1.0F : level.uplift[i];
        float z = (uplift + cutting * below + creep_rate * creep.gain) / (cutting + creep_rate * creep.weight);
        z = std::min(z, below + level.cap[i] * length);
        z = std::max(z, below + least_tangent * length);
        if (is_bank(type)) {
            z = std::max(z, highest_river(level, i, offsets) + bank_step * level.side);
        }
        level.z[i] = z;
    }
}

void slide_terrain(TerrainLevel& level) {
    auto const offsets = level.offsets();
    std::vector<std::size_t> open;
    auto const slide = [&](std::size_t i) {
        if (is_land(level.type[i]) && !is_bank(level.type[i])) {
            if (float const most = greatest_height(level, i, offsets); most < level.z[i]) {
                level.z[i] = most;
                open.push_back(i);
            }
        }
    };
    each_inner(level, slide);
    for (std::size_t k = 0; k < open.size(); ++k) {
        for (std::int64_t const offset : offsets) {
            slide(moved(open[k], offset));
        }
    }
}

namespace {

constexpr float least_width = 0.5F; // [cells] narrower floors are not resolved
constexpr float foot_widths = 2.0F; // end of the foot, in half widths of the floor
constexpr float most_widening = 2.0F;
constexpr float floor_share = 0.04F; // cap on the floor, relative to the cap

/// Varies the width of floors: from half in gorges to twice in basins.
float widening(TerrainLevel const& level, std::size_t i, FloorParams const& params) {
    double const long_wave = std::max(2.0, 1800.0 / params.cell_m); // [cells]
    double const short_wave = std::max(2.0, 400.0 / params.cell_m);
    Cell const cell{static_cast<std::int64_t>(i) % level.width, static_cast<std::int64_t>(i) / level.width};
    double const noise = value_noise(params.seed, cell, long_wave) + 0.5 * value_noise(params.seed, cell, short_wave);
    return static_cast<float>(portable::exp(std::clamp(noise, -1.0, 1.0) * 0.69));
}

/// Widening of river cells' floors near the sea, where mouths are drowned and filled.
std::vector<float> filled_mouths(TerrainLevel const& level, double cell_m) {
    constexpr double reach_m = 3000.0;
    constexpr float at_mouth = 2.1F;
    RiverCells const& rivers = level.rivers;
    auto const offsets = level.offsets();
    std::vector<float> more(rivers.cell.size());
    auto const kept = static_cast<float>(portable::exp(-cell_m / reach_m));
    for (std::size_t n = 0; n < more.size(); ++n) {
        if (rivers.receiver[n] >= 0) {
            more[n] = kept * more[rivers.receiver[n]];
        } else if (std::any_of(offsets.begin(), offsets.end(), [&](std::int64_t offset) {
                       return level.type[moved(rivers.cell[n], offset)] == CellType::sea;
                   })) {
            more[n] = at_mouth;
        }
    }
    return more;
}

/// Width of a floor relative to that where 1 km² drains. Rivers with larger areas run between the flanks of ranges.
double growth(double area_km2) {
    constexpr double confined_km2 = 200.0;
    return portable::pow(std::min(area_km2, confined_km2), 0.42);
}

/// [cells] half widths of the floors of river cells.
std::vector<float> half_widths(TerrainLevel const& level, FloorParams const& params) {
    double const per_cell_km2 = params.cell_m * params.cell_m * 1e-6;
    double const per_km = 1000.0 / params.cell_m * params.width_km;
    std::vector<float> widths = filled_mouths(level, params.cell_m);
    for (std::size_t n = 0; n < widths.size(); ++n) {
        double const area_km2 = static_cast<double>(level.area[level.rivers.cell[n]]) * per_cell_km2;
        widths[n] = (1.0F + widths[n]) * static_cast<float>(per_km * growth(area_km2));
    }
    return widths;
}

} // namespace

void valley_floors(TerrainLevel& level, FloorParams const& params) {
    std::vector<float> const widths = half_widths(level, params);
    std::vector<float> reach(widths.size());
    std::transform(widths.begin(), widths.end(), reach.begin(),
                   [](float width) { return most_widening * foot_widths * width; });
    NearestRiver near = nearest_river(level, reach, std::move(level.order));
    each_inner(level, [&](std::size_t i) {
        if (near.distance[i] >= 0.0F || !is_land(level.type[i])) {
            return;
        }
        float const width = widths[near.number[i]];
        if (width < least_width) {
            return;
        }
        float const far = (near.distance[i] / width + most_widening * foot_widths) / widening(level, i, params);
        float const up = std::clamp((far - 1.0F) / (foot_widths - 1.0F), 0.0F, 1.0F);
        level.cap[i] *= floor_share + (1.0F - floor_share) * up * up;
    });
    level.order = std::move(near.number);
}

} // namespace thalweg::surface
