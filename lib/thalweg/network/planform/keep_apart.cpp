// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/planform/internal/keep_apart.hpp>

#include <algorithm>
#include <cmath>

#include <thalweg/network/planform/internal/segment_grid.hpp>

namespace thalweg::network {

namespace {

constexpr double kept_share = 0.6; // of a distance below the gap

double inside(Vec2 p, Grid const& grid) {
    return std::min({p.x - grid.west, grid.east() - p.x, grid.north - p.y, p.y - grid.south()});
}

Vec2 lowest(std::vector<Vec2> const& at) {
    Vec2 low = at.front();
    for (Vec2 const p : at) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    }
    return low;
}

Vec2 highest(std::vector<Vec2> const& at) {
    Vec2 high = at.front();
    for (Vec2 const p : at) {
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    return high;
}

bool is_sea(Vec2 p, Mask const& land) {
    Cell const c = land.grid().cell_of(p);
    return land.grid().contains(c) && land[c] == 0;
}

} // namespace

bool leaves_land(Stems const& stems, std::vector<Vec2> const& at, std::size_t i, Mask const& land) {
    if (land.cells() == 0) {
        return false;
    }
    if (is_sea(at[i], land)) {
        return true;
    }
    if (i + 1 == at.size() || stems.stem_of[i] != stems.stem_of[i + 1]) {
        return false;
    }
    auto const [count, step] = steps_between(at[i], at[i + 1], land.grid().cell_m);
    for (double k = 1.0; k < count; k += 1.0) {
        if (is_sea({at[i].x + k * step.x, at[i].y + k * step.y}, land)) {
            return true;
        }
    }
    return false;
}

std::vector<std::size_t> too_near(Stems const& stems, std::vector<Vec2> const& was, std::vector<Vec2> const& is,
                                  Grid const& grid, Mask const& land, Gap const& gap) {
    double const gap_m = gap.gap_m;
    std::vector<std::size_t> found;
    SegmentGrid segments(lowest(is), highest(is), 2.0 * gap_m, is.size());
    for (std::size_t i = 0; i + 1 < is.size(); ++i) {
        if (stems.stem_of[i] == stems.stem_of[i + 1]) {
            segments.add(i, {is[i], is[i + 1]});
        }
    }
    for (std::size_t i = 0; i < is.size(); ++i) {
        if (inside(is[i], grid) < std::min(grid.cell_m, inside(was[i], grid))) {
            found.push_back(i);
        }
        if (leaves_land(stems, is, i, land) && !leaves_land(stems, was, i, land)) {
            found.insert(found.end(), {i, std::min(i + 1, is.size() - 1)});
        }
        segments.near({is[i], is[i]}, gap_m, [&](std::size_t j) {
            bool const same = stems.stem_of[i] == stems.stem_of[j];
            if (j == i || j + 1 == i || (same && std::fabs(stems.way_m[i] - stems.way_m[j]) < gap.along_m)) {
                return true;
            }
            double const now = squared_distance(is[i], segments[j]);
            double const before = squared_distance(was[i], {was[j], was[j + 1]});
            if (now < (before >= gap_m * gap_m ? gap_m * gap_m : kept_share * kept_share * before)) {
                found.insert(found.end(), {i, j});
            }
            return true;
        });
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
}

std::vector<Vec2> shifted(Stems const& stems, std::vector<Vec2> const& at, std::vector<Vec2> const& shift,
                          std::vector<double> const& share, double cell_m) {
    std::vector<Vec2> out(at.size());
    for (Stem const& stem : stems.stems) {
        for (std::size_t i = stem.begin; i < stem.end; ++i) {
            out[i] = {at[i].x + share[i] * shift[i].x, at[i].y + share[i] * shift[i].y};
        }
        if (!stem.joins) {
            continue;
        }
        Vec2 const mouth = out[stems.node_point[stem.mouth]];
        Vec2 const by{mouth.x - out[stem.end - 1].x, mouth.y - out[stem.end - 1].y};
        double const reach = std::max(8.0 * cell_m, 3.0 * std::sqrt(by.x * by.x + by.y * by.y));
        double const end_m = stems.way_m[stem.end - 1];
        for (std::size_t i = stem.end; i-- > stem.begin && end_m - stems.way_m[i] < reach;) {
            double const t = (end_m - stems.way_m[i]) / reach;
            double const follows = 1.0 - t * t * (3.0 - 2.0 * t);
            out[i] = {out[i].x + follows * by.x, out[i].y + follows * by.y};
        }
        out[stem.end - 1] = mouth;
    }
    return out;
}

std::int64_t ease(Stems const& stems, std::vector<std::size_t> const& points, double reach_m,
                  std::vector<double>& share) {
    constexpr double least = 1.0 / 64.0;
    std::vector<double> factor(share.size(), 1.0);
    for (std::size_t const i : points) {
        Stem const& stem = stems.stems[stems.stem_of[i]];
        auto const lower = [&](std::size_t j) {
            double const t = std::fabs(stems.way_m[j] - stems.way_m[i]) / reach_m;
            factor[j] = std::min(factor[j], 0.5 + 0.5 * t);
            return t < 1.0;
        };
        for (std::size_t j = i; j < stem.end && lower(j); ++j) {
        }
        for (std::size_t j = i; j-- > stem.begin && lower(j);) {
        }
    }
    std::int64_t eased = 0;
    for (std::size_t i = 0; i < share.size(); ++i) {
        if (factor[i] < 1.0 && share[i] > 0.0) {
            ++eased;
            share[i] *= factor[i];
            share[i] = share[i] < least ? 0.0 : share[i];
        }
    }
    return eased;
}

} // namespace thalweg::network
