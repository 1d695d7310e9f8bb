// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/fractal/internal/refine.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <unordered_map>

#include <thalweg/core/numbers/elementary.hpp>

namespace thalweg::fractal {
namespace {

// Weights and deviations of one level, in the form that its points need.
class LevelWeights {
public:
    LevelWeights(Refinement const& refinement, int level) : refinement_(refinement), side_(std::ldexp(1.0, -level)) {
        if (!refinement.character.varies()) {
            simple_ = at_hurst(refinement.character.hurst);
            return;
        }
        for (int step = 0; step <= static_cast<int>(Character::steps_of_hurst); ++step) {
            // Estimates never approach 0 or 1, where the system is degenerate.
            bool const useful = step > 0 && step < static_cast<int>(Character::steps_of_hurst);
            by_step_.push_back(useful ? at_hurst(step / Character::steps_of_hurst) : Simple{});
        }
    }

    // For points that have all their neighbours.
    struct Simple {
        float middle = 0.0F;
        float farthest = 0.0F;
        std::array<double, 2> deviation{}; // in units of sigma, for centres and edges
    };
    // For a uniform H.
    Simple const& simple() const { return simple_; }
    // step: H in steps of Character::steps_of_hurst.
    Simple const& simple(float step) const { return by_step_[static_cast<std::size_t>(step)]; }

    // sigma r^H per sigma; r: distance of the nearest neighbours in coarse cells.
    double reach(double hurst, bool edge) const { return portable::pow(edge ? side_ : side_ * std::sqrt(2.0), hurst); }

private:
    Simple at_hurst(double hurst) const {
        StencilWeights const full = stencil_weights(refinement_.stencil, used_neighbours(refinement_.stencil), hurst);
        return {static_cast<float>(full.weight[4]),
                static_cast<float>(full.weight[12]),
                {full.deviation * reach(hurst, false), full.deviation * reach(hurst, true)}};
    }

