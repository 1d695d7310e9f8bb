// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <bit>
#include <cstring>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/lanes.hpp>
#include <thalweg/surface/equilibrium/internal/known_features.hpp>
#include <thalweg/surface/equilibrium/internal/land.hpp>
#include <thalweg/surface/equilibrium/internal/start_level.hpp>

// Described in docs/algorithms/equilibrium_levels.md.

namespace thalweg::surface {
namespace {

// Weights of the nine-point Laplacian: side and corner neighbours.
constexpr float by_side = 4.0F / 6.0F;
constexpr float by_corner = 1.0F / 6.0F;

/// Inner cells of a row; the pointers are to the first of them.
struct RowOfLevel {
    std::array<float const*, 3> z; ///< of the row above, this and the row below
    float const* erodibility;
    float const* uplift;
    float const* stiffness; ///< of the pull towards given heights, whose force is part of the uplift
    std::int8_t const* direction;
    float side;
    float diagonal;
    float creep_rate;

    float beside(std::int64_t column, std::size_t way) const {
        return z[static_cast<std::size_t>(1 + d8_steps[way].row)][column + d8_steps[way].col];
    }
};

constexpr std::uint8_t all_came = 64; // of cells that have donors: others are 0
constexpr std::uint8_t for_ever = 255;

#define THALWEG_KERNELS <thalweg/surface/equilibrium/internal/land_lanes.inc>
#include <thalweg/core/run/lanes.inc>

/// Calls visit(index of the first inner cell) for each row inside the frame, on all workers.
template <class Visit> void each_inner_row(TerrainLevel const& level, Run const& run, Visit visit) {
    parallel_ranges(run, level.height - 2, least_rows(level.width), [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin + 1; row < end + 1; ++row) {
            visit(static_cast<std::size_t>(row * level.width + 1));
        }
    });
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

/// Follows water from the cells without donors of a band of rows as far as it stays there, tile by tile, so that paths
/// mostly stay in the processor's cache.
/// \param awaited by cell: donors whose water has not arrived
/// \param leaving receives the cells whose water leaves the band
/// \return number of the cells that it followed: all are in level.order if that has places, which are a power of two
std::size_t follow_in_band(TerrainLevel& level, std::int64_t top, std::int64_t bottom, Cells<std::uint8_t>& awaited,
                           std::vector<std::uint32_t>& leaving) {
    constexpr std::int64_t tile = 64;
    constexpr std::size_t most = tile * tile; // paths that are followed at a time: each goes on in one cell or none
    std::int64_t const width = level.width;
    auto const first = static_cast<std::size_t>(top * width);
    auto const cells = static_cast<std::size_t>((bottom - top) * width);
    auto const offsets = level.offsets();
    // Bytes may lie anywhere, so that members would be read again after each is written.
    std::int8_t const* const direction = level.direction.data();
    std::uint8_t* const waits = awaited.data();
    std::uint32_t* const area = level.area.data();
    bool const keeps = !level.order.empty();
    std::vector<std::uint32_t> some(keeps ? 0 : most);
    std::uint32_t* const ends = keeps ? level.order.data() : some.data();
    std::size_t const places = keeps ? level.order.size() : most;
    std::size_t listed = 0;
    std::size_t followed = 0;
    for (std::int64_t row = top; row < bottom; row += tile) {
        for (std::int64_t left = 0; left < width; left += tile) {
            for (std::int64_t r = row; r < std::min(bottom, row + tile); ++r) {
                std::int64_t const end = r * width + std::min(width, left + tile);
                for (std::int64_t i = r * width + left; i < end; ++i) {
                    ends[listed & (places - 1)] = static_cast<std::uint32_t>(i);
                    listed += waits[i] == 0 ? 1U : 0U;
                }
            }
            for (; followed < listed; ++followed) {
                std::uint32_t const i = ends[followed & (places - 1)];
                std::size_t const next = moved(i, offsets[direction[i]]);
                if (next - first >= cells) {
                    leaving.push_back(i);
                    continue;
                }
                area[next] += area[i];
                ends[listed & (places - 1)] = static_cast<std::uint32_t>(next);
                listed += --waits[next] == all_came ? 1U : 0U;
            }
        }
    }
    return listed;
}

constexpr float tolerance = 1.5F; // relative to the cap

/// The greatest height of a cell above its neighbours in layers of rock, each of which has a cap of its own.
float greatest_height_in_layers(TerrainLevel const& level, std::size_t i, std::array<std::int64_t, 8> const& offsets) {
    LevelLayers const& strata = level.strata;
    auto const by_cap = static_cast<double>(tolerance * level.side * level.rock.cap(i) / steepest_tangent);
    auto const bed = static_cast<double>(strata.bed[i]);
    float most = level.z[i];
    for (std::size_t k = 0; k < offsets.size(); ++k) {
        std::size_t const n = moved(i, offsets[k]);
        if (level.z[n] < most) {
            auto const bed_below = static_cast<double>(strata.bed[n]);
            double const length = by_cap * static_cast<double>(step_lengths[k]);
            double const s = climb_through(strata.layers, static_cast<double>(level.z[n]) - bed_below, bed - bed_below,
                                           [&](std::size_t layer) { return strata.layers[layer].cap * length; });
            float const least = level.z[n] + level.least * level.side * step_lengths[k];
            most = std::min(most, std::max(static_cast<float>(s + bed), least));
        }
    }
    return most;
}

/// Whether a cell is steeper above a neighbour than the cap of its own layer allows.
bool is_steep_in_layer(TerrainLevel const& level, std::size_t i, std::array<std::int64_t, 8> const& offsets) {
    LevelLayers const& strata = level.strata;
    std::size_t const k = layer_of(strata.layers, static_cast<double>(level.z[i]) - static_cast<double>(strata.bed[i]));
    float const cap =
        tolerance * level.side * level.rock.cap(i) / steepest_tangent * static_cast<float>(strata.layers[k].cap);
    for (std::size_t step = 0; step < offsets.size(); ++step) {
        if (level.z[i] - level.z[moved(i, offsets[step])] > cap * step_lengths[step]) {
            return true;
        }
    }
    return false;
}

float greatest_height(TerrainLevel const& level, std::size_t i, std::array<std::int64_t, 8> const& offsets) {
    if (!level.strata.empty()) {
        return greatest_height_in_layers(level, i, offsets);
    }
    float const steepest = tolerance * level.side * level.rock.cap(i);
    float most = level.z[i];
    for (std::size_t k = 0; k < offsets.size(); ++k) {
        most = std::min(most, level.z[moved(i, offsets[k])] + steepest * step_lengths[k]);
    }
    return most;
}

/// One band of rows for one worker; a few more than workers otherwise.
std::int64_t band_count(TerrainLevel const& level, std::int64_t rows, Run const& run) {
    std::int64_t const workers = run.threads > 0 ? run.threads : std::max(1U, std::thread::hardware_concurrency());
    return workers == 1 ? 1 : std::clamp<std::int64_t>(level.height / rows, 1, std::int64_t{2} * workers);
}

/// A land cell's height from its receiver's.
/// \param rise, share the height is rise + share * below, before limits
float relaxed(float rise, float share, float below, float most, float least) {
    return std::max(std::min(rise + share * below, below + most), below + least);
}

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

/// Weights of the neighbours from which soil creeps to a land cell.
float creep_weight(TerrainLevel const& level, std::size_t i, std::array<std::int64_t, 8> const& offsets) {
    if (level.type[i] == CellType::land || level.type[i] == CellType::bank) {
        return 4.0F * (by_side + by_corner);
    }
    float weight = 0.0F;
    for (std::size_t k = 0; k < offsets.size(); ++k) {
        weight += level.type[moved(i, offsets[k])] == CellType::outside ? 0.0F : k % 2 == 0 ? by_side : by_corner;
    }
    return weight;
}

/// The height of a land cell in layers of rock.
/// \param next the receiver, whose height is below
/// \param force, cutting, creep as LandBalance
float height_in_layers(TerrainLevel const& level, std::size_t i, std::size_t next, float force, float cutting,
                       float creep, float length, float below) {
    LevelLayers const& strata = level.strata;
    auto const bed = [&](std::size_t cell) { return static_cast<double>(strata.bed[cell]); };
    LandBalance const balance{
        static_cast<double>(force),       static_cast<double>(creep),
        static_cast<double>(cutting),     static_cast<double>(length),
        static_cast<double>(level.least), static_cast<double>(level.rock.cap(i) / steepest_tangent)};
    double const z = height_in_layers(strata.layers, balance, static_cast<double>(below), bed(next), bed(i));
    float const least = below + level.least * length;
    return std::max(static_cast<float>(std::min(z, strata.most)), least);
}

/// How heights of land follow from those of receivers, from the heights before a sweep.
class Relaxer {
public:
    Relaxer(TerrainLevel& level, LandLaw const& law, Pull const& pull)
        : level_(level), law_(law), pull_(pull), offsets_(level.offsets()), inner_(level.width - 2),
          creep_rate_(law.creep / (level.side * level.side)),
          even_(level.uplift.empty() ? static_cast<std::size_t>(inner_) : 0, 1.0F),
          free_(pull.stiffness.empty() ? static_cast<std::size_t>(inner_) : 0, 0.0F) {
        for (std::size_t k = 0; k < length_.size(); ++k) {
            length_[k] = level.side * step_lengths[k];
        }
    }

