// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/relief/geomorphons.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/sums.hpp>
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

/// The lines of sight from one row of cells.
class LineOfSightRow {
public:
    LineOfSightRow(Raster<float> const& dem, GeomorphonParams const& params)
        : dem_(dem), first_(params.search_cells), beyond_(dem.width() - params.search_cells), skip_(params.skip_cells),
          up_(dem.width()), down_(up_.size()), rise_(up_.size()), fall_(up_.size()) {}

    void look(std::int64_t row, std::array<Sight, 8> const& all, std::span<std::uint8_t> form) {
        std::fill(rise_.begin(), rise_.end(), std::uint8_t{0});
        std::fill(fall_.begin(), fall_.end(), std::uint8_t{0});
        for (Sight const& sight : all) {
            steepest(row, sight);
            count(row, sight);
        }
        float const* const here = dem_.row(row).data();
        std::uint8_t* const out = form.data();
        for (std::int64_t c = first_; c < beyond_; ++c) {
            out[c] = std::isnan(here[c]) ? std::uint8_t{0} : static_cast<std::uint8_t>(forms[fall_[c]][rise_[c]]);
        }
    }

private:
    /// Slopes in metres per step; the length of a step enters only the comparison with the flatness threshold, so that
    /// equally steep lines of sight have equal numbers.
    void steepest(std::int64_t row, Sight const& sight) {
        constexpr double unseen = std::numeric_limits<double>::infinity();
        std::fill(up_.begin(), up_.end(), -unseen);
        std::fill(down_.begin(), down_.end(), unseen);
        float const* const here = dem_.row(row).data();
        double* const up = up_.data();
        double* const down = down_.data();
        for (std::int64_t n = skip_ + 1; n <= sight.cells; ++n) {
            float const* const there = dem_.row(row + n * sight.step.row).data();
            std::int64_t const aside = n * sight.step.col;
            auto const steps = static_cast<double>(n);
            for (std::int64_t c = first_; c < beyond_; ++c) {
                double const rise = (static_cast<double>(there[c + aside]) - static_cast<double>(here[c])) / steps;
                up[c] = rise > up[c] ? rise : up[c]; // never towards NaN
                down[c] = rise < down[c] ? rise : down[c];
            }
        }
    }

    void count(std::int64_t row, Sight const& sight) {
        float const* const next = dem_.row(row + sight.step.row).data() + sight.step.col;
        for (std::int64_t c = first_; c < beyond_; ++c) {
            double const up = std::fabs(up_[c]);
            double const down = std::fabs(down_[c]);
            bool const seen = !std::isnan(next[c]) && (up > sight.level || down > sight.level);
            rise_[c] = static_cast<std::uint8_t>(rise_[c] + (seen && up > down ? 1 : 0));
            fall_[c] = static_cast<std::uint8_t>(fall_[c] + (seen && down > up ? 1 : 0));
        }
    }

    Raster<float> const& dem_;
    std::int64_t first_;
    std::int64_t beyond_;
    std::int64_t skip_;
    std::vector<double> up_;
    std::vector<double> down_;
    std::vector<std::uint8_t> rise_;
    std::vector<std::uint8_t> fall_;
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
    auto const all = sights(params, dem.grid().cell_m);
    parallel_ranges(run, rows, rows_a_range, [&](std::int64_t begin, std::int64_t end) {
        LineOfSightRow lookers(dem, params);
        for (std::int64_t r = begin + params.search_cells; r < end + params.search_cells; ++r) {
            run.check();
            lookers.look(r, all, found.form.row(r));
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
        std::int64_t const first = (r + 1) * dem.width();
        for (std::int64_t i = first + 1; i < first + dem.width() - 1; ++i) {
            int higher = 0;
            int lower = 0;
            bool whole = !std::isnan(dem[i]);
            for (std::int64_t const step : offsets) {
                float const z = dem[i + step];
                higher += z > dem[i] ? 1 : 0;
                lower += z < dem[i] ? 1 : 0;
                whole = whole && !std::isnan(z);
            }
            if (whole) {
                ++row.cells;
                row.pits += higher == 8 ? 1 : 0;
                row.peaks += lower == 8 ? 1 : 0;
            }
        }
        return row;
    });
}

} // namespace thalweg::measure
