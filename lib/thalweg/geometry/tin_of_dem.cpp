// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/geometry/tin_of_dem.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <queue>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

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
    explicit DemLand(Raster<float> const& dem) : dem_(dem) {}

    bool has(std::int64_t col, std::int64_t row) const {
        return dem_.grid().contains({col, row}) && !std::isnan(dem_[Cell{col, row}]);
    }
    // Number of centres with data at the corners of the square south-east of a centre.
    int corners(std::int64_t col, std::int64_t row) const {
        return (has(col, row) ? 1 : 0) + (has(col + 1, row) ? 1 : 0) + (has(col, row + 1) ? 1 : 0) +
               (has(col + 1, row + 1) ? 1 : 0);
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
    std::int64_t x = 0; // column
    std::int64_t y = 0; // minus the row
};

std::int64_t turn(Spot a, Spot b, Spot c) {
    return (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
}

bool within_circle(Spot a, Spot b, Spot c, Spot p) {
    __extension__ using Wide = __int128;
    auto const square = [&](Spot s) { return (s.x - p.x) * (s.x - p.x) + (s.y - p.y) * (s.y - p.y); };
    return Wide{turn(p, b, c)} * square(a) + Wide{turn(p, c, a)} * square(b) + Wide{turn(p, a, b)} * square(c) > 0;
}

// Division towards minus infinity; b > 0.
std::int64_t floor_of(std::int64_t a, std::int64_t b) {
    return a >= 0 ? a / b : -((-a + b - 1) / b);
}
std::int64_t ceil_of(std::int64_t a, std::int64_t b) {
    return -floor_of(-a, b);
}

// A fraction, denominator > 0.
struct Fraction {
    std::int64_t over = 0;
    std::int64_t under = 1;
};

class Mesh {
public:
    Mesh(Raster<float> const& dem, double error_m, Tin const& first, DemLand const& land)
        : dem_(dem), error_m_(error_m) {
        for (Vec3 const& v : first.vertices) {
            spots_.push_back({static_cast<std::int64_t>(v.x), static_cast<std::int64_t>(v.y)});
        }
        for (auto const& t : first.triangles) {
            std::int64_t const x = spots_[t[0]].x + spots_[t[1]].x + spots_[t[2]].x;
            std::int64_t const y = spots_[t[0]].y + spots_[t[1]].y + spots_[t[2]].y;
            if (land.is_inside(x, -y)) {
                faces_.push_back({t, {nobody, nobody, nobody}});
            }
        }
        join();
        stamps_.resize(faces_.size(), 0);
        for (std::uint32_t f = 0; f < faces_.size(); ++f) {
            scan(f);
        }
    }

    void refine(Run const& run) {
        constexpr std::int64_t between_checks = 256;
        for (std::int64_t done = 0; !queue_.empty(); ++done) {
            if (done % between_checks == 0) {
                run.check();
            }
            Candidate const worst = queue_.top();
            queue_.pop();
            if (stamps_[worst.face] == worst.stamp) {
                insert(worst.face, worst.cell);
            }
        }
    }

    SimplifiedDem result() const {
        SimplifiedDem simplified;
        Grid const& grid = dem_.grid();
        std::vector<std::uint32_t> order(spots_.size());
        std::iota(order.begin(), order.end(), 0U);
        std::ranges::sort(order, {}, [&](std::uint32_t v) { return std::pair(-spots_[v].y, spots_[v].x); });
        std::vector<std::uint32_t> number(spots_.size());
        for (std::uint32_t const v : order) {
            Cell const cell{spots_[v].x, -spots_[v].y};
            Vec2 const at = grid.centre(cell);
            number[v] = static_cast<std::uint32_t>(simplified.tin.vertices.size());
            simplified.tin.vertices.push_back({at.x, at.y, static_cast<double>(dem_[cell])});
        }
        for (Face const& f : faces_) {
            simplified.tin.triangles.push_back({number[f.corner[0]], number[f.corner[1]], number[f.corner[2]]});
            simplified.error_m = std::max(simplified.error_m, f.error_m);
        }
        put_in_order(simplified.tin);
        return simplified;
    }

private:
    struct Face {
        std::array<std::uint32_t, 3> corner;
        std::array<std::uint32_t, 3> beyond; // the neighbouring face opposite each corner
        double error_m = 0.0;
    };
    struct Candidate {
        double error_m = 0.0;
        std::int64_t cell = 0;
        std::uint32_t face = 0;
        std::uint32_t stamp = 0;

        // Orders by time of insertion: the lesser is inserted later.
        friend bool operator<(Candidate const& a, Candidate const& b) {
            return std::tie(a.error_m, b.cell, b.face) < std::tie(b.error_m, a.cell, a.face);
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

    std::size_t side_towards(std::uint32_t face, std::uint32_t other) const {
        auto const& beyond = faces_[face].beyond;
        return beyond[0] == other ? 0 : beyond[1] == other ? 1 : 2;
    }

    void set(std::uint32_t face, std::array<std::uint32_t, 3> corner, std::array<std::uint32_t, 3> beyond) {
        faces_[face].corner = corner;
        faces_[face].beyond = beyond;
        changed_.push_back(face);
    }
    void relink(std::uint32_t face, std::uint32_t before, std::uint32_t now) {
        if (face != nobody) {
            faces_[face].beyond[side_towards(face, before)] = now;
        }
    }
    std::uint32_t new_face() {
        faces_.push_back({});
        stamps_.push_back(0);
        return static_cast<std::uint32_t>(faces_.size() - 1);
    }

    void insert(std::uint32_t face, std::int64_t cell) {
        auto const p = static_cast<std::uint32_t>(spots_.size());
        Cell const at = dem_.grid().at(cell);
        spots_.push_back({at.col, -at.row});
        changed_.clear();
        loose_.clear();
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
        std::ranges::sort(changed_);
        changed_.erase(std::unique(changed_.begin(), changed_.end()), changed_.end());
        for (std::uint32_t const f : changed_) {
            ++stamps_[f];
            scan(f);
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

    // Splits a face into three around the new vertex.
    void split_face(std::uint32_t face, std::uint32_t p) {
        auto const [a, b, c] = faces_[face].corner;
        auto const [to_a, to_b, to_c] = faces_[face].beyond;
        std::uint32_t const second = new_face();
        std::uint32_t const third = new_face();
        set(face, {p, b, c}, {to_a, second, third});
        set(second, {p, c, a}, {to_b, third, face});
        set(third, {p, a, b}, {to_c, face, second});
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
            std::uint32_t const along_from = faces_[other].beyond[(j + 1) % 3]; // across side from-tip
            std::uint32_t const along_to = faces_[other].beyond[(j + 2) % 3];   // across side tip-to
            other_sister = new_face();
            set(other, {p, from, tip}, {nobody, other_sister, nobody});
            set(other_sister, {p, tip, to}, {along_to, nobody, other});
            // The corners of `other` were (tip, to, from): side from-tip is opposite `to`.
            faces_[other].beyond = {along_from, other_sister, face};
            faces_[other_sister].beyond = {along_to, sister, other};
            relink(along_to, other, other_sister);
            loose_.push_back(other);
            loose_.push_back(other_sister);
        }
        set(face, {p, apex, from}, {to_to, other, sister});
        set(sister, {p, to, apex}, {to_from, face, other_sister});
        relink(to_from, face, sister);
        loose_.push_back(face);
        loose_.push_back(sister);
    }

    // p is a corner of the face; flips the side opposite it if the corner beyond lies in the circumcircle.
    void make_delaunay(std::uint32_t f, std::uint32_t p) {
        std::size_t const k = faces_[f].corner[0] == p ? 0 : faces_[f].corner[1] == p ? 1 : 2;
        std::uint32_t const g = faces_[f].beyond[k];
        if (g == nobody) {
            return;
        }
        std::uint32_t const a = faces_[f].corner[(k + 1) % 3];
        std::uint32_t const b = faces_[f].corner[(k + 2) % 3];
        std::size_t const j = side_towards(g, f);
        std::uint32_t const q = faces_[g].corner[j];
        if (!within_circle(spots_[p], spots_[a], spots_[b], spots_[q])) {
            return;
        }
        std::uint32_t const pa = faces_[f].beyond[(k + 2) % 3];
        std::uint32_t const bp = faces_[f].beyond[(k + 1) % 3];
        std::uint32_t const aq = faces_[g].beyond[(j + 1) % 3]; // corners of g: (q, b, a)
        std::uint32_t const qb = faces_[g].beyond[(j + 2) % 3];
        set(f, {p, a, q}, {aq, g, pa});
        set(g, {p, q, b}, {qb, bp, f});
        relink(aq, g, f);
        relink(bp, f, g);
        loose_.push_back(f);
        loose_.push_back(g);
    }

    // Finds the worst cell of a face, its sides included.
    void scan(std::uint32_t face) {
        auto const& corner = faces_[face].corner;
        std::array<Spot, 3> s{spots_[corner[0]], spots_[corner[1]], spots_[corner[2]]};
        auto const z = [&](Spot v) { return static_cast<double>(dem_[Cell{v.x, -v.y}]); };
        Spot const at = s[0];
        double const z0 = z(s[0]);
        double const z1 = z(s[1]) - z0;
        double const z2 = z(s[2]) - z0;
        auto const area = static_cast<double>(turn(s[0], s[1], s[2]));
        auto const d = [](std::int64_t v) { return static_cast<double>(v); };
        double const east = (z1 * d(s[2].y - at.y) - z2 * d(s[1].y - at.y)) / area;
        double const north = (d(s[1].x - at.x) * z2 - d(s[2].x - at.x) * z1) / area;
        std::ranges::sort(s, {}, &Spot::y);
        Candidate worst{0.0, -1, face, stamps_[face]};
        for (std::int64_t y = s[2].y; y >= s[0].y; --y) {
            auto const crossing = [&](Spot low, Spot high) {
                return Fraction{low.x * (high.y - low.y) + (y - low.y) * (high.x - low.x), high.y - low.y};
            };
            Fraction const whole = crossing(s[0], s[2]);
            Fraction const broken = y == s[1].y  ? Fraction{s[1].x, 1}
                                    : y < s[1].y ? crossing(s[0], s[1])
                                                 : crossing(s[1], s[2]);
            bool const whole_first = d(whole.over) * d(broken.under) <= d(broken.over) * d(whole.under);
            Fraction const left = whole_first ? whole : broken;
            Fraction const right = whole_first ? broken : whole;
            std::int64_t const end = floor_of(right.over, right.under);
            float const* const heights = dem_.row(-y).data();
            double const at_row = z0 + north * d(y - at.y);
            for (std::int64_t x = ceil_of(left.over, left.under); x <= end; ++x) {
                double const error = std::fabs(at_row + east * d(x - at.x) - static_cast<double>(heights[x]));
                // Rounding at a corner must not insert it again.
                if (error > worst.error_m && !is_corner(s, x, y)) {
                    worst.error_m = error;
                    worst.cell = dem_.grid().index({x, -y});
                }
            }
        }
        faces_[face].error_m = worst.error_m;
        if (worst.error_m > error_m_) {
            queue_.push(worst);
        }
    }

    static bool is_corner(std::array<Spot, 3> const& s, std::int64_t x, std::int64_t y) {
        return std::ranges::any_of(s, [&](Spot v) { return v.x == x && v.y == y; });
    }

    Raster<float> const& dem_;
    double error_m_;
    std::vector<Spot> spots_;
    std::vector<Face> faces_;
    std::vector<std::uint32_t> stamps_; // number of changes of each face: invalidates older candidates
    std::priority_queue<Candidate> queue_;
    std::vector<std::uint32_t> changed_;
    std::vector<std::uint32_t> loose_; // faces whose side opposite the new vertex is still to be checked
};

void require_sound(Raster<float> const& dem, TinOfDemParams const& params) {
    require_in("geometry.tin_of_dem", "error", params.error_m, Range::above(0.0).or_infinite(), "m");
    refuse_if<BadInput>(dem.width() > most_cells_a_side || dem.height() > most_cells_a_side,
                        "geometry.tin_of_dem: {} x {} cells: at most {} a side; cut the DEM", dem.width(), dem.height(),
                        most_cells_a_side);
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        if (std::isinf(dem[i])) {
            throw BadInput(fmt::format("geometry.tin_of_dem: the height at column {}, row {} is {}",
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
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        Cell const c = dem.grid().at(i);
        bool const has = !std::isnan(dem[i]);
        data += has ? 1 : 0;
        left_out += has && !land.holds(c.col, c.row) ? 1 : 0;
    }
    auto const lines = outlines_of(dem, land, run);
    refuse_if<BadInput>(
        lines.empty(),
        "geometry.tin_of_dem: of {} x {} cells {} have data, and no three of them meet: there are no triangles",
        dem.width(), dem.height(), data);
    Mesh mesh(dem, params.error_m, triangulate({}, lines, run).tin, land);
    mesh.refine(run);
    SimplifiedDem simplified = mesh.result();
    simplified.left_out = left_out;
    return simplified;
}

} // namespace thalweg::geometry