    Refinement const& refinement_;
    double side_; // [coarse cells] of the finer lattice
    Simple simple_;
    std::vector<Simple> by_step_;
};

struct LocalCharacter {
    float step;  // H in steps of Character::steps_of_hurst
    float sigma; // [m] a coarse cell apart
};

// Bilinear between the coarse points; for local H and sigma.
LocalCharacter character_at(Refinement const& refinement, int level, std::int64_t col, std::int64_t row) {
    Character const& character = refinement.character;
    std::int64_t const width = refinement.coarse->width();
    std::int64_t const side = std::int64_t{1} << level;
    float const x = static_cast<float>(col & (side - 1)) / static_cast<float>(side);
    float const y = static_cast<float>(row & (side - 1)) / static_cast<float>(side);
    std::int64_t const north_west = (row >> level) * width + (col >> level);
    std::int64_t const east = x > 0.0F ? 1 : 0;
    std::int64_t const south = y > 0.0F ? width : 0;
    auto const between = [&](std::vector<float> const& of) {
        float const north_z = of[north_west] + x * (of[north_west + east] - of[north_west]);
        float const south_z = of[north_west + south] + x * (of[north_west + south + east] - of[north_west + south]);
        return north_z + y * (south_z - north_z);
    };
    return {std::floor(between(character.steps) + 0.5F), between(character.sigmas)};
}

// Whether all coarse cells nearest to a point are holes.
bool in_hole(Refinement const& refinement, int level, std::int64_t col, std::int64_t row) {
    std::int64_t const side = std::int64_t{1} << level;
    for (std::int64_t const r : {(row + side / 2 - 1) / side, (row + side / 2) / side}) {
        for (std::int64_t const c : {(col + side / 2 - 1) / side, (col + side / 2) / side}) {
            if (!std::isnan((*refinement.coarse)[Cell{c, r}])) {
                return false;
            }
        }
    }
    return true;
}

constexpr float no_height = std::numeric_limits<float>::quiet_NaN();

/// New points of a row with the same arrangement of neighbours: neighbour k of point i is neighbours[k][i].
struct Points {
    float const* neighbours[16] = {};
    float const* noise = nullptr;
    float const* weight_middle = nullptr;
    float const* weight_farthest = nullptr;
    float const* deviation = nullptr; ///< [m]
    float* out = nullptr;
    float const* others = nullptr; ///< in a woven row: the points between the new ones
    std::int64_t odd = 0;          ///< in a woven row: 1: the points have the odd columns
    bool stream = false;           ///< in a woven row: whether stores bypass the cache
};

#define THALWEG_KERNELS <thalweg/fractal/internal/refine_lanes.inc>
#include <thalweg/core/run/lanes.inc>

using MakePoints = void (*)(Points const&, std::int64_t, std::int64_t);

/// The same kernel for points in a row of their own and for points woven into a row.
struct Makers {
    MakePoints alone;
    MakePoints woven;
};

template <int neighbours, bool varied> Makers makers(Lanes lanes) {
    return lanes == Lanes::avx2
               ? Makers{&avx2::make_points<neighbours, varied>, &avx2::weave_points<neighbours, varied>}
               : Makers{&plain::make_points<neighbours, varied>, &plain::weave_points<neighbours, varied>};
}

template <bool varied> Makers makers(Stencil stencil, Lanes lanes) {
    switch (stencil) {
    case Stencil::sixteen: return makers<16, varied>(lanes);
    case Stencil::twelve: return makers<12, varied>(lanes);
    default: return makers<4, varied>(lanes);
    }
}

/// A level: the points stored of it, and their total number.
struct Lattice {
    float* z = nullptr;
    std::int64_t stride = 0;
    std::int64_t cols = 0;
    std::int64_t rows = 0;
    std::int64_t all_cols = 0;
    std::int64_t all_rows = 0;
    float const* row(std::int64_t r) const { return z + r * stride; }
};

/// Number of points of the coarser level that a stencil of sixteen needs for the first `kept` points.
std::int64_t kept_above(std::int64_t kept, std::int64_t all) {
    return std::min(all, (kept - 1) / 2 + 4);
}

/// The points of one level made by one worker: a band of rows, with a window of four rows of centres.
class Band {
public:
    Band(Refinement const& refinement, LevelWeights const& weights, Lattice const& from, Lattice const& to, int level)
        : refinement_(refinement), weights_(weights), from_(from), to_(to), level_(level),
          centres_(std::min(from.all_cols - 1, (to.cols - 1) / 2 + 2)), noise_(chunk), spare_(noise_.size()),
          used_(used_neighbours(refinement.stencil)) {
        for (std::vector<float>& row : window_) {
            row.resize(static_cast<std::size_t>(std::max<std::int64_t>(centres_, 1)));
        }
        varies_ = refinement.character.varies();
        make_ = varies_ ? makers<true>(refinement.stencil, refinement.lanes)
                        : makers<false>(refinement.stencil, refinement.lanes);
        reach_ = {weights.reach(refinement.character.hurst, false), weights.reach(refinement.character.hurst, true)};
        for (std::vector<float>& row : factors_) {
            row.resize(static_cast<std::size_t>(varies_ ? chunk : 1));
        }
        stream_ = level == refinement.levels && to.cols * to.rows >= least_streamed;
        rim_ = used_ == used_neighbours(Stencil::four) ? 0 : 1;
    }

    /// Makes rows 2 i and 2 i + 1 for i in [first, last).
    void make_rows(std::int64_t first, std::int64_t last) {
        for (std::int64_t k = first - 2; k <= first; ++k) {
            make_centres(k);
        }
        for (std::int64_t i = first; i < last; ++i) {
            make_centres(i + 1);
            make_even_row(i);
            if (2 * i + 1 < to_.rows) {
                make_odd_row(i);
            }
        }
#ifdef __x86_64__
        __builtin_ia32_sfence(); // makes stores that bypass the cache visible to other threads
#endif
    }

private:
    static constexpr std::int64_t chunk = 1024;
    static constexpr std::int64_t least_streamed = std::int64_t{1} << 22; ///< [points] more than caches hold

