// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/tin/rasterise_tin.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/geometry/triangles.hpp>

namespace thalweg::surface {
namespace {

struct OuterEdge {
    Vec3 a;
    Vec3 b;
};

std::vector<OuterEdge> outer_edges(Tin const& tin) {
    using Half = std::array<std::uint32_t, 3>; // lower end, upper end, triangle
    std::vector<Half> halves;
    halves.reserve(3 * tin.triangles.size());
    for (std::uint32_t i = 0; auto const& t : tin.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            auto const [low, high] = std::minmax(t[k], t[(k + 1) % 3]);
            halves.push_back({low, high, i});
        }
        ++i;
    }
    std::ranges::sort(halves);
    std::vector<Half> outer;
    for (std::size_t i = 0; i < halves.size(); ++i) {
        auto const same = [&](std::size_t k) {
            return k < halves.size() && halves[k][0] == halves[i][0] && halves[k][1] == halves[i][1];
        };
        if (!same(i + 1) && (i == 0 || !same(i - 1))) {
            outer.push_back(halves[i]);
        }
    }
    std::ranges::sort(outer, {}, [](Half const& h) { return h[2]; });
    std::vector<OuterEdge> edges;
    for (Half const& h : outer) {
        edges.push_back({tin.vertices[h[0]], tin.vertices[h[1]]});
    }
    return edges;
}

struct Box {
    double west = std::numeric_limits<double>::infinity();
    double south = std::numeric_limits<double>::infinity();
    double east = -std::numeric_limits<double>::infinity();
    double north = -std::numeric_limits<double>::infinity();

    void add(Vec3 const& p) {
        west = std::min(west, p.x);
        south = std::min(south, p.y);
        east = std::max(east, p.x);
        north = std::max(north, p.y);
    }
    double squared_distance(Vec2 p) const {
        double const dx = std::max({west - p.x, 0.0, p.x - east});
        double const dy = std::max({south - p.y, 0.0, p.y - north});
        return dx * dx + dy * dy;
    }
};

// A tree of boxes over the edges, split at the median along the longer side.
class Nearest {
public:
    explicit Nearest(std::vector<OuterEdge> edges) : edges_(std::move(edges)), order_(edges_.size()) {
        for (std::size_t i = 0; i < order_.size(); ++i) {
            order_[i] = i;
        }
        build(0, order_.size());
    }

    // The height at the nearest point of the edges.
    double height(Vec2 p) const {
        Found found;
        visit(0, p, found);
        return found.z;
    }

private:
    static constexpr std::size_t leaf_size = 4;
    struct Branch {
        Box box;
        std::size_t begin = 0;
        std::size_t end = 0;
        std::size_t second = 0; // the first child follows its parent; 0 in a leaf
    };
    struct Found {
        double squared = std::numeric_limits<double>::infinity();
        std::size_t edge = std::numeric_limits<std::size_t>::max();
        double z = std::numeric_limits<double>::quiet_NaN();
    };

    void build(std::size_t begin, std::size_t end) {
        std::size_t const self = tree_.size();
        tree_.push_back({{}, begin, end, 0});
        Box box;
        for (std::size_t i = begin; i < end; ++i) {
            box.add(edges_[order_[i]].a);
            box.add(edges_[order_[i]].b);
        }
        tree_[self].box = box;
        if (end - begin <= leaf_size) {
            return;
        }
        bool const wide = box.east - box.west > box.north - box.south;
        auto const key = [&](std::size_t e) {
            return wide ? edges_[e].a.x + edges_[e].b.x : edges_[e].a.y + edges_[e].b.y;
        };
        std::size_t const middle = begin + (end - begin) / 2;
        std::sort(order_.begin() + static_cast<std::ptrdiff_t>(begin),
                  order_.begin() + static_cast<std::ptrdiff_t>(end),
                  [&](std::size_t a, std::size_t b) { return key(a) != key(b) ? key(a) < key(b) : a < b; });
        build(begin, middle);
        tree_[self].second = tree_.size();
        build(middle, end);
    }