    /// [finest cells] of the D8 steps.
    std::array<float, 8> const& length() const { return length_; }
    float creep_rate() const { return creep_rate_; }

    /// Sets banks; of other land cells z becomes their height above a receiver at 0, and the bits of area become those
    /// of the float by which it grows with the receiver's height.
    void prepare(Run const& run) const {
        constexpr std::int64_t rows = 64;
        auto const width = static_cast<std::size_t>(level_.width);
        std::int64_t const blocks = (level_.height - 2 + rows - 1) / rows;
        Cells<float> edges(2 * static_cast<std::size_t>(blocks) * width); // the rows above and below each block
        auto const end_of = [&](std::int64_t block) { return std::min(rows * (block + 1), level_.height - 2) + 1; };
        for (std::int64_t block = 0; block < blocks; ++block) {
            std::memcpy(&edges[2 * block * level_.width], &level_.z[rows * block * level_.width],
                        width * sizeof(float));
            std::memcpy(&edges[(2 * block + 1) * level_.width], &level_.z[end_of(block) * level_.width],
                        width * sizeof(float));
        }
        parallel_ranges(run, blocks, 1, [&](std::int64_t begin, std::int64_t end) {
            for (std::int64_t block = begin; block < end; ++block) {
                float const* const around = &edges[2 * block * level_.width];
                prepare_rows(rows * block + 1, end_of(block), around, around + width);
            }
        });
    }

private:
    /// Of a row's cells.
    struct Numbers {
        explicit Numbers(std::size_t cells) : power(cells), share(cells), erodibility(cells) {}
        std::vector<float> power;
        std::vector<float> share;
        std::vector<float> erodibility;
    };

