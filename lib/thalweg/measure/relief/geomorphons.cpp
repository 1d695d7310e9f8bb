// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/relief/geomorphons.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <vector>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/sums.hpp>
#include <thalweg/core/run/lanes.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>

namespace thalweg::measure {
namespace {

constexpr std::int64_t rows_a_range = 16;

using enum Form;
using FormsOfRise = std::array<Form, 9>;

/// By number of falling directions, then of rising ones; at most eight in all.
constexpr std::array<FormsOfRise, 9> forms = {{
    {flat, flat, flat, footslope, footslope, valley, valley, valley, pit},
    {flat, flat, footslope, footslope, footslope, valley, valley, valley, none},
    {flat, shoulder, slope, slope, hollow, hollow, valley, none, none},
    {shoulder, shoulder, slope, slope, slope, hollow, none, none, none},
    {shoulder, shoulder, spur, slope, slope, none, none, none, none},
    {ridge, ridge, spur, spur, none, none, none, none, none},
    {ridge, ridge, ridge, none, none, none, none, none, none},
    {ridge, ridge, none, none, none, none, none, none, none},
    {peak, none, none, none, none, none, none, none, none},
}};

struct Sight {
    Cell step;
    std::int64_t cells; ///< number of steps to the farthest cell
    double level;       ///< [m] per step: gentler slopes are level
};

std::array<Sight, 8> sights(GeomorphonParams const& params, double cell_m) {
    double const angle = params.flat_deg * (portable::pi / 180.0);
    double const tangent = portable::sin(angle) / portable::cos(angle);
    auto const search = params.search_cells;
    std::array<Sight, 8> all{};
    for (std::size_t k = 0; k < all.size(); ++k) {
        Cell const step = d8_steps[k];
        std::int64_t const squared = step.col * step.col + step.row * step.row;
        std::int64_t cells = 0;
        while ((cells + 1) * (cells + 1) * squared < search * search) {
            ++cells;
        }
        all[k] = {step, cells, tangent * cell_m * std::sqrt(static_cast<double>(squared))};
    }
    return all;
}

/// A line of sight as kernels take it, in the digits of floats.
struct SightSteps {
    std::int64_t next = 0;            ///< offset of its first cell
    std::vector<std::int64_t> offset; ///< of those looked at
    std::vector<float> per_step;      ///< [-] 1 / number of steps
    float surely_steep = 0.0F;        ///< [m] per step
    float surely_level = 0.0F;
};

// A slope in floats is within 2^-22 of itself: a difference and a quotient each round, and so does 1 / steps. What
// differs by more is known; the rest, and what overflows, is computed anew in doubles.
constexpr float clearly = 1.0F + 0x1p-20F;
constexpr double smallest_level = 1e-30; // below, floats lose digits

// One count holds three, each at most 8.
constexpr std::int32_t one_fall = 1 << 4;
constexpr std::int32_t one_unsure = 1 << 8;

std::vector<SightSteps> steps_of(std::array<Sight, 8> const& all, std::int64_t skip, std::int64_t width) {
    std::vector<SightSteps> found(all.size());
    for (std::size_t k = 0; k < all.size(); ++k) {
        Sight const& sight = all[k];
        found[k].next = sight.step.row * width + sight.step.col;
        for (std::int64_t n = skip + 1; n <= sight.cells; ++n) {
            found[k].offset.push_back(n * found[k].next);
            found[k].per_step.push_back(1.0F / static_cast<float>(n));
        }
        if (sight.level > smallest_level) {
            found[k].surely_steep = static_cast<float>(sight.level) * clearly;
            found[k].surely_level = static_cast<float>(sight.level) * (2.0F - clearly);
        } else {
            found[k].surely_steep = std::numeric_limits<float>::infinity();
        }
    }
    return found;
}

#define THALWEG_KERNELS <thalweg/measure/relief/internal/sight_lanes.inc>
#include <thalweg/core/run/lanes.inc>

/// The lines of sight from rows of cells.
class Lookout {
public:
    Lookout(Raster<float> const& dem, GeomorphonParams const& params)
        : dem_(dem), params_(params), all_(sights(params, dem.grid().cell_m)),
          steps_(steps_of(all_, params.skip_cells, dem.width())),
          count_sights_(widest_lanes() == Lanes::avx2 ? &avx2::count_sights : &plain::count_sights) {}