    void visit(std::size_t at, Vec2 p, Found& found) const {
        Branch const& branch = tree_[at];
        if (branch.box.squared_distance(p) > found.squared) {
            return;
        }
        if (branch.second == 0) {
            for (std::size_t i = branch.begin; i < branch.end; ++i) {
                look(order_[i], p, found);
            }
            return;
        }
        std::size_t const first = at + 1;
        bool const swapped = tree_[branch.second].box.squared_distance(p) < tree_[first].box.squared_distance(p);
        visit(swapped ? branch.second : first, p, found);
        visit(swapped ? first : branch.second, p, found);
    }

    void look(std::size_t number, Vec2 p, Found& found) const {
        OuterEdge const& e = edges_[number];
        double const dx = e.b.x - e.a.x;
        double const dy = e.b.y - e.a.y;
        double const t = std::clamp(((p.x - e.a.x) * dx + (p.y - e.a.y) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
        double const rx = p.x - (e.a.x + t * dx);
        double const ry = p.y - (e.a.y + t * dy);
        double const squared = rx * rx + ry * ry;
        if (squared < found.squared || (squared == found.squared && number < found.edge)) {
            found = {squared, number, t == 1.0 ? e.b.z : e.a.z + t * (e.b.z - e.a.z)};
        }
    }

    std::vector<OuterEdge> edges_;
    std::vector<std::size_t> order_;
    std::vector<Branch> tree_;
};

// Sets every NaN cell to the height at the nearest point of the TIN's boundary (sides of a single triangle); of points
// equally near that of the lowest triangle counts. dem: a raster of this TIN. No NaN remains unless the TIN has no
// triangle.
void extend_tin(Tin const& tin, Raster<float>& dem, Run const& run = {}) {
    if (tin.triangles.empty()) {
        return;
    }
    Nearest const nearest(outer_edges(tin));
    parallel_ranges(run, dem.height(), 8, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin; row < end; ++row) {
            run.check();
            for (std::int64_t col = 0; float& z : dem.row(row)) {
                if (std::isnan(z)) {
                    z = static_cast<float>(nearest.height(dem.grid().centre({col, row})));
                }
                ++col;
            }
        }
    });
}

// Enough that few triangles lie in two bands, few enough that there is a band for every worker.
constexpr std::int64_t band_rows = 64;

// The grid's centres as doubles, which the tests below treat as exact.
struct Centres {
    explicit Centres(Grid const& frame) : grid(frame) {
        for (std::int64_t c = 0; c < grid.width; ++c) {
            x.push_back(grid.centre({c, 0}).x);
        }
        for (std::int64_t r = 0; r < grid.height; ++r) {
            y.push_back(grid.centre({0, r}).y);
        }
    }
    Grid const& grid;
    std::vector<double> x;
    std::vector<double> y;
};

// A whole number near v, clamped to [low, high]; v may be anything. (std::floor is a function call without SSE4.)
std::int64_t clamped(double v, std::int64_t low, std::int64_t high) {
    return v >= static_cast<double>(high) ? high : v <= static_cast<double>(low) ? low : static_cast<std::int64_t>(v);
}

// Bands of rows that a triangle may touch, with one row of margin for rounding.
struct Bands {
    std::int32_t first = 0;
    std::int32_t last = -1;
};

Bands bands_of(double south, double north, Grid const& grid) {
    double const per_m = 1.0 / grid.cell_m;
    auto const row = [&](double y) { return (grid.north - y) * per_m - 0.5; };
    double const top = row(north) - 1.0;
    double const bottom = row(south) + 1.0;
    if (!(bottom >= 0.0) || !(top < static_cast<double>(grid.height))) {
        return {};
    }
    std::int64_t const last_row = grid.height - 1;
    return {static_cast<std::int32_t>(clamped(top, 0, last_row) / band_rows),
            static_cast<std::int32_t>(clamped(bottom, 0, last_row) / band_rows)};
}

void require_sound(Tin const& tin, Run const& run) {
    for (std::size_t i = 0; i < tin.vertices.size(); ++i) {
        Vec3 const& v = tin.vertices[i];
        refuse_if<BadInput>(!is_finite(v), "surface.rasterise_tin", "vertex {} is not finite: ({}, {}, {})", i + 1, v.x,
                            v.y, v.z);
    }
    parallel_ranges(run, static_cast<std::int64_t>(tin.triangles.size()), 1 << 15, [&](std::int64_t b, std::int64_t e) {
        for (std::int64_t i = b; i < e; ++i) {
            auto const& t = tin.triangles[i];
            if (std::max({t[0], t[1], t[2]}) >= tin.vertices.size()) {
                throw BadInput("surface.rasterise_tin",
                               fmt::format("triangle {} has vertex {} of {}", i + 1, std::max({t[0], t[1], t[2]}) + 1,
                                           tin.vertices.size()));
            }
        }
    });
}

// Vertices are scattered in memory: prefetching some triangles ahead hides most of the latency.
constexpr std::size_t ahead = 12;

void fetch(Tin const& tin, std::size_t triangle) {
    for (std::uint32_t const v : tin.triangles[triangle]) {
        __builtin_prefetch(&tin.vertices[v]);
    }
}

// The triangles of each band, by number.
struct TriangleBands {
    std::vector<std::size_t> begin; // by band, and the end
    std::vector<std::uint32_t> triangles;
};

TriangleBands bin(Tin const& tin, Grid const& grid, Run const& run) {
    auto const count = static_cast<std::int64_t>(tin.triangles.size());
    std::vector<Bands> bands(tin.triangles.size());
    parallel_ranges(run, count, 1 << 14, [&](std::int64_t begin, std::int64_t end) {
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
            fetch(tin, std::min(i + ahead, bands.size() - 1));
            auto const& t = tin.triangles[i];
            std::array const y{tin.vertices[t[0]].y, tin.vertices[t[1]].y, tin.vertices[t[2]].y};
            bands[i] = bands_of(std::min(std::min(y[0], y[1]), y[2]), std::max(std::max(y[0], y[1]), y[2]), grid);
        }
    });
    TriangleBands binned;
    binned.begin.assign(static_cast<std::size_t>((grid.height + band_rows - 1) / band_rows) + 1, 0);
    for (Bands const& b : bands) {
        for (std::int32_t k = b.first; k <= b.last; ++k) {
            ++binned.begin[static_cast<std::size_t>(k) + 1];
        }
    }
    for (std::size_t k = 1; k < binned.begin.size(); ++k) {
        binned.begin[k] += binned.begin[k - 1];
    }
    binned.triangles.resize(binned.begin.back());
    std::vector<std::size_t> next = binned.begin;
    for (std::size_t i = 0; i < bands.size(); ++i) {
        for (std::int32_t k = bands[i].first; k <= bands[i].last; ++k) {
            binned.triangles[next[k]++] = static_cast<std::uint32_t>(i);
        }
    }
    return binned;
}