    /// Points of one kind in a row of the finer lattice: columns 2 i + odd.
    struct Kind {
        std::int64_t row;
        std::int64_t odd;
        bool edge;
        std::array<Offset, 16> const& around;
    };

    float* window(std::int64_t k) { return window_[k & 3].data(); }
    float const* window(std::int64_t k) const { return window_[k & 3].data(); }
    bool has_centres(std::int64_t k) const { return k >= 0 && k < from_.all_rows - 1; }

    /// Destination of points: a row of their own, or between others.
    struct Target {
        float* out;
        float const* others; ///< null: a row of their own
        std::int64_t length; ///< of a woven row
    };

    void make_centres(std::int64_t k) {
        if (has_centres(k)) {
            bool const inner = k >= rim_ && k + 1 + rim_ < from_.all_rows;
            make_kind({2 * k + 1, 1, false, around_centre}, inner, rim_, centres_, {window(k), nullptr, 0});
        }
    }

    void make_even_row(std::int64_t i) {
        bool const inner = i >= 1 + rim_ && i + 1 + rim_ < from_.all_rows;
        make_kind({2 * i, 1, true, around_edge}, inner, rim_, to_.cols / 2,
                  {to_.z + 2 * i * to_.stride, from_.row(i), to_.cols});
    }

    void make_odd_row(std::int64_t i) {
        bool const inner = i >= rim_ && i + 1 + rim_ < from_.all_rows;
        make_kind({2 * i + 1, 0, true, around_edge}, inner, 1 + rim_, (to_.cols + 1) / 2,
                  {to_.z + (2 * i + 1) * to_.stride, window(i), to_.cols});
    }

    /// Makes `count` points of a row. In an inner row the points from column west on, except the lattice's last ones,
    /// have all their neighbours.
    void make_kind(Kind const& kind, bool inner, std::int64_t west, std::int64_t count, Target const& target) {
        NoisePlace const place{refinement_.seed, level_, kind.row, kind.odd};
        bool const woven = target.others != nullptr;
        std::int64_t const east = inner ? from_.all_cols - 1 - rim_ : 0;
        Points points;
        if (inner) {
            point_at_neighbours(kind, points);
        }
        for (std::int64_t begin = 0; begin < count; begin += chunk) {
            std::int64_t const end = std::min(count, begin + chunk);
            std::int64_t const wanted = (end - begin + noise_batch - 1) / noise_batch * noise_batch;
            noise_row(refinement_.noise, place, begin, std::span(noise_).first(static_cast<std::size_t>(wanted)),
                      refinement_.lanes);
            std::int64_t const whole_begin = std::clamp(west, begin, end);
            std::int64_t const whole_end = std::clamp(east, whole_begin, end);
            if (whole_begin < whole_end) {
                set_factors(kind, begin, end);
                make_whole(points, target, kind.odd, begin, whole_begin, whole_end);
            }
            make_rest(kind, target, begin, begin, whole_begin, false);
            make_rest(kind, target, begin, whole_end, end, false);
            if (refinement_.holes) {
                make_rest(kind, target, begin, whole_begin, whole_end, true);
            }
        }
        if (woven && count < (target.length + 1) / 2) { // the last column is one of the existing ones
            target.out[target.length - 1] = target.others[count];
        }
    }

    void make_whole(Points points, Target const& target, std::int64_t odd, std::int64_t begin, std::int64_t first,
                    std::int64_t last) {
        for (float const*& from : points.neighbours) {
            from = from == nullptr ? nullptr : from + begin;
        }
        points.noise = noise_.data();
        points.weight_middle = factors_[0].data();
        points.weight_farthest = factors_[1].data();
        points.deviation = factors_[2].data();
        if (target.others == nullptr) {
            points.out = target.out + begin;
            make_.alone(points, first - begin, last - begin);
        } else {
            points.out = target.out + 2 * begin;
            points.others = target.others + begin;
            points.odd = odd;
            points.stream = stream_;
            // The last point of an odd row has no partner: the same arithmetic, separately.
            std::int64_t const pairs = std::min(last, target.length / 2);
            make_.woven(points, first - begin, pairs - begin);
            if (pairs < last) {
                points.out = spare_.data();
                make_.alone(points, pairs - begin, last - begin);
                target.out[2 * pairs] = spare_[pairs - begin];
            }
        }
    }