    /// \param above, below heights of the rows beside these
    void prepare_rows(std::int64_t top, std::int64_t bottom, float const* above, float const* below) const {
        auto const width = static_cast<std::size_t>(level_.width);
        std::vector<float> upper(above, above + width);
        std::vector<float> here(width);
        Numbers numbers(static_cast<std::size_t>(inner_));
        for (std::int64_t row = top; row < bottom; ++row) {
            std::memcpy(here.data(), &level_.z[row * level_.width], width * sizeof(float));
            float const* const lower = row + 1 == bottom ? below : &level_.z[(row + 1) * level_.width];
            prepare_row(static_cast<std::size_t>(row * level_.width + 1), {&upper[1], &here[1], &lower[1]}, numbers);
            std::swap(upper, here);
        }
    }

    void prepare_row(std::size_t first, std::array<float const*, 3> const& z, Numbers& numbers) const {
        auto* const relaxation = widest_lanes() == Lanes::avx2 ? &avx2::relaxation_row : &plain::relaxation_row;
        auto const count = static_cast<std::size_t>(inner_);
        auto& [power, share, erodibility] = numbers;
        level_.rock.erodibilities(first, erodibility);
        float const cell_area = level_.side * level_.side;
        std::transform(&level_.area[first], &level_.area[first] + count, power.data(),
                       [&](std::uint32_t area) { return law_.power(static_cast<float>(area) * cell_area); });
        RowOfLevel const row{z,
                             erodibility.data(),
                             level_.uplift.empty() ? even_.data() : &level_.uplift[first],
                             pull_.stiffness.empty() ? free_.data() : &pull_.stiffness[first],
                             &level_.direction[first],
                             level_.side,
                             level_.side * step_lengths[1],
                             creep_rate_};
        float* const rise = &level_.z[first];
        if (!level_.strata.empty()) {
            prepare_in_layers(row, first, power);
            return;
        }
        relaxation(row, power.data(), rise, share.data(), inner_);
        for (std::size_t c = 0; c < count; ++c) {
            std::size_t const i = first + c;
            CellType const type = level_.type[i];
            if (is_land(type) && type != CellType::land && type != CellType::bank) {
                relax_at_rim(row, i, c, power[c], share[c]);
            }
            if (is_bank(type)) {
                rise[c] = bank_height(row, i, c, share[c]);
            } else if (is_land(type)) {
                level_.area[i] = std::bit_cast<std::uint32_t>(share[c]);
            } else {
                rise[c] = z[1][c];
            }
        }
    }

