// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/equilibrium/internal/widen.hpp>

#include <thalweg/surface/equilibrium/internal/way_between.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace thalweg::surface {

namespace {

// A straight rim of an open land reaches about so far; a whole number of cells of every level that has it.
constexpr std::int64_t open_margin = 32;

Grid grown(Grid grid, std::int64_t margin) {
    grid.width += 2 * margin;
    grid.height += 2 * margin;
    grid.west -= static_cast<double>(margin) * grid.cell_m;
    grid.north += static_cast<double>(margin) * grid.cell_m;
    return grid;
}

/// A raster that goes on beyond its border as it is there.
template <class T> Raster<T> grown(Raster<T> const& inner, std::int64_t margin) {
    if (inner.cells() == 0) {
        return {};
    }
    Raster<T> outer(grown(inner.grid(), margin));
    for (std::int64_t row = 0; row < outer.height(); ++row) {
        for (std::int64_t col = 0; col < outer.width(); ++col) {
            outer[Cell{col, row}] = inner[Cell{std::clamp<std::int64_t>(col - margin, 0, inner.width() - 1),
                                               std::clamp<std::int64_t>(row - margin, 0, inner.height() - 1)}];
        }
    }
    return outer;
}

/// The field over its mean on land, within what the solver can hold; NaN at sea.
Raster<float> relative(Raster<float> field, Mask const& land) {
    constexpr double most = 1e3;
    double sum = 0.0;
    double count = 0.0;
    auto const dry = [&](std::int64_t i) { return land.cells() == 0 || land[i] != 0; };
    for (std::int64_t i = 0; i < field.cells(); ++i) {
        if (dry(i)) {
            sum += static_cast<double>(field[i]);
            count += 1.0;
        }
    }
    for (std::int64_t i = 0; i < field.cells(); ++i) {
        field[i] = dry(i)
                       ? static_cast<float>(std::clamp(static_cast<double>(field[i]) / (sum / count), 1.0 / most, most))
                       : std::nanf("");
    }
    return field;
}

/// The step by which a border cell leaves the grid: to the north or south where it can.
Cell way_out(Grid const& grid, Cell c) {
    if (c.row == 0) {
        return {0, -1};
    }
    if (c.row == grid.height - 1) {
        return {0, 1};
    }
    return {c.col == 0 ? -1 : 1, 0};
}

class Carried {
public:
    Carried(Channels const& given, std::int64_t margin)
        : given_(given), margin_(margin), width_(given.grid.width + 2 * margin + 2) {}

    RiverCells all() {
        std::vector<std::int32_t> outside(given_.cell.size(), -1);
        for (std::size_t n = 0; n < given_.cell.size(); ++n) {
            Cell const c = given_.grid.at(given_.cell[n]);
            if (margin_ > 0 && given_.receiver[n] < 0 && given_.grid.on_border(c)) {
                outside[n] = lead_out(c);
            }
        }
        auto const first = static_cast<std::int64_t>(out_.cell.size());
        for (std::size_t n = 0; n < given_.cell.size(); ++n) {
            std::int64_t const r = given_.receiver[n];
            put(given_.grid.at(given_.cell[n]), r < 0 ? outside[n] : static_cast<std::int32_t>(r + first));
            out_.number.back() = static_cast<std::int64_t>(n);
            if (!given_.level.empty() && r >= 0) {
                out_.level.back() = given_.level[n];
            }
            if (!given_.z.empty()) {
                out_.asked.resize(out_.cell.size(), std::nanf(""));
                out_.asked.back() = given_.z[n];
            }
        }
        return std::move(out_);
    }

private:
    void put(Cell c, std::int32_t receiver) {
        auto const i = static_cast<std::size_t>((c.row + margin_ + 1) * width_ + c.col + margin_ + 1);
        out_.cell.push_back(static_cast<std::uint32_t>(i));
        out_.receiver.push_back(receiver);
        out_.way.push_back(receiver < 0 ? std::int8_t{-1}
                                        : way_between(i, out_.cell[static_cast<std::size_t>(receiver)], width_));
        out_.level.push_back(0);
        out_.number.push_back(-1);
    }

    /// Gives: the number of the cell just outside the border.
    std::int32_t lead_out(Cell c) {
        Cell const step = way_out(given_.grid, c);
        std::int32_t last = -1;
        for (std::int64_t far = margin_; far > 0; --far) {
            put({c.col + far * step.col, c.row + far * step.row}, last);
            last = static_cast<std::int32_t>(out_.cell.size()) - 1;
        }
        return last;
    }

    Channels const& given_;
    std::int64_t margin_;
    std::int64_t width_;
    RiverCells out_;
};

} // namespace

WidenedLand widened(Channels const& rivers, EquilibriumFields const& fields, EquilibriumParams const& params) {
    std::int64_t const margin = goes_on(params.edge) ? open_margin : 0;
    return {grown(rivers.grid, margin),
            margin,
            Carried(rivers, margin).all(),
            grown(fields.land, margin),
            {relative(fields.uplift, fields.land), relative(fields.erodibility, fields.land)}};
}

} // namespace thalweg::surface
