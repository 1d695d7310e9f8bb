// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/equilibrium/internal/cover_cells.hpp>

#include <algorithm>

namespace thalweg::surface {

namespace {

bool beside(LandLevel const& level, std::size_t i, Cover what) {
    auto const offsets = level.offsets();
    return std::any_of(offsets.begin(), offsets.end(),
                       [&](std::int64_t offset) { return level.cover[moved(i, offset)] == what; });
}

void cover_banks(LandLevel& level) {
    for (std::uint32_t const river : level.rivers.cell) {
        for (std::int64_t const offset : level.offsets()) {
            Cover& near = level.cover[moved(river, offset)];
            near = near == Cover::land ? Cover::bank : near == Cover::rim ? Cover::rim_bank : near;
        }
    }
}

} // namespace

Mask coarsened(Mask const& land) {
    Grid grid = land.grid();
    grid.width = (land.width() + 1) / 2;
    grid.height = (land.height() + 1) / 2;
    Mask coarse(grid);
    for (std::int64_t row = 0; row < grid.height; ++row) {
        for (std::int64_t col = 0; col < grid.width; ++col) {
            int all = 0;
            int dry = 0;
            for (std::int64_t r = 2 * row; r < std::min(2 * row + 2, land.height()); ++r) {
                for (std::int64_t c = 2 * col; c < std::min(2 * col + 2, land.width()); ++c) {
                    ++all;
                    dry += land[Cell{c, r}] != 0 ? 1 : 0;
                }
            }
            coarse[Cell{col, row}] = 2 * dry >= all ? 1 : 0;
        }
    }
    return coarse;
}

void cover_cells(LandLevel& level, Mask const& land, Edge edge, RiverBanks banks) {
    bool const has_sea = edge == Edge::coast || edge == Edge::mainland;
    Cover const rest = has_sea ? Cover::sea : Cover::outside;
    Cover const frame = edge == Edge::open || edge == Edge::mainland ? Cover::edge : rest;
    Cover const frame_at_rest = edge == Edge::mainland ? Cover::sea : frame;
    level.cover.resize(static_cast<std::size_t>(level.cells()));
    for (std::int64_t row = 0; row < level.height; ++row) {
        for (std::int64_t col = 0; col < level.width; ++col) {
            Cell const inner{std::clamp<std::int64_t>(col, 1, level.width - 2) - 1,
                             std::clamp<std::int64_t>(row, 1, level.height - 2) - 1};
            bool const on_frame = inner.col + 1 != col || inner.row + 1 != row;
            bool const dry = land.cells() == 0 || land[inner] != 0;
            level.cover[static_cast<std::size_t>(row * level.width + col)] =
                on_frame ? (dry ? frame : frame_at_rest) : (dry ? Cover::land : rest);
        }
    }
    for (std::uint32_t const river : level.rivers.cell) {
        level.cover[river] = Cover::river;
    }
    if (!has_sea) {
        each_inner(level, [&](std::size_t i) {
            if (level.cover[i] == Cover::land && beside(level, i, Cover::outside)) {
                level.cover[i] = edge == Edge::open ? Cover::edge : Cover::rim;
            }
        });
    }
    if (banks == RiverBanks::kept) {
        cover_banks(level);
    }
}

} // namespace thalweg::surface