    /// Sets banks; of other land cells z becomes what raises them, and the bits of area what cuts them.
    void prepare_in_layers(RowOfLevel const& row, std::size_t first, std::vector<float> const& power) const {
        for (std::size_t c = 0; c < power.size(); ++c) {
            std::size_t const i = first + c;
            if (CellType const type = level_.type[i]; is_land(type)) {
                auto const way = static_cast<std::size_t>(level_.direction[i]);
                float const force = row.uplift[c] + creep_rate_ * creep_gain(row, i, c);
                float const cutting = power[c] * row.erodibility[c];
                if (is_bank(type)) {
                    float const below = row.beside(static_cast<std::int64_t>(c), way);
                    float const z = height_in_layers(level_, i, moved(i, offsets_[way]), force, cutting, creep_at(i),
                                                     length_[way], below);
                    level_.z[i] = above_rivers(row, i, c, std::min(z, below + level_.bank_rise));
                } else {
                    level_.z[i] = force;
                    level_.area[i] = std::bit_cast<std::uint32_t>(cutting);
                }
            } else {
                level_.z[i] = row.z[1][c];
            }
        }
    }

    /// Weighted heights of the neighbours from which soil creeps.
    float creep_gain(RowOfLevel const& row, std::size_t i, std::size_t c) const {
        if (level_.type[i] == CellType::land) {
            float const* const n = row.z[0] + c;
            float const* const z = row.z[1] + c;
            float const* const s = row.z[2] + c;
            return by_side * ((z[1] + z[-1]) + (s[0] + n[0])) + by_corner * ((s[1] + s[-1]) + (n[1] + n[-1]));
        }
        float gain = 0.0F;
        for (std::size_t k = 0; k < offsets_.size(); ++k) {
            if (level_.type[moved(i, offsets_[k])] != CellType::outside) {
                gain += (k % 2 == 0 ? by_side : by_corner) * row.beside(static_cast<std::int64_t>(c), k);
            }
        }
        return gain;
    }
    float creep_at(std::size_t i) const { return creep_rate_ * creep_weight(level_, i, offsets_); }

