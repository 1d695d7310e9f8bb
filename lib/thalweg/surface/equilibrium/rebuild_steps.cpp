// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <thalweg/surface/equilibrium/internal/rebuild_steps.hpp>

#include <algorithm>

// Described in docs/rebuild.md.

namespace thalweg::surface {

NearestRiver straight_to(TerrainLevel const& level, std::vector<std::uint32_t> const& cells, Run const& run) {
    NearestRiver near = nearest_of(level, cells);
    parallel_ranges(run, level.height, least_rows(level.width), [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin; row < end; ++row) {
            for (std::int64_t col = 0; col < level.width; ++col) {
                std::size_t const i = static_cast<std::size_t>(row * level.width + col);
                if (near.number[i] != NearestRiver::none) {
                    Cell const to = level.at(cells[near.number[i]]);
                    auto const east = static_cast<float>(to.col - col);
                    auto const south = static_cast<float>(to.row - row);
                    near.distance[i] = std::sqrt(east * east + south * south);
                }
            }
        }
    });
    return near;
}

namespace {

/// Means along a row.
void blur_row(float const* from, float* to, std::int64_t width, std::int64_t reach) {
    auto const at = [&](std::int64_t c) {
        return static_cast<double>(from[std::clamp<std::int64_t>(c, 0, width - 1)]);
    };
    double sum = 0.0;
    for (std::int64_t c = -reach; c <= reach; ++c) {
        sum += at(c);
    }
    double const part = 1.0 / static_cast<double>(2 * reach + 1);
    for (std::int64_t c = 0; c < width; ++c) {
        to[c] = static_cast<float>(sum * part);
        sum += at(c + reach + 1) - at(c - reach);
    }
}

/// Means along columns, in place.
void blur_columns(float* first, Rows const& rows, std::int64_t begin, std::int64_t end, std::int64_t reach) {
    auto const count = static_cast<std::size_t>(end - begin);
    std::vector<double> sums(count, 0.0);
    auto const row = [&](std::int64_t r) {
        return first + std::clamp<std::int64_t>(r, 0, rows.height - 1) * rows.stride + begin;
    };
    for (std::int64_t r = -reach; r <= reach; ++r) {
        float const* const values = row(r);
        for (std::size_t c = 0; c < count; ++c) {
            sums[c] += static_cast<double>(values[c]);
        }
    }
    std::int64_t const kept = std::min(reach + 1, rows.height);
    std::vector<float> before(static_cast<std::size_t>(kept) * count); // of the last rows, which have means by now
    auto const was = [&](std::int64_t r) {
        return before.data() + static_cast<std::size_t>(std::max<std::int64_t>(r, 0) % kept) * count;
    };
    double const part = 1.0 / static_cast<double>(2 * reach + 1);
    for (std::int64_t r = 0; r < rows.height; ++r) {
        float* const out = row(r);
        std::copy_n(out, count, was(r));
        float const* const enters = row(r + reach + 1);
        float const* const leaves = was(r - reach);
        for (std::size_t c = 0; c < count; ++c) {
            float const value = enters[c];
            out[c] = static_cast<float>(sums[c] * part);
            sums[c] += static_cast<double>(value) - static_cast<double>(leaves[c]);
        }
    }
}

/// The lowest land two cells from a river cell, on coarse levels one; banks do not count.
std::optional<std::size_t> lowest_land_beside(TerrainLevel const& level, std::uint32_t cell,
                                              std::array<std::int64_t, 8> const& offsets) {
    std::optional<std::size_t> lowest;
    auto const take = [&](std::size_t n) {
        bool const dry = level.type[n] == CellType::land || level.type[n] == CellType::rim;
        if (dry && (!lowest || level.z[n] < level.z[*lowest])) {
            lowest = n;
        }
    };
    if (level.side > 1.0F) {
        std::for_each(offsets.begin(), offsets.end(), [&](std::int64_t offset) { take(moved(cell, offset)); });
    } else {
        each_of_second_ring(level, cell, take);
    }
    return lowest;
}

} // namespace

void blur(float* first, Rows const& rows, BlurParams const& params, Run const& run) {
    constexpr std::int64_t columns = 256;
    for (int pass = 0; pass < params.passes; ++pass) {
        parallel_ranges(run, rows.height, least_rows(rows.width), [&](std::int64_t begin, std::int64_t end) {
            std::vector<float> along(static_cast<std::size_t>(rows.width));
            for (std::int64_t r = begin; r < end; ++r) {
                blur_row(first + r * rows.stride, along.data(), rows.width, params.reach);
                std::ranges::copy(along, first + r * rows.stride);
            }
        });
        parallel_ranges(run, rows.width, columns, [&](std::int64_t begin, std::int64_t end) {
            blur_columns(first, rows, begin, end, params.reach);
        });
    }
}