using Pair [[gnu::vector_size(16)]] = double;
using PairOfFloats [[gnu::vector_size(8)]] = float;

// The long side of a triangle and one of the others, whose crossings of a row are computed together.
struct Sides {
    std::array<Vec3 const*, 2> low{};
    std::array<Vec3 const*, 2> high{};
    Pair low_y{};
    Pair column{}; // of the lower ends
    Pair slope{};  // [columns/m] to the east as they go north
};

// The corners of a triangle from south to north, by which of (0 > 1, 0 > 2, 1 > 2) are true of their y; the last number
// is 1 if the middle one is west of the long side. A table, since the order is random to a predictor of branches.
using Order = std::array<std::uint8_t, 4>;
constexpr std::array<Order, 8> orders{Order{0, 1, 2, 0}, {1, 0, 2, 1}, {},           {1, 2, 0, 0},
                                      {0, 2, 1, 1},      {},           {2, 0, 1, 0}, {2, 1, 0, 1}};

struct Column {
    std::int64_t first = 0; // first column whose centre lies on the side or east of it
    bool is_on = false;     // its centre lies on the side
};

// The heights of one band, and the centres on sides that no triangle may own: those of the TIN's boundary.
class Band {
public:
    Band(Tin const& tin, Centres const& centres, double reach_columns, std::int64_t first_row, std::int64_t end_row,
         Raster<float>& dem)
        : tin_(tin), centres_(centres), per_m_(1.0 / centres.grid.cell_m), reach_(Pair{} + reach_columns),
          most_past_(1.0 - reach_), width_(Pair{} + static_cast<double>(centres.grid.width)), first_row_(first_row),
          end_row_(end_row), dem_(dem) {}