    /// Creep has fewer neighbours at the rim.
    void relax_at_rim(RowOfLevel const& row, std::size_t i, std::size_t c, float power, float& share) const {
        float gain = 0.0F;   // weighted heights of the neighbours
        float weight = 0.0F; // their weights
        for (std::size_t k = 0; k < offsets_.size(); ++k) {
            if (level_.type[moved(i, offsets_[k])] != CellType::outside) {
                float const of = k % 2 == 0 ? by_side : by_corner;
                gain += of * row.beside(static_cast<std::int64_t>(c), k);
                weight += of;
            }
        }
        float const cutting = power * row.erodibility[c] / length_[static_cast<std::size_t>(level_.direction[i])];
        float const part = 1.0F / (cutting + (creep_rate_ * weight + row.stiffness[c]));
        level_.z[i] = (row.uplift[c] + creep_rate_ * gain) * part;
        share = cutting * part;
    }

    /// The height of a bank, whose receiver is a river cell.
    float bank_height(RowOfLevel const& row, std::size_t i, std::size_t c, float share) const {
        auto const way = static_cast<std::size_t>(level_.direction[i]);
        auto const column = static_cast<std::int64_t>(c);
        float const most = std::min(level_.rock.cap(i) * length_[way], level_.bank_rise);
        float z = relaxed(level_.z[i], share, row.beside(column, way), most, level_.least * length_[way]);
        z = pull_.floor.empty() ? z : std::max(z, pull_.floor[i]);
        return above_rivers(row, i, c, z);
    }

    float above_rivers(RowOfLevel const& row, std::size_t i, std::size_t c, float z) const {
        float highest = -std::numeric_limits<float>::infinity();
        for (std::size_t k = 0; k < offsets_.size(); ++k) {
            if (level_.type[moved(i, offsets_[k])] == CellType::river) {
                highest = std::max(highest, row.beside(static_cast<std::int64_t>(c), k));
            }
        }
        return std::max(z, highest + level_.least * level_.side);
    }

    TerrainLevel& level_;
    LandLaw const& law_;
    Pull const& pull_;
    std::array<std::int64_t, 8> offsets_;
    std::array<float, 8> length_{};
    std::int64_t inner_; ///< cells of a row inside the frame
    float creep_rate_;
    std::vector<float> even_; ///< uplift
    std::vector<float> free_; ///< stiffness
};

/// Sets a cell from its receiver's new height.
template <class FloorOf> class Sweep {
public:
    Sweep(TerrainLevel& level, std::array<float, 8> const& length, FloorOf floor_of)
        : offsets_(level.offsets()), length_(length), z_(level.z.data()), share_(level.area.data()), rock_(level.rock),
          direction_(level.direction.data()), least_(level.least), floor_of_(floor_of) {}

    void operator()(std::size_t i) const {
        auto const way = static_cast<std::size_t>(direction_[i]);
        float const below = z_[moved(i, offsets_[way])];
        z_[i] = floor_of_(i, relaxed(z_[i], std::bit_cast<float>(share_[i]), below, rock_.cap(i) * length_[way],
                                     least_ * length_[way]));
    }

    /// Asks for what is read of a cell.
    void fetch(std::size_t i) const {
        __builtin_prefetch(z_ + i, 1);
        __builtin_prefetch(share_ + i);
        __builtin_prefetch(direction_ + i);
        rock_.fetch_cap(i);
    }

private:
    std::array<std::int64_t, 8> offsets_;
    std::array<float, 8> length_;
    float* z_;
    std::uint32_t const* share_; ///< bits of floats
    Rock const& rock_;
    std::int8_t const* direction_;
    float least_;
    FloorOf floor_of_;
};

/// The same in layers of rock.
class SweepInLayers {
public:
    SweepInLayers(TerrainLevel& level, std::array<float, 8> const& length, float creep_rate)
        : level_(level), offsets_(level.offsets()), length_(length), creep_rate_(creep_rate) {}