    /// Makes the points [first, last) that lack neighbours; only_holes: only those of them that are NaN.
    void make_rest(Kind const& kind, Target const& target, std::int64_t begin, std::int64_t first, std::int64_t last,
                   bool only_holes) {
        for (std::int64_t i = first; i < last; ++i) {
            float& z = target.others == nullptr ? target.out[i] : target.out[2 * i + kind.odd];
            if (!only_holes || std::isnan(z)) {
                z = make_one(kind, i, noise_[i - begin]);
            }
            std::int64_t const other = 2 * i + 1 - kind.odd;
            if (target.others != nullptr && other < target.length) {
                target.out[other] = target.others[i];
            }
        }
    }

    void point_at_neighbours(Kind const& kind, Points& points) const {
        for (std::size_t n = 0; n < 16; ++n) {
            if ((used_ >> n & 1U) == 0) {
                continue;
            }
            std::int64_t const row = kind.row + kind.around[n].row;
            std::int64_t const col = kind.odd + kind.around[n].col; // of point 0; may lie west of the lattice
            points.neighbours[n] = row % 2 == 0 ? from_.row(row / 2) + col / 2 : window(row / 2) + (col - 1) / 2;
        }
    }

    void set_factors(Kind const& kind, std::int64_t begin, std::int64_t end) {
        std::size_t const edge = kind.edge ? 1 : 0;
        if (!varies_) {
            LevelWeights::Simple const& simple = weights_.simple();
            factors_[0][0] = simple.middle;
            factors_[1][0] = simple.farthest;
            factors_[2][0] = static_cast<float>(refinement_.character.sigma * simple.deviation[edge]);
            return;
        }
        for (std::int64_t i = begin; i < end; ++i) {
            // A centre may represent its east and south beyond the result: the coarse raster continues there.
            LocalCharacter const here = character_at(refinement_, level_, 2 * i + kind.odd, kind.row);
            LevelWeights::Simple const& simple = weights_.simple(here.step);
            std::int64_t const at = i - begin;
            factors_[0][at] = simple.middle;
            factors_[1][at] = simple.farthest;
            factors_[2][at] = static_cast<float>(static_cast<double>(here.sigma) * simple.deviation[edge]);
        }
    }

    /// Height of a neighbour; NaN: beyond the lattice.
    float height_at(std::int64_t col, std::int64_t row) const {
        if (col < 0 || row < 0 || col > 2 * (from_.all_cols - 1) || row > 2 * (from_.all_rows - 1)) {
            return no_height;
        }
        return row % 2 == 0 ? from_.row(row / 2)[col / 2] : window(row / 2)[col / 2];
    }

    /// A point with missing neighbours.
    float make_one(Kind const& kind, std::int64_t i, float noise) {
        std::int64_t const col = 2 * i + kind.odd;
        if (refinement_.holes && in_hole(refinement_, level_, col, kind.row)) {
            return no_height;
        }
        std::array<double, 16> heights{};
        std::uint32_t known = 0;
        double base = 0.0;
        for (std::size_t n = 0; n < 16; ++n) {
            if ((used_ >> n & 1U) == 0) {
                continue;
            }
            float const z = height_at(col + kind.around[n].col, kind.row + kind.around[n].row);
            if (!std::isnan(z)) {
                base = known == 0 ? static_cast<double>(z) : base;
                known |= 1U << n;
                heights[n] = static_cast<double>(z) - base;
            }
        }
        double hurst = refinement_.character.hurst;
        double sigma = refinement_.character.sigma;
        float step = 0.0F;
        if (varies_) {
            LocalCharacter const here = character_at(refinement_, level_, col, kind.row);
            step = here.step;
            hurst = static_cast<double>(here.step) / Character::steps_of_hurst;
            sigma = static_cast<double>(here.sigma);
        }
        StencilWeights const& weights = weights_for(known, step, hurst);
        double above = 0.0;
        for (std::size_t n = 0; n < 16; ++n) {
            above += weights.weight[n] * heights[n];
        }
        double const reach = varies_ ? weights_.reach(hurst, kind.edge) : reach_[kind.edge ? 1 : 0];
        double const deviation = sigma * reach * weights.deviation;
        return static_cast<float>(base + above + deviation * static_cast<double>(noise));
    }