    void draw(std::uint32_t triangle) {
        auto const& t = tin_.triangles[triangle];
        Vec3 const& a = tin_.vertices[t[0]];
        Vec3 const& b = tin_.vertices[t[1]];
        Vec3 const& c = tin_.vertices[t[2]];
        double const forward = (b.x - a.x) * (c.y - a.y);
        double const back = (c.x - a.x) * (b.y - a.y);
        double const area = forward - back;
        // With so much cancellation in the products, rounding matters.
        bool const is_sliver = !(area > 1e-9 * (std::fabs(forward) + std::fabs(back)));
        refuse_if<BadInput>(is_sliver && geometry::side_of_line(in_plan(a), in_plan(b), in_plan(c)) <= 0,
                            "surface.rasterise_tin", "triangle {} at ({}, {}) does not run counterclockwise",
                            triangle + 1, a.x, a.y);
        sliver_ = is_sliver ? &t : nullptr;
        double const by_area = is_sliver ? 0.0 : 1.0 / area;
        plane_ = {a, ((b.z - a.z) * (c.y - a.y) - (c.z - a.z) * (b.y - a.y)) * by_area,
                  ((b.x - a.x) * (c.z - a.z) - (c.x - a.x) * (b.z - a.z)) * by_area, std::min({a.z, b.z, c.z}),
                  std::max({a.z, b.z, c.z})};
        Order const& order = orders[(a.y > b.y ? 1U : 0U) + (a.y > c.y ? 2U : 0U) + (b.y > c.y ? 4U : 0U)];
        Vec3 const* const low = &tin_.vertices[t[order[0]]];
        Vec3 const* const middle = &tin_.vertices[t[order[1]]];
        Vec3 const* const high = &tin_.vertices[t[order[2]]];
        part_is_west_ = order[3] == 1;
        auto const [first, end] = rows(low->y, high->y);
        if (first > first_row_ && centres_.y[first - 1] == high->y) {
            bool const flat = middle->y == high->y;
            claim_top(first - 1, flat ? std::min(middle->x, high->x) : high->x,
                      flat ? std::max(middle->x, high->x) : high->x);
        }
        double const whole = (high->x - low->x) / (high->y - low->y) * per_m_;
        Pair const slopes =
            Pair{middle->x - low->x, high->x - middle->x} / Pair{middle->y - low->y, high->y - middle->y} * per_m_;
        Pair const columns = (Pair{low->x, middle->x} - centres_.grid.west) * per_m_ - 0.5;
        std::array<Sides, 2> const parts{
            Sides{{low, low}, {high, middle}, {low->y, low->y}, {columns[0], columns[0]}, {whole, slopes[0]}},
            Sides{{low, middle}, {high, high}, {low->y, middle->y}, columns, {whole, slopes[1]}}};
        for (std::int64_t row = first; row < end; ++row) {
            draw_row(row, parts[centres_.y[row] >= middle->y ? 1 : 0]);
        }
    }