    void operator()(std::size_t i) const {
        auto const way = static_cast<std::size_t>(level_.direction[i]);
        std::size_t const next = moved(i, offsets_[way]);
        float& z = level_.z[i];
        z = height_in_layers(level_, i, next, z, std::bit_cast<float>(level_.area[i]),
                             creep_rate_ * creep_weight(level_, i, offsets_), length_[way], level_.z[next]);
    }

    /// Asks for what is read of a cell.
    void fetch(std::size_t i) const {
        __builtin_prefetch(&level_.z[i], 1);
        __builtin_prefetch(&level_.area[i]);
        __builtin_prefetch(&level_.direction[i]);
        __builtin_prefetch(&level_.strata.bed[i]);
        level_.rock.fetch_cap(i);
    }

private:
    TerrainLevel& level_;
    std::array<std::int64_t, 8> offsets_;
    std::array<float, 8> length_;
    float creep_rate_;
};

} // namespace

void set_steepest_receivers(TerrainLevel& level, Run const& run) {
    auto const offsets = level.offsets();
    auto* const steepest = widest_lanes() == Lanes::avx2 ? &avx2::steepest_row : &plain::steepest_row;
    std::int64_t const inner = level.width - 2;
    std::vector<std::int8_t> const beside_crests = directions_beside_crests(level);
    parallel_ranges(run, level.height - 2, least_rows(level.width), [&](std::int64_t begin, std::int64_t end) {
        std::array<std::vector<std::uint8_t>, 3> codes;
        codes.fill(std::vector<std::uint8_t>(static_cast<std::size_t>(level.width)));
        jitter_codes(level, begin, codes[1].data());
        jitter_codes(level, begin + 1, codes[2].data());
        for (std::int64_t row = begin + 1; row < end + 1; ++row) {
            std::rotate(codes.begin(), codes.begin() + 1, codes.end());
            jitter_codes(level, row + 1, codes[2].data());
            auto const first = static_cast<std::size_t>(row * level.width + 1);
            steepest(&level.z[first], {&codes[0][1], &codes[1][1], &codes[2][1]}, &level.type[first],
                     &level.direction[first], level.width, inner);
            for (std::size_t i = first; i < first + static_cast<std::size_t>(inner); ++i) {
                if (is_bank(level.type[i])) {
                    level.direction[i] = steepest_river(level, i, offsets);
                }
            }
        }
    });
    keep_off_crests(level, beside_crests);
}

void accumulate_areas(TerrainLevel& level, Run const& run, std::int64_t rows) {
    auto const offsets = level.offsets();
    auto* const donors = widest_lanes() == Lanes::avx2 ? &avx2::donors_row : &plain::donors_row;
    Cells<std::uint8_t> awaited(level.direction.size(), for_ever);
    level.area.resize(level.direction.size());
    std::fill(level.area.begin(), level.area.end(), 1U);
    for (Inflow const& in : level.inflow) {
        level.area[in.cell] += in.area;
    }
    each_inner_row(level, run, [&](std::size_t first) {
        donors(&level.direction[first], &awaited[first], level.width, level.width - 2);
    });
    std::int64_t const bands = band_count(level, rows, run);
    std::vector<std::vector<std::uint32_t>> leaving(static_cast<std::size_t>(bands));
    constexpr std::int64_t few = 1 << 19; // that a processor's cache holds with their order
    bool const keeps = bands == 1 && level.cells() < few;
    level.order.resize(keeps ? std::bit_ceil(level.direction.size() + 1) : 0);
    std::vector<std::size_t> followed(leaving.size());
    parallel_ranges(run, bands, 1, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t band = begin; band < end; ++band) {
            followed[band] = follow_in_band(level, band * level.height / bands, (band + 1) * level.height / bands,
                                            awaited, leaving[band]);
        }
    });
    level.order.resize(keeps ? followed.front() : 0);
    for (std::vector<std::uint32_t> const& cells : leaving) {
        for (std::uint32_t const from : cells) {
            std::uint32_t at = from;
            for (;;) {
                auto const next = static_cast<std::uint32_t>(moved(at, offsets[level.direction[at]]));
                level.area[next] += level.area[at];
                if (--awaited[next] != all_came) {
                    break;
                }
                at = next;
            }
        }
    }
}