    StencilWeights const& weights_for(std::uint32_t known, float step, double hurst) {
        std::uint32_t const key = known | static_cast<std::uint32_t>(step) << 16U;
        auto const found = solved_.find(key);
        return found != solved_.end()
                   ? found->second
                   : solved_.emplace(key, stencil_weights(refinement_.stencil, known, hurst)).first->second;
    }

    Refinement const& refinement_;
    LevelWeights const& weights_;
    Lattice const& from_;
    Lattice const& to_;
    int level_;
    std::int64_t centres_; ///< in a row
    std::array<std::vector<float>, 4> window_;
    std::vector<float> noise_;
    std::vector<float> spare_;
    std::array<std::vector<float>, 3> factors_;
    std::uint32_t used_;
    std::int64_t rim_ = 0; ///< rows and columns at each border whose points lack neighbours
    Makers make_{};
    bool varies_ = false;
    bool stream_ = false;
    std::array<double, 2> reach_{}; ///< of centres and of edges, for a uniform H
    std::unordered_map<std::uint32_t, StencilWeights> solved_;
};

void make_level(Refinement const& refinement, Lattice const& from, Lattice const& to, int level, Run const& run) {
    LevelWeights const weights(refinement, level);
    parallel_ranges(run, (to.rows + 1) / 2, 64, [&](std::int64_t first, std::int64_t last) {
        Band band(refinement, weights, from, to, level);
        for (std::int64_t i = first; i < last; i += 256) {
            run.check();
            band.make_rows(i, std::min(last, i + 256));
        }
    });
}

/// The lattices of all levels, each as far as the next finer one needs it, in the result, the floors and the coarse
/// raster.
std::vector<Lattice> plan_lattices(Refinement const& refinement, Raster<float>& dem, Floors& floors) {
    Raster<float> const& coarse = *refinement.coarse;
    std::vector<Lattice> lattices(refinement.levels + 1);
    auto const floor_of = [&](int level) -> Floor& { return level % 2 == 1 ? floors.odd : floors.even; };
    std::int64_t cols = dem.width();
    std::int64_t rows = dem.height();
    for (int level = refinement.levels; level >= 0; --level) {
        Lattice& lattice = lattices[level];
        lattice.all_cols = ((coarse.width() - 1) << level) + 1;
        lattice.all_rows = ((coarse.height() - 1) << level) + 1;
        if (level < refinement.levels) {
            cols = kept_above(cols, lattice.all_cols);
            rows = kept_above(rows, lattice.all_rows);
        }
        lattice.cols = cols;
        lattice.rows = rows;
        lattice.stride = cols;
        if (level > 0 && level < refinement.levels) {
            Floor& floor = floor_of(level);
            floor.resize(std::max(floor.size(), static_cast<std::size_t>(cols * rows)));
        }
    }
    // At the end, since for a small result a coarser level may be the larger one.
    for (int level = 1; level < refinement.levels; ++level) {
        lattices[level].z = floor_of(level).data();
    }
    lattices.back().z = dem.values().data();
    lattices.front().z = const_cast<float*>(coarse.values().data()); // only read, never written
    lattices.front().stride = coarse.width();
    return lattices;
}

} // namespace

void refine(Refinement const& refinement, Raster<float>& dem, Floors& floors, Run const& run) {
    std::vector<Lattice> const lattices = plan_lattices(refinement, dem, floors);
    double const points = static_cast<double>(dem.cells());
    for (std::size_t level = 1; level < lattices.size(); ++level) {
        make_level(refinement, lattices[level - 1], lattices[level], static_cast<int>(level), run);
        run.at(std::min(1.0, static_cast<double>(lattices[level].cols * lattices[level].rows) / points), "midpoint");
    }
}

} // namespace thalweg::fractal