    // Assigns centres on the TIN's boundary to it.
    void settle() {
        for (auto const& [cell, z] : claims_) {
            if (std::isnan(dem_[cell])) {
                dem_[cell] = z;
            }
        }
    }

private:
    // Rows of this band whose centres lie in [south, north).
    std::pair<std::int64_t, std::int64_t> rows(double south, double north) const {
        Grid const& grid = centres_.grid;
        auto const y = [&](std::int64_t r) { return centres_.y[r]; };
        std::int64_t first = clamped((grid.north - north) * per_m_ - 0.5, first_row_, end_row_);
        while (first > first_row_ && y(first - 1) < north) {
            --first;
        }
        while (first < end_row_ && y(first) >= north) {
            ++first;
        }
        std::int64_t end = clamped((grid.north - south) * per_m_ + 0.5, first, end_row_);
        while (end > first && y(end - 1) < south) {
            --end;
        }
        while (end < end_row_ && y(end) >= south) {
            ++end;
        }
        return {first, end};
    }

    // Where a row crosses the west and the east side.
    std::pair<Column, Column> columns(Sides const& sides, std::int64_t row) const {
        double const y = centres_.y[row];
        Pair const past_west = sides.column + (y - sides.low_y) * sides.slope + 1.0; // columns from -1 on
        constexpr double rounder = 0x1.8p52; // added and subtracted, leaves a whole number
        Pair const whole = past_west - 0.5 + rounder - rounder;
        Pair const past = past_west - whole;
        auto const is_sure = (past > reach_) & (past < most_past_);
        Pair const not_west = whole > Pair{} ? whole : Pair{};
        Pair const held = not_west < width_ ? not_west : width_;
        Column of_whole{static_cast<std::int64_t>(held[0]), false};
        Column of_part{static_cast<std::int64_t>(held[1]), false};
        if ((is_sure[0] & is_sure[1]) == 0) {
            of_whole = exact_column(*sides.low[0], *sides.high[0], of_whole.first, y);
            of_part = exact_column(*sides.low[1], *sides.high[1], of_part.first, y);
        }
        return part_is_west_ ? std::pair(of_part, of_whole) : std::pair(of_whole, of_part);
    }

    // Finds the exact column, starting from a guess.
    Column exact_column(Vec3 const& low, Vec3 const& high, std::int64_t c, double y) const {
        std::int64_t const width = centres_.grid.width;
        auto const turn = [&](std::int64_t col) {
            return geometry::side_of_line(in_plan(low), in_plan(high), {centres_.x[col], y});
        };
        while (c > 0 && turn(c - 1) <= 0) {
            --c;
        }
        while (c < width && turn(c) > 0) {
            ++c;
        }
        return {c, c < width && turn(c) == 0};
    }

    float height(double x, double base) const {
        double const z = base + plane_.east * (x - plane_.at.x);
        return static_cast<float>(z > plane_.highest ? plane_.highest : z < plane_.lowest ? plane_.lowest : z);
    }
    double base(std::int64_t row) const { return plane_.at.z + plane_.north * (centres_.y[row] - plane_.at.y); }

    float height_in_sliver(std::int64_t row, std::int64_t col) const {
        auto const& t = *sliver_;
        return static_cast<float>(geometry::height_on_plane(tin_.vertices[t[0]], tin_.vertices[t[1]],
                                                            tin_.vertices[t[2]], {centres_.x[col], centres_.y[row]}));
    }

    void draw_row(std::int64_t row, Sides const& sides) {
        auto const [begin, end] = columns(sides, row);
        float* const cells = dem_.row(row).data();
        if (sliver_ != nullptr) {
            for (std::int64_t c = begin.first; c < end.first; ++c) {
                cells[c] = height_in_sliver(row, c);
            }
        } else {
            double const at_a = base(row);
            std::int64_t c = begin.first;
            std::int64_t const last_four = centres_.grid.width - 4;
            if (c <= last_four) { // most rows of triangles are shorter than four cells: no branch tells 0 from 3
                do {
                    draw_four(cells + c, centres_.x.data() + c, at_a, end.first - c);
                    c += 4;
                } while (c < end.first && c <= last_four);
            }
            for (; c < end.first; ++c) {
                cells[c] = height(centres_.x[c], at_a);
            }
        }
        if (end.is_on) {
            claim(row, end.first);
        }
    }