void relax_terrain(TerrainLevel& level, LandLaw const& law, Pull const& pull, Run const& run) {
    Relaxer const relaxer(level, law, pull);
    relaxer.prepare(run);
    auto const sweep = [&](auto const& visit) {
        if (level.order.empty()) {
            each_upstream(level, CellType::rim, run, visit);
            return;
        }
        for (std::size_t n = level.order.size(); n-- > 0;) {
            if (std::uint32_t const i = level.order[n]; level.type[i] <= CellType::rim) {
                visit(i);
            }
        }
    };
    if (!level.strata.empty()) {
        sweep(SweepInLayers(level, relaxer.length(), relaxer.creep_rate()));
    } else if (pull.floor.empty()) {
        sweep(Sweep(level, relaxer.length(), [](std::size_t, float at) { return at; }));
    } else {
        sweep(Sweep(level, relaxer.length(), [&](std::size_t i, float at) { return std::max(at, pull.floor[i]); }));
    }
    level.order.clear();
}

Cells<std::uint8_t> donors_of(TerrainLevel const& level, CellType most, Run const& run) {
    auto* const donors = widest_lanes() == Lanes::avx2 ? &avx2::donor_bits_row : &plain::donor_bits_row;
    Cells<std::uint8_t> out(level.direction.size());
    each_inner_row(level, run, [&](std::size_t first) {
        donors(&level.direction[first], &level.type[first], most, &out[first], level.width, level.width - 2);
    });
    auto const drain = [&, offsets = level.offsets()](std::int64_t row, std::int64_t col) { // maybe to the frame
        auto const i = static_cast<std::size_t>(row * level.width + col);
        if (std::int8_t const way = level.direction[i]; level.type[i] <= most && way >= 0) {
            std::uint8_t& bits = out[moved(i, offsets[static_cast<std::size_t>(way)])];
            bits = static_cast<std::uint8_t>(bits | 1U << (way + 4) % 8);
        }
    };
    for (std::int64_t col = 1; col + 1 < level.width; ++col) {
        drain(1, col);
        drain(level.height - 2, col);
    }
    for (std::int64_t row = 1; row + 1 < level.height; ++row) {
        drain(row, 1);
        drain(row, level.width - 2);
    }
    return out;
}

double mean_slope_deg(TerrainLevel const& level, Run const& run) {
    auto* const slopes = widest_lanes() == Lanes::avx2 ? &avx2::slopes_of_row : &plain::slopes_of_row;
    struct Sum {
        double angles = 0.0;
        double count = 0.0;
    };
    std::vector<Sum> rows(static_cast<std::size_t>(level.height));
    each_inner_row(level, run, [&](std::size_t first) {
        std::vector<float> angles(static_cast<std::size_t>(level.width - 2));
        slopes(&level.z[first], angles.data(), 2.0F * level.side, level.width, std::ssize(angles));
        Sum& sum = rows[first / static_cast<std::size_t>(level.width)];
        for (std::size_t c = 0; c < angles.size(); ++c) {
            constexpr float steepest = 1.57F; // steeper beside the infinite heights of cells outside
            if (angles[c] < steepest) {
                sum.angles += static_cast<double>(angles[c]);
                sum.count += 1.0;
            }
        }
    });
    Sum all;
    for (Sum const& row : rows) {
        all.angles += row.angles;
        all.count += row.count;
    }
    return all.count > 0.0 ? all.angles / all.count * (180.0 / portable::pi) : 0.0;
}

