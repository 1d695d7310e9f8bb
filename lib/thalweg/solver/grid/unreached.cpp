// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/grid/unreached.hpp>

#include <algorithm>
#include <cstddef>

namespace thalweg::solver {
namespace {

/// Spans of cells that are not outside, joined to parts; the root of a part knows whether it has a fixed cell.
struct Parts {
    std::vector<CellSpan> spans;
    std::vector<std::size_t> parent;
    std::vector<std::uint8_t> has_fixed;

    std::size_t root(std::size_t i) {
        while (parent[i] != i) {
            parent[i] = parent[parent[i]];
            i = parent[i];
        }
        return i;
    }
    void join(std::size_t a, std::size_t b) {
        a = root(a);
        b = root(b);
        parent[std::max(a, b)] = std::min(a, b);
        has_fixed[std::min(a, b)] |= has_fixed[std::max(a, b)];
    }
};

void add_spans(Raster<std::uint8_t> const& kind, std::int64_t row, Parts& parts) {
    auto const cells = kind.row(row);
    auto const past = cells.end();
    for (auto at = cells.begin(); at != past;) {
        auto const begin = std::find_if(at, past, [](std::uint8_t k) { return k != outside_cell; });
        at = std::find(begin, past, outside_cell);
        if (begin != at) {
            parts.parent.push_back(parts.spans.size());
            parts.spans.push_back({row, begin - cells.begin(), at - cells.begin()});
            parts.has_fixed.push_back(std::find(begin, at, fixed_cell) != at ? 1 : 0);
        }
    }
}

} // namespace

std::vector<CellSpan> unreached(Raster<std::uint8_t> const& kind, Run const& run) {
    Parts parts;
    std::size_t above = 0; // first span of the row above
    for (std::int64_t row = 0; row < kind.height(); ++row) {
        if (row % 512 == 0) {
            run.check();
        }
        std::size_t const here = parts.spans.size();
        add_spans(kind, row, parts);
        for (std::size_t a = above, b = here; a < here && b < parts.spans.size();) {
            if (parts.spans[a].begin < parts.spans[b].end && parts.spans[b].begin < parts.spans[a].end) {
                parts.join(a, b);
            }
            ++(parts.spans[a].end < parts.spans[b].end ? a : b);
        }
        above = here;
    }
    std::vector<CellSpan> found;
    for (std::size_t i = 0; i < parts.spans.size(); ++i) {
        if (parts.has_fixed[parts.root(i)] == 0) {
            found.push_back(parts.spans[i]);
        }
    }
    return found;
}

} // namespace thalweg::solver