    // The first `count` of four cells, those that are fewer too.
    void draw_four(float* cells, double const* x, double base, std::int64_t count) const {
        using Four [[gnu::vector_size(16)]] = float;
        using Numbers [[gnu::vector_size(16)]] = std::int32_t;
        auto const two = [&](double const* at) {
            Pair const z = base + plane_.east * (Pair{at[0], at[1]} - plane_.at.x);
            Pair const most = Pair{} + plane_.highest;
            Pair const least = Pair{} + plane_.lowest;
            Pair const not_below = least > z ? least : z;
            Pair const held = most < not_below ? most : not_below;
            return __builtin_convertvector(held, PairOfFloats);
        };
        PairOfFloats const west = two(x);
        PairOfFloats const east = two(x + 2);
        Four const heights{west[0], west[1], east[0], east[1]};
        Four before;
        std::memcpy(&before, cells, sizeof before);
        Numbers const drawn = Numbers{0, 1, 2, 3} < static_cast<std::int32_t>(std::min<std::int64_t>(count, 4));
        Four const now = drawn ? heights : before;
        std::memcpy(cells, &now, sizeof now);
    }

    void claim(std::int64_t row, std::int64_t col) {
        claims_.emplace_back(dem_.grid().index({col, row}),
                             sliver_ == nullptr ? height(centres_.x[col], base(row)) : height_in_sliver(row, col));
    }

    void claim_top(std::int64_t row, double west, double east) {
        auto const first = std::lower_bound(centres_.x.begin(), centres_.x.end(), west);
        for (auto x = first; x != centres_.x.end() && *x <= east; ++x) {
            claim(row, x - centres_.x.begin());
        }
    }

    struct Plane {
        Vec3 at;
        double east = 0.0; // rise [m/m]
        double north = 0.0;
        double lowest = 0.0;
        double highest = 0.0;
    };
    Tin const& tin_;
    Centres const& centres_;
    double per_m_; // cells a metre
    Pair reach_;
    Pair most_past_;
    Pair width_;
    std::int64_t first_row_;
    std::int64_t end_row_;
    Raster<float>& dem_;
    Plane plane_;
    bool part_is_west_ = false;                            // of the long side
    std::array<std::uint32_t, 3> const* sliver_ = nullptr; // the current triangle, if it is a sliver
    std::vector<std::pair<std::int64_t, float>> claims_;
};

// The largest error [columns] of the crossing of a row and a side due to rounding.
double reach_of(Tin const& tin, Grid const& grid) {
    double greatest =
        std::max({std::fabs(grid.west), std::fabs(grid.east()), std::fabs(grid.north), std::fabs(grid.south())});
    for (Vec3 const& v : tin.vertices) {
        greatest = std::max({greatest, std::fabs(v.x), std::fabs(v.y)});
    }
    return 64.0 * 0x1p-53 * greatest / grid.cell_m;
}

} // namespace

Raster<float> rasterise_tin(Tin const& tin, Grid const& grid, RasteriseTinParams const& params, Run const& run) {
    require_sound(tin, run);
    Raster<float> dem(grid, std::numeric_limits<float>::quiet_NaN());
    if (dem.cells() == 0) {
        return dem;
    }
    Centres const centres(grid);
    double const reach = reach_of(tin, grid);
    TriangleBands const binned = bin(tin, grid, run);
    // One band per call: its content must not depend on how bands are distributed.
    parallel_ranges(run, static_cast<std::int64_t>(binned.begin.size()) - 1, 1, [&](std::int64_t b, std::int64_t e) {
        for (std::int64_t k = b; k < e; ++k) {
            run.check();
            Band band(tin, centres, reach, k * band_rows, std::min((k + 1) * band_rows, grid.height), dem);
            std::size_t const end = binned.begin[static_cast<std::size_t>(k) + 1];
            for (std::size_t i = binned.begin[k]; i < end; ++i) {
                fetch(tin, binned.triangles[std::min(i + ahead, end - 1)]);
                band.draw(binned.triangles[i]);
            }
            band.settle();
        }
    });
    if (params.outside == RasteriseTinParams::Outside::nearest) {
        extend_tin(tin, dem, run);
    }
    return dem;
}

} // namespace thalweg::surface