void mark_to_move(TerrainLevel const& level, std::size_t from, float wanted, WallParams const& params,
                  Cells<float>& marks) {
    constexpr double rate = 0.5;
    auto const offsets = level.offsets();
    if (marks.empty()) {
        marks.assign(level.z.size(), 0.0F);
    }
    std::size_t end = from;
    while (is_land(level.type[end]) && level.direction[end] >= 0) {
        end = moved(end, offsets[level.direction[end]]);
    }
    float const has = std::max(level.z[from] - level.z[end], params.least_height * level.side);
    float const shall = std::max(wanted - level.z[end], params.least_height * level.side);
    float const ratio = wanted > level.z[from] ? shall / has : has / shall;
    double const step = portable::log(static_cast<double>(std::max(ratio, 1.0F)));
    auto const lack = static_cast<float>(rate * std::min(1.0, step));
    for (std::size_t i = from; i != end; i = moved(i, offsets[level.direction[i]])) {
        marks[i] = std::max(marks[i], lack);
    }
}

Cells<float> spread_along(TerrainLevel const& level, Cells<float> out, WallParams const& params, Run const& run) {
    if (out.empty()) {
        return out;
    }
    auto const reach = std::max<std::int64_t>(1, static_cast<std::int64_t>(params.reach));
    Rows const inner{level.width - 2, level.height - 2, level.width};
    Cells<float> marks(out.size());
    std::transform(out.begin(), out.end(), marks.begin(), [](float of) { return of > 0.0F ? 1.0F : 0.0F; });
    auto const first = static_cast<std::size_t>(level.width + 1);
    blur(&out[first], inner, {reach, 2}, run);
    blur(&marks[first], inner, {reach, 2}, run);
    constexpr float some = 1e-6F;
    float const whole = 0.7F * static_cast<float>(2 * reach + 1); // a path across a square
    for (std::size_t i = 0; i < marks.size(); ++i) {
        out[i] = marks[i] > some ? out[i] / marks[i] * std::min(1.0F, marks[i] * whole) : 0.0F;
    }
    return out;
}

Cells<float> land_below_rivers(TerrainLevel const& level, WallParams const& params, Run const& run) {
    constexpr float margin = 4.0F; // [tolerance]
    auto const offsets = level.offsets();
    Cells<float> out;
    float const tolerance = params.tolerance * level.side;
    for (std::size_t n = 0; n < level.rivers.cell.size(); ++n) {
        std::uint32_t const cell = level.rivers.cell[n];
        auto const lowest =
            level.rivers.level[n] == 0 ? lowest_land_beside(level, cell, offsets) : std::optional<std::size_t>{};
        if (!lowest || level.z[*lowest] >= level.z[cell] + tolerance) {
            continue;
        }
        mark_to_move(level, *lowest, level.z[cell] + margin * tolerance, params, out);
    }
    return spread_along(level, std::move(out), params, run);
}

Cells<std::int32_t> links_of(TerrainLevel const& level, std::vector<std::int32_t> const& link, Run const& run) {
    Cells<std::int32_t> links(level.z.size(), -1);
    for (std::size_t n = 0; n < level.rivers.cell.size(); ++n) {
        std::int64_t const number = level.rivers.number[n];
        links[level.rivers.cell[n]] = number < 0 ? -1 : link[number];
    }
    auto const offsets = level.offsets();
    each_upstream(level, CellType::rim_bank, run,
                  [&](std::size_t i) { links[i] = links[moved(i, offsets[level.direction[i]])]; });
    return links;
}

Cells<float> distance_to_divides(TerrainLevel const& level, std::vector<std::int32_t> const& link, Run const& run) {
    Cells<std::int32_t> links = links_of(level, link, run);
    auto const offsets = level.offsets();
    std::vector<std::uint32_t> divides;
    each_inner(level, [&](std::size_t i) {
        if (!is_land(level.type[i])) {
            return;
        }
        if (!level.is_crest.empty() && level.is_crest[i] != 0) {
            divides.push_back(static_cast<std::uint32_t>(i));
            return;
        }
        for (std::size_t k = 0; k < offsets.size(); k += 2) {
            std::size_t const n = moved(i, offsets[k]);
            if (links[n] != links[i] && level.type[n] <= CellType::river) {
                divides.push_back(static_cast<std::uint32_t>(i));
                return;
            }
        }
    });
    release(links);
    return straight_to(level, divides, run).distance;
}

} // namespace thalweg::surface
