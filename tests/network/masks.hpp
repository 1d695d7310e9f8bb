// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include <support.hpp>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/raster.hpp>

/// Masks to thin and trace, drawn by hand or at random.
namespace test {

using namespace thalweg;

/// '#' is set; all rows of one length.
inline Mask mask_of(std::vector<std::string> const& rows) {
    Mask mask(
        frame(rows.empty() ? 0 : static_cast<std::int64_t>(rows[0].size()), static_cast<std::int64_t>(rows.size())));
    for (std::int64_t i = 0; i < mask.cells(); ++i) {
        Cell const c = mask.grid().at(i);
        mask[i] = rows[static_cast<std::size_t>(c.row)][static_cast<std::size_t>(c.col)] == '#' ? 1 : 0;
    }
    return mask;
}

inline std::vector<std::string> rows_of(Mask const& mask) {
    std::vector<std::string> rows(static_cast<std::size_t>(mask.height()));
    for (std::int64_t i = 0; i < mask.cells(); ++i) {
        rows[static_cast<std::size_t>(i / mask.width())] += mask[i] != 0 ? '#' : '.';
    }
    return rows;
}

/// Each cell set with the given probability.
inline Mask random_mask(std::uint64_t seed, std::int64_t width, std::int64_t height, double share) {
    Mask mask(frame(width, height));
    for (std::int64_t i = 0; i < mask.cells(); ++i) {
        mask[i] = unit(random_word(seed, 1, static_cast<std::uint64_t>(i))) < share ? 1 : 0;
    }
    return mask;
}

/// A few thick strokes from the middle and from one another: a branching blob with ragged edges, one component.
inline Mask random_blob(std::uint64_t seed, std::int64_t width, std::int64_t height, int strokes, int thickness) {
    Mask mask(frame(width, height));
    std::vector<Cell> on{{width / 2, height / 2}};
    RandomStream words(seed, 2, 0);
    auto const below = [&](std::int64_t n) {
        return static_cast<std::int64_t>(words.word() % static_cast<std::uint64_t>(n));
    };
    for (int s = 0; s < strokes; ++s) {
        Cell c = on[static_cast<std::size_t>(below(static_cast<std::int64_t>(on.size())))];
        std::int64_t dc = below(3) - 1;
        std::int64_t dr = below(3) - 1;
        for (std::int64_t k = below(width + height); k >= 0 && mask.grid().contains(c); --k) {
            for (std::int64_t r = c.row; r < c.row + thickness; ++r) {
                for (std::int64_t q = c.col; q < c.col + thickness; ++q) {
                    if (mask.grid().contains({q, r})) {
                        mask[Cell{q, r}] = 1;
                    }
                }
            }
            on.push_back(c);
            if (below(5) == 0) {
                dc = below(3) - 1;
                dr = below(3) - 1;
            }
            c = {c.col + dc, c.row + dr};
        }
    }
    return mask;
}

/// Labels from 1 of the components of the cells whose value is `value`, by 4 or 8 neighbours; 0 elsewhere.
inline Raster<std::int64_t> labels_of(Mask const& mask, int value, int neighbours) {
    Raster<std::int64_t> label(mask.grid(), 0);
    std::int64_t count = 0;
    for (std::int64_t i = 0; i < mask.cells(); ++i) {
        std::vector<std::int64_t> open{i};
        for (bool first = true; !open.empty(); first = false) {
            std::int64_t const at = open.back();
            open.pop_back();
            if ((mask[at] != 0 ? 1 : 0) != value || label[at] != 0) {
                continue;
            }
            label[at] = first ? ++count : count;
            Cell const c = mask.grid().at(at);
            cells_around(mask.grid(), c, 1, [&](Cell n) {
                if (neighbours == 8 || n.col == c.col || n.row == c.row) {
                    open.push_back(mask.grid().index(n));
                }
            });
        }
    }
    return label;
}

inline std::int64_t components(Mask const& mask, int value, int neighbours) {
    auto const label = labels_of(mask, value, neighbours);
    return mask.cells() == 0 ? 0 : *std::ranges::max_element(label.values());
}

} // namespace test