    /// \param counts room for a row
    void look(std::int64_t row, std::vector<std::int32_t>& counts, std::span<std::uint8_t> form) const {
        std::int64_t const first = params_.search_cells;
        std::int64_t const beyond = dem_.width() - params_.search_cells;
        float const* const here = dem_.row(row).data();
        bool const is_wide = beyond - first >= 8;
        if (is_wide) {
            count_sights_(here + first, steps_, counts.data() + first, beyond - first);
        }
        for (std::int64_t c = first; c < beyond; ++c) {
            if (std::isnan(here[c])) {
                continue;
            }
            std::int32_t const known = is_wide && counts[c] < one_unsure ? counts[c] : exact_count({c, row});
            form[c] = static_cast<std::uint8_t>(forms[known / one_fall][known % one_fall]);
        }
    }

private:
    /// As count_sights, without doubt. Slopes are in metres per step; the length of a step enters only the comparison
    /// with the flatness threshold, so that equally steep lines of sight have equal numbers.
    std::int32_t exact_count(Cell at) const {
        constexpr double unseen = std::numeric_limits<double>::infinity();
        auto const here = static_cast<double>(dem_[at]);
        std::int32_t count = 0;
        for (Sight const& sight : all_) {
            double up = -unseen;
            double down = unseen;
            for (std::int64_t n = params_.skip_cells + 1; n <= sight.cells; ++n) {
                Cell const there{at.col + n * sight.step.col, at.row + n * sight.step.row};
                double const rise = (static_cast<double>(dem_[there]) - here) / static_cast<double>(n);
                up = rise > up ? rise : up; // never towards NaN
                down = rise < down ? rise : down;
            }
            up = std::fabs(up);
            down = std::fabs(down);
            Cell const next{at.col + sight.step.col, at.row + sight.step.row};
            if (!std::isnan(dem_[next]) && (up > sight.level || down > sight.level)) {
                count += (up > down ? 1 : 0) + (down > up ? one_fall : 0);
            }
        }
        return count;
    }

    Raster<float> const& dem_;
    GeomorphonParams const& params_;
    std::array<Sight, 8> all_;
    std::vector<SightSteps> steps_;
    void (*count_sights_)(float const*, std::vector<SightSteps> const&, std::int32_t*, std::int64_t);
};

void check(GeomorphonParams const& params, Grid const& grid) {
    constexpr char const* self = "measure.geomorphons";
    require_in(self, "search_cells", params.search_cells, Range::between(2, 10000));
    require_in(self, "skip_cells", params.skip_cells, Range::between(0, static_cast<double>(params.search_cells - 1)));
    require_in(self, "flat_deg", params.flat_deg, Range::inside(0.0, 45.0));
    refuse_if<BadInput>(grid.cells() > 0 && !(grid.cell_m > 0.0), "measure.geomorphons",
                        "the DEM's cells have a side of {} m; it must be greater than 0", grid.cell_m);
}

struct RowOfExtremes : LocalExtremes {
    RowOfExtremes& operator+=(RowOfExtremes const& more) {
        pits += more.pits;
        peaks += more.peaks;
        cells += more.cells;
        return *this;
    }
};

} // namespace

Geomorphons geomorphons(Raster<float> const& dem, GeomorphonParams const& params, Run const& run) {
    check(params, dem.grid());
    Geomorphons found{Raster<std::uint8_t>(dem.grid())};
    std::int64_t const rows = dem.height() - 2 * params.search_cells;
    if (rows <= 0 || dem.width() <= 2 * params.search_cells) {
        return found;
    }
    Lookout const lookout(dem, params);
    parallel_ranges(run, rows, rows_a_range, [&](std::int64_t begin, std::int64_t end) {
        std::vector<std::int32_t> counts(dem.width());
        for (std::int64_t r = begin + params.search_cells; r < end + params.search_cells; ++r) {
            run.check();
            lookout.look(r, counts, found.form.row(r));
        }
    });
    std::int64_t formed = 0;
    for (std::uint8_t const form : found.form.values()) {
        if (form > 0) {
            ++found.cells[form - 1U];
            ++formed;
        }
    }
    for (std::size_t f = 0; f < form_count && formed > 0; ++f) {
        found.shares[f] = static_cast<double>(found.cells[f]) / static_cast<double>(formed);
    }
    return found;
}

LocalExtremes local_extremes(Raster<float> const& dem, Run const& run) {
    auto const offsets = d8_offsets(dem.grid());
    return sum_rows(run, std::max<std::int64_t>(dem.height() - 2, 0), [&](std::int64_t r) {
        run.check();
        RowOfExtremes row;
        float const* const here = dem.row(r + 1).data();
        std::array<float const*, 8> around{};
        std::ranges::transform(offsets, around.begin(), [&](std::int64_t step) { return here + step; });
        std::int32_t cells = 0;
        std::int32_t pits = 0;
        std::int32_t peaks = 0;
        for (std::int64_t c = 1; c < dem.width() - 1; ++c) {
            float const z = here[c];
            std::int32_t higher = 0;
            std::int32_t lower = 0;
            std::int32_t known = 0;
            for (float const* const there : around) {
                higher += there[c] > z ? 1 : 0;
                lower += there[c] < z ? 1 : 0;
                known += std::isunordered(there[c], z) ? 0 : 1;
            }
            cells += known == 8 ? 1 : 0;
            pits += higher == 8 ? 1 : 0;
            peaks += lower == 8 ? 1 : 0;
        }
        row.cells = cells;
        row.pits = pits;
        row.peaks = peaks;
        return row;
    });
}

} // namespace thalweg::measure
