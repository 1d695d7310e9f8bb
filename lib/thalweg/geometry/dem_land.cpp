// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/geometry/internal/dem_land.hpp>

#include <array>
#include <utility>

namespace thalweg::geometry {

bool DemLand::outline(std::int64_t col, std::int64_t row, int dx, int dy) const {
    if (dx < 0 || (dx == 0 && dy < 0)) {
        return outline(col + dx, row + dy, -dx, -dy);
    }
    if (!has(col, row) || !has(col + dx, row + dy)) {
        return false;
    }
    if (dx == 0) {
        return (corners(col, row) >= 3) != (corners(col - 1, row) >= 3);
    }
    if (dy == 0) {
        return (corners(col, row) >= 3) != (corners(col, row - 1) >= 3);
    }
    return corners(col, dy > 0 ? row : row - 1) == 3;
}

int DemLand::degree(std::int64_t col, std::int64_t row) const {
    int count = 0;
    for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
            count += (dx != 0 || dy != 0) && outline(col, row, dx, dy) ? 1 : 0;
        }
    }
    return count;
}

bool DemLand::is_inside(std::int64_t col3, std::int64_t row3) const {
    std::int64_t const col = col3 / 3;
    std::int64_t const row = row3 / 3;
    int const data = corners(col, row);
    if (data != 3) {
        return data == 4;
    }
    std::int64_t const x = col3 - 3 * col;
    std::int64_t const y = row3 - 3 * row;
    if (!has(col, row)) {
        return x + y > 3;
    }
    if (!has(col + 1, row + 1)) {
        return x + y < 3;
    }
    return has(col + 1, row) ? x > y : x < y;
}

std::vector<std::vector<Vec3>> outlines_of(Raster<float> const& dem, DemLand const& land, Run const& run) {
    std::vector<std::vector<Vec3>> lines;
    auto const place = [&](std::int64_t col, std::int64_t row) {
        return Vec3{static_cast<double>(col), static_cast<double>(-row), static_cast<double>(dem[Cell{col, row}])};
    };
    constexpr std::array<std::pair<int, int>, 4> directions{{{1, 0}, {0, 1}, {1, 1}, {1, -1}}};
    for (std::int64_t row = 0; row < dem.height(); ++row) {
        run.check();
        for (std::int64_t col = 0; col < dem.width(); ++col) {
            for (auto const& [dx, dy] : directions) {
                if (!land.outline(col, row, dx, dy) ||
                    (land.outline(col, row, -dx, -dy) && land.degree(col, row) == 2)) {
                    continue;
                }
                std::int64_t c = col + dx;
                std::int64_t r = row + dy;
                while (land.outline(c, r, dx, dy) && land.degree(c, r) == 2) {
                    c += dx;
                    r += dy;
                }
                lines.push_back({place(col, row), place(c, r)});
            }
        }
    }
    return lines;
}

} // namespace thalweg::geometry