void slide_terrain(TerrainLevel& level, Run const& run) {
    auto const offsets = level.offsets();
    auto* const slides = widest_lanes() == Lanes::avx2 ? &avx2::slides_row : &plain::slides_row;
    Cells<std::uint8_t> steep(level.z.size());
    each_inner_row(level, run, [&](std::size_t first) {
        if (!level.strata.empty()) {
            for (std::size_t i = first; i < first + static_cast<std::size_t>(level.width - 2); ++i) {
                steep[i] = is_land(level.type[i]) && is_steep_in_layer(level, i, offsets) ? 1 : 0;
            }
            return;
        }
        std::vector<float> caps(static_cast<std::size_t>(level.width - 2));
        level.rock.caps(first, caps);
        slides(&level.z[first], caps.data(), tolerance * level.side, &steep[first], level.width, level.width - 2);
    });
    std::vector<std::size_t> open;
    auto const slide = [&](std::size_t i) {
        if (is_land(level.type[i]) && !is_bank(level.type[i])) {
            if (float const most = greatest_height(level, i, offsets); most < level.z[i]) {
                level.z[i] = most;
                open.push_back(i);
            }
        }
    };
    for (std::size_t i = 0; i < steep.size(); ++i) {
        if (steep[i] != 0) {
            slide(i);
        }
    }
    for (std::size_t k = 0; k < open.size(); ++k) {
        for (std::int64_t const offset : offsets) {
            slide(moved(open[k], offset));
        }
    }
}

void valley_floors(TerrainLevel& level, FloorParams const& params, Run const& run) {
    std::vector<float> const widths = half_widths(level, params);
    std::vector<HeadStart> starts(widths.size());
    float longest = 0.0F;
    for (std::size_t n = 0; n < starts.size(); ++n) {
        float const reach = most_widening * foot_widths * widths[n];
        starts[n] = {level.rivers.cell[n], static_cast<std::uint32_t>(n), reach};
        longest = std::max(longest, reach);
    }
    std::sort(starts.begin(), starts.end(), [](HeadStart const& a, HeadStart const& b) { return a.cell < b.cell; });
    std::int64_t const beyond = static_cast<std::int64_t>(longest) + 2; // rows that a river reaches at most
    std::int64_t const rows = std::max<std::int64_t>(64, 2 * beyond);
    auto const factor = [&](std::size_t i, float distance, float width) {
        float const far = (distance / width + most_widening * foot_widths) / widening(level, i, params);
        float const up = std::clamp((far - 1.0F) / (foot_widths - 1.0F), 0.0F, 1.0F);
        return floor_share + (1.0F - floor_share) * up * up;
    };
    std::mutex setting;
    parallel_ranges(run, (level.height - 2 + rows - 1) / rows, 1, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t strip = begin; strip < end; ++strip) {
            std::int64_t const top = 1 + strip * rows;
            std::int64_t const bottom = std::min(level.height - 1, top + rows);
            std::int64_t const first = std::max<std::int64_t>(1, top - beyond);
            NearestRiver const near =
                nearest_in_rows(level, starts, first, std::min(level.height - 1, bottom + beyond));
            std::vector<std::pair<std::size_t, float>> lower; // cells and factors of their caps
            for (std::int64_t i = top * level.width; i < bottom * level.width; ++i) {
                auto const at = static_cast<std::size_t>(i - (first - 1) * level.width);
                if (near.distance[at] < 0.0F && is_land(level.type[i]) && widths[near.number[at]] >= least_width) {
                    float const by = factor(static_cast<std::size_t>(i), near.distance[at], widths[near.number[at]]);
                    if (by != 1.0F) {
                        lower.emplace_back(i, by);
                    }
                }
            }
            std::lock_guard const lock(setting);
            for (auto const& [cell, by] : lower) {
                level.rock.set_cap(cell, level.rock.cap(cell) * by);
            }
        }
    });
}

} // namespace thalweg::surface
