// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/geometry/tin_of_dem.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/run/memory.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/geometry/triangles.hpp>
#include <thalweg/geometry/triangulate.hpp>

namespace thalweg::geometry {
namespace {

// Where triangles between the cell centres of a DEM may lie: squares between four centres with data, halves of those
// with three.
class DemLand {
public:
    explicit DemLand(Raster<float> const& dem)
        : dem_(dem), width_(dem.width() + 1), corners_(static_cast<std::size_t>(width_ * (dem.height() + 1)), 0) {
        for (std::int64_t row = 0; row < dem.height(); ++row) {
            std::uint8_t* const north = &corners_[static_cast<std::size_t>(row * width_)];
            std::uint8_t* const south = north + width_;
            for (std::int64_t col = 0; float const z : dem.row(row)) {
                if (!std::isnan(z)) {
                    ++north[col];
                    ++north[col + 1];
                    ++south[col];
                    ++south[col + 1];
                }
                ++col;
            }
        }
    }

    bool has(std::int64_t col, std::int64_t row) const {
        return dem_.grid().contains({col, row}) && !std::isnan(dem_[Cell{col, row}]);
    }
    // Number of centres with data at the corners of the square south-east of a centre; from column and row -1 on.
    int corners(std::int64_t col, std::int64_t row) const {
        return corners_[static_cast<std::size_t>((row + 1) * width_ + col + 1)];
    }
    // Whether all four squares at a centre are whole.
    bool is_inner(std::int64_t col, std::int64_t row) const {
        return (corners(col, row) & corners(col - 1, row) & corners(col, row - 1) & corners(col - 1, row - 1)) == 4;
    }
    bool holds(std::int64_t col, std::int64_t row) const {
        return has(col, row) && (corners(col, row) >= 3 || corners(col - 1, row) >= 3 || corners(col, row - 1) >= 3 ||
                                 corners(col - 1, row - 1) >= 3);
    }
    // Whether the outline runs from a centre to its neighbour: terrain lies on one side of the step only.
    bool outline(std::int64_t col, std::int64_t row, int dx, int dy) const {
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

    // Number of outline steps at a centre.
    int degree(std::int64_t col, std::int64_t row) const {
        int count = 0;
        for (int dy = -1; dy <= 1; ++dy) {
            for (int dx = -1; dx <= 1; ++dx) {
                count += (dx != 0 || dy != 0) && outline(col, row, dx, dy) ? 1 : 0;
            }
        }
        return count;
    }

    // Whether a triangle whose sides do not cross the outline lies on terrain; tests its centroid, given times three.
    bool is_inside(std::int64_t col3, std::int64_t row3) const {
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

private:
    Raster<float> const& dem_;
    std::int64_t width_;
    std::vector<std::uint8_t> corners_;
};

// The outline as straight lines between its corners, with heights. x: column, y: minus the row.
std::vector<std::vector<Vec3>> outlines_of(Raster<float> const& dem, DemLand const& land, Run const& run) {
    std::vector<std::vector<Vec3>> lines;
    auto const place = [&](std::int64_t col, std::int64_t row) {
        return Vec3{static_cast<double>(col), static_cast<double>(-row), static_cast<double>(dem[Cell{col, row}])};
    };
    constexpr std::array<std::pair<int, int>, 4> directions{{{1, 0}, {0, 1}, {1, 1}, {1, -1}}};
    for (std::int64_t row = 0; row < dem.height(); ++row) {
        run.check();
        for (std::int64_t col = 0; col < dem.width(); ++col) {
            if (land.is_inner(col, row)) {
                continue;
            }
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

constexpr std::int64_t most_cells_a_side = 1 << 20; // so that areas fit 64 bits and circles 128
constexpr std::uint32_t nobody = std::numeric_limits<std::uint32_t>::max();

struct Spot {
    std::int32_t col = 0;
    std::int32_t row = 0;
    float z = 0.0F;
};

// Twice the area of a triangle; positive: counterclockwise on the map.
std::int64_t turn(Spot const& a, Spot const& b, Spot const& c) {
    return std::int64_t{b.col - a.col} * (a.row - c.row) - std::int64_t{c.col - a.col} * (a.row - b.row);
}

bool within_circle(Spot const& a, Spot const& b, Spot const& c, Spot const& p) {
    __extension__ using Wide = __int128;
    auto const square = [&](Spot const& s) {
        std::int64_t const x = s.col - p.col;
        std::int64_t const y = s.row - p.row;
        return x * x + y * y;
    };
    return Wide{turn(p, b, c)} * square(a) + Wide{turn(p, c, a)} * square(b) + Wide{turn(p, a, b)} * square(c) > 0;
}

// Where a side of a face crosses the rows, from its upper end down: at column + rest / rows.
class SideOfFace {
public:
    SideOfFace(Spot const& from, Spot const& to) : column_(from.col), rows_(to.row - from.row) {
        if (rows_ > 0) {
            step_ = (to.col - from.col) / rows_;
            rest_step_ = (to.col - from.col) % rows_;
            if (rest_step_ < 0) {
                --step_;
                rest_step_ += rows_;
            }
        }
    }
    void go_down() {
        column_ += step_;
        rest_ += rest_step_;
        if (rest_ >= rows_) {
            rest_ -= rows_;
            ++column_;
        }
    }
    std::int32_t first() const { return column_ + (rest_ > 0 ? 1 : 0); }
    std::int32_t last() const { return column_; }

private:
    std::int32_t column_;
    std::int32_t rows_;
    std::int32_t rest_ = 0;
    std::int32_t step_ = 0;
    std::int32_t rest_step_ = 0;
};

// The plane of a triangle along a row.
struct PlaneAlongRow {
    double at_row = 0.0;
    double east = 0.0;
    std::int32_t col = 0; // where the height is at_row

    double error(float const* heights, std::int32_t x) const {
        return std::fabs(at_row + east * static_cast<double>(x - col) - static_cast<double>(heights[x]));
    }
};

// The greatest error in columns first to last, or least if that is more.
double greatest_error(PlaneAlongRow const& plane, float const* heights, std::int32_t first, std::int32_t last,
                      double least) {
    double most = least;
    std::int32_t x = first;
    if (last - first >= 7) { // two vectors at once: the maxima are independent
        using Pair [[gnu::vector_size(16)]] = double;
        using Bits [[gnu::vector_size(16)]] = std::int64_t;
        auto const error = [&](Pair const& along, std::int32_t at) {
            Pair const z{static_cast<double>(heights[at]), static_cast<double>(heights[at + 1])};
            return std::bit_cast<Pair>(std::bit_cast<Bits>(plane.at_row + plane.east * along - z) & 0x7fffffffffffffff);
        };
        double const from = static_cast<double>(x - plane.col);
        Pair along{from, from + 1.0};
        Pair one = Pair{} + least;
        Pair two = one;
        for (; x + 3 <= last; x += 4) {
            Pair const a = error(along, x);
            Pair const b = error(along + 2.0, x + 2);
            one = a > one ? a : one;
            two = b > two ? b : two;
            along += 4.0;
        }
        most = std::max({one[0], one[1], two[0], two[1]});
    }
    for (; x <= last; ++x) {
        double const error = plane.error(heights, x);
        most = error > most ? error : most;
    }
    return most;
}

class Mesh {
public:
    Mesh(Raster<float> const& dem, double error_m, Tin const& first, DemLand const& land)
        : dem_(dem), error_m_(error_m) {
        for (Vec3 const& v : first.vertices) {
            add_spot({static_cast<std::int64_t>(v.x), static_cast<std::int64_t>(-v.y)});
        }
        for (auto const& t : first.triangles) {
            std::int64_t const col3 = spots_[t[0]].col + spots_[t[1]].col + spots_[t[2]].col;
            std::int64_t const row3 = spots_[t[0]].row + spots_[t[1]].row + spots_[t[2]].row;
            if (land.is_inside(col3, row3)) {
                faces_[new_face()] = {t, {nobody, nobody, nobody}};
            }
        }
        join();
        for (std::uint32_t f = 0; f < faces_.size(); ++f) {
            scan(f);
        }
    }

    // Inserts the worst cell until all are near enough. Only candidates within a tenth of the greatest error wait in
    // the queue: it stays in the cache, and most faces change again before their turn comes.
    void refine(Run const& run) {
        constexpr std::int64_t between_checks = 256;
        for (;;) {
            double const greatest = *std::ranges::max_element(errors_);
            if (!(greatest > error_m_)) {
                return;
            }
            least_m_ = 0.9 * greatest;
            for (std::uint32_t f = 0; f < faces_.size(); ++f) {
                enqueue(f);
            }
            for (std::int64_t done = 0; !queue_.empty(); ++done) {
                if (done % between_checks == 0) {
                    run.check();
                }
                Candidate const worst = queue_.front();
                std::pop_heap(queue_.begin(), queue_.end());
                queue_.pop_back();
                if (errors_[worst.face] == worst.error_m && cells_[worst.face] == worst.cell) {
                    insert(worst.face, worst.cell);
                }
            }
        }
    }

    SimplifiedDem result() const {
        SimplifiedDem simplified;
        Grid const& grid = dem_.grid();
        std::vector<std::pair<std::int64_t, std::uint32_t>> order;
        order.reserve(spots_.size());
        for (Spot const& s : spots_) {
            order.emplace_back(grid.index({s.col, s.row}), static_cast<std::uint32_t>(order.size()));
        }
        std::ranges::sort(order);
        std::vector<std::uint32_t> number(spots_.size());
        simplified.tin.vertices.reserve(spots_.size());
        for (auto const& [cell, v] : order) {
            Vec2 const at = grid.centre({spots_[v].col, spots_[v].row});
            number[v] = static_cast<std::uint32_t>(simplified.tin.vertices.size());
            simplified.tin.vertices.push_back({at.x, at.y, static_cast<double>(spots_[v].z)});
        }
        simplified.tin.triangles.reserve(faces_.size());
        for (Face const& f : faces_) {
            simplified.tin.triangles.push_back({number[f.corner[0]], number[f.corner[1]], number[f.corner[2]]});
        }
        simplified.error_m = *std::ranges::max_element(errors_);
        put_in_order(simplified.tin);
        return simplified;
    }

private:
    struct Face {
        std::array<std::uint32_t, 3> corner;
        std::array<std::uint32_t, 3> beyond; // the neighbouring face opposite each corner
    };
    struct Candidate {
        double error_m = 0.0;
        std::int64_t cell = 0;
        std::uint32_t face = 0;

        // Orders by time of insertion: the lesser is inserted later.
        friend bool operator<(Candidate const& a, Candidate const& b) {
            return a.error_m != b.error_m ? a.error_m < b.error_m : std::tie(b.cell, b.face) < std::tie(a.cell, a.face);
        }
    };

    void join() {
        std::vector<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::size_t>> sides;
        for (std::uint32_t f = 0; f < faces_.size(); ++f) {
            for (std::size_t k = 0; k < 3; ++k) {
                auto const [low, high] = std::minmax(faces_[f].corner[(k + 1) % 3], faces_[f].corner[(k + 2) % 3]);
                sides.emplace_back(low, high, f, k);
            }
        }
        std::ranges::sort(sides);
        for (std::size_t i = 1; i < sides.size(); ++i) {
            auto const& [low, high, f, k] = sides[i - 1];
            auto const& [other_low, other_high, g, j] = sides[i];
            if (low == other_low && high == other_high) {
                faces_[f].beyond[k] = g;
                faces_[g].beyond[j] = f;
            }
        }
    }

    std::uint32_t add_spot(Cell cell) {
        spots_.push_back({static_cast<std::int32_t>(cell.col), static_cast<std::int32_t>(cell.row), dem_[cell]});
        return static_cast<std::uint32_t>(spots_.size() - 1);
    }
    std::uint32_t new_face() {
        faces_.push_back({});
        errors_.push_back(0.0);
        cells_.push_back(-1);
        return static_cast<std::uint32_t>(faces_.size() - 1);
    }
    std::size_t side_towards(std::uint32_t face, std::uint32_t other) const {
        auto const& beyond = faces_[face].beyond;
        return beyond[0] == other ? 0 : beyond[1] == other ? 1 : 2;
    }
    void relink(std::uint32_t face, std::uint32_t before, std::uint32_t now) {
        if (face != nobody) {
            faces_[face].beyond[side_towards(face, before)] = now;
        }
    }

    void insert(std::uint32_t face, std::int64_t cell) {
        std::uint32_t const p = add_spot(dem_.grid().at(cell));
        std::size_t const side = side_through(face, p);
        if (side == 3) {
            split_face(face, p);
        } else {
            split_side(face, side, p);
        }
        while (!loose_.empty()) {
            std::uint32_t const f = loose_.back();
            loose_.pop_back();
            make_delaunay(f, p);
        }
    }

    // The side of a face on which a vertex lies; 3: none.
    std::size_t side_through(std::uint32_t face, std::uint32_t p) const {
        auto const& corner = faces_[face].corner;
        std::size_t on = 3;
        for (std::size_t k = 0; k < 3; ++k) {
            if (turn(spots_[corner[(k + 1) % 3]], spots_[corner[(k + 2) % 3]], spots_[p]) == 0) {
                on = k;
            }
        }
        return on;
    }

    // Splits a face into three around the new vertex, which is the first corner of each.
    void split_face(std::uint32_t face, std::uint32_t p) {
        auto const [a, b, c] = faces_[face].corner;
        auto const [to_a, to_b, to_c] = faces_[face].beyond;
        std::uint32_t const second = new_face();
        std::uint32_t const third = new_face();
        faces_[face] = {{p, b, c}, {to_a, second, third}};
        faces_[second] = {{p, c, a}, {to_b, third, face}};
        faces_[third] = {{p, a, b}, {to_c, face, second}};
        relink(to_b, face, second);
        relink(to_c, face, third);
        loose_ = {face, second, third};
    }

    // Splits both faces of a side in two: (p, apex, one end) and (p, other end, apex).
    void split_side(std::uint32_t face, std::size_t k, std::uint32_t p) {
        std::uint32_t const apex = faces_[face].corner[k];
        std::uint32_t const from = faces_[face].corner[(k + 1) % 3];
        std::uint32_t const to = faces_[face].corner[(k + 2) % 3];
        std::uint32_t const other = faces_[face].beyond[k];
        std::uint32_t const to_from = faces_[face].beyond[(k + 1) % 3]; // opposite `from`: across side to-apex
        std::uint32_t const to_to = faces_[face].beyond[(k + 2) % 3];   // across side apex-from
        std::uint32_t const sister = new_face();
        std::uint32_t other_sister = nobody;
        if (other != nobody) {
            std::size_t const j = side_towards(other, face);
            std::uint32_t const tip = faces_[other].corner[j];
            // The corners of `other` were (tip, to, from): side from-tip is opposite `to`.
            std::uint32_t const along_from = faces_[other].beyond[(j + 1) % 3]; // across side from-tip
            std::uint32_t const along_to = faces_[other].beyond[(j + 2) % 3];   // across side tip-to
            other_sister = new_face();
            faces_[other] = {{p, from, tip}, {along_from, other_sister, face}};
            faces_[other_sister] = {{p, tip, to}, {along_to, sister, other}};
            relink(along_to, other, other_sister);
            loose_.push_back(other);
            loose_.push_back(other_sister);
        }
        faces_[face] = {{p, apex, from}, {to_to, other, sister}};
        faces_[sister] = {{p, to, apex}, {to_from, face, other_sister}};
        relink(to_from, face, sister);
        loose_.push_back(face);
        loose_.push_back(sister);
    }

    // p is the first corner of the face; flips the side opposite it if the corner beyond lies in the circumcircle, else
    // the face stays.
    void make_delaunay(std::uint32_t f, std::uint32_t p) {
        auto const [to_g, bp, pa] = faces_[f].beyond;
        std::uint32_t const g = to_g;
        if (g == nobody) {
            scan(f);
            return;
        }
        std::uint32_t const a = faces_[f].corner[1];
        std::uint32_t const b = faces_[f].corner[2];
        std::size_t const j = side_towards(g, f);
        std::uint32_t const q = faces_[g].corner[j];
        if (!within_circle(spots_[p], spots_[a], spots_[b], spots_[q])) {
            scan(f);
            return;
        }
        std::uint32_t const aq = faces_[g].beyond[(j + 1) % 3]; // corners of g: (q, b, a)
        std::uint32_t const qb = faces_[g].beyond[(j + 2) % 3];
        faces_[f] = {{p, a, q}, {aq, g, pa}};
        faces_[g] = {{p, q, b}, {qb, bp, f}};
        relink(aq, g, f);
        relink(bp, f, g);
        loose_.push_back(f);
        loose_.push_back(g);
    }

    // Finds the worst cell of a face, its sides included, its corners not: rounding must not insert them again.
    void scan(std::uint32_t face) {
        auto const& corner = faces_[face].corner;
        std::array<Spot, 3> const s{spots_[corner[0]], spots_[corner[1]], spots_[corner[2]]};
        double const z0 = static_cast<double>(s[0].z);
        double const z1 = static_cast<double>(s[1].z) - z0;
        double const z2 = static_cast<double>(s[2].z) - z0;
        auto const area = static_cast<double>(turn(s[0], s[1], s[2]));
        auto const d = [](std::int32_t v) { return static_cast<double>(v); };
        double const east = (z1 * d(s[0].row - s[2].row) - z2 * d(s[0].row - s[1].row)) / area;
        double const north = (d(s[1].col - s[0].col) * z2 - d(s[2].col - s[0].col) * z1) / area;

        // Counterclockwise from the uppermost corner: down its west, up its east.
        std::size_t const k = s[0].row <= s[1].row ? (s[0].row <= s[2].row ? 0 : 2) : (s[1].row <= s[2].row ? 1 : 2);
        Spot const& top = s[k];
        Spot const& west = s[(k + 1) % 3];
        Spot const& east_corner = s[(k + 2) % 3];
        double worst = 0.0;
        std::int32_t worst_row = -1;
        std::int32_t worst_first = 0;
        auto const look = [&](std::int32_t row, std::int32_t first, std::int32_t last) {
            if (first > last) {
                return;
            }
            PlaneAlongRow const plane{z0 + north * d(s[0].row - row), east, s[0].col};
            double const most = greatest_error(plane, dem_.row(row).data(), first, last, worst);
            if (most > worst) {
                worst = most;
                worst_row = row;
                worst_first = first;
            }
        };
        SideOfFace left(top, west);
        SideOfFace right(top, east_corner);
        if (west.row == top.row) {
            look(top.row, west.col + 1, top.col - 1);
            left = SideOfFace(west, east_corner);
        } else if (east_corner.row == top.row) {
            look(top.row, top.col + 1, east_corner.col - 1);
            right = SideOfFace(east_corner, west);
        }
        std::int32_t const bottom = std::max(west.row, east_corner.row);
        for (std::int32_t row = top.row + 1; row <= bottom; ++row) {
            left.go_down();
            right.go_down();
            std::int32_t first = left.first();
            std::int32_t last = right.last();
            if (row == west.row) {
                first = west.col + 1;
                left = SideOfFace(west, east_corner);
            }
            if (row == east_corner.row) {
                last = east_corner.col - 1;
                right = SideOfFace(east_corner, west);
            }
            look(row, first, last);
        }
        std::int64_t cell = -1;
        if (worst_row >= 0) {
            PlaneAlongRow const plane{z0 + north * d(s[0].row - worst_row), east, s[0].col};
            float const* const heights = dem_.row(worst_row).data();
            while (plane.error(heights, worst_first) != worst) {
                ++worst_first;
            }
            cell = dem_.grid().index({worst_first, worst_row});
        }
        errors_[face] = worst;
        cells_[face] = cell;
        enqueue(face);
    }

    void enqueue(std::uint32_t face) {
        if (errors_[face] >= least_m_ && errors_[face] > error_m_) {
            queue_.push_back({errors_[face], cells_[face], face});
            std::push_heap(queue_.begin(), queue_.end());
        }
    }

    Raster<float> const& dem_;
    double error_m_;
    std::vector<Spot, LargePages<Spot>> spots_;
    std::vector<Face, LargePages<Face>> faces_;
    std::vector<double, LargePages<double>> errors_;            // of each face
    std::vector<std::int64_t, LargePages<std::int64_t>> cells_; // where that is
    double least_m_ = std::numeric_limits<double>::infinity();  // candidates below wait
    std::vector<Candidate> queue_;
    std::vector<std::uint32_t> loose_; // faces whose side opposite the new vertex is still to be checked
};

void require_sound(Raster<float> const& dem, TinOfDemParams const& params) {
    require_in("geometry.tin_of_dem", "error", params.error_m, Range::above(0.0).or_infinite(), "m");
    refuse_if<BadInput>(dem.width() > most_cells_a_side || dem.height() > most_cells_a_side, "geometry.tin_of_dem",
                        "{} x {} cells: at most {} a side; cut the DEM", dem.width(), dem.height(), most_cells_a_side);
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        if (std::isinf(dem[i])) {
            throw BadInput("geometry.tin_of_dem", fmt::format("the height at column {}, row {} is {}",
                                                              dem.grid().at(i).col, dem.grid().at(i).row, dem[i]));
        }
    }
}

} // namespace

SimplifiedDem tin_of_dem(Raster<float> const& dem, TinOfDemParams const& params, Run const& run) {
    require_sound(dem, params);
    DemLand const land(dem);
    std::int64_t data = 0;
    std::int64_t left_out = 0;
    for (std::int64_t row = 0; row < dem.height(); ++row) {
        for (std::int64_t col = 0; col < dem.width(); ++col) {
            bool const has = land.is_inner(col, row) || land.has(col, row);
            data += has ? 1 : 0;
            left_out += has && !land.holds(col, row) ? 1 : 0;
        }
    }
    auto const lines = outlines_of(dem, land, run);
    refuse_if<BadInput>(lines.empty(), "geometry.tin_of_dem",
                        "of {} x {} cells {} have data, and no three of them meet: there are no triangles", dem.width(),
                        dem.height(), data);
    Mesh mesh(dem, params.error_m, triangulate({}, lines, run).tin, land);
    mesh.refine(run);
    SimplifiedDem simplified = mesh.result();
    simplified.left_out = left_out;
    return simplified;
}

} // namespace thalweg::geometry
