// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/lattice.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>

namespace thalweg {
namespace {

/// The cells along one axis that a vertex is made of.
struct Taps {
    std::int64_t first = 0;
    std::vector<double> weights; ///< their sum is 1; of cubic convolution some are below 0
    std::vector<double> plain;   ///< none is below 0: for cells beside others without data, and the limits of overshoot
    std::int64_t nearest = 0;
};

/// The integral of the hat function of width 2 from its left end.
double hat_up_to(double u) {
    if (u <= 0.0) {
        double const in = std::max(u + 1.0, 0.0);
        return 0.5 * in * in;
    }
    double const left = std::max(1.0 - u, 0.0);
    return 1.0 - 0.5 * left * left;
}

/// Mean of the linear interpolant within half of x.
void average_taps(Taps& taps, double x, double half, std::int64_t cells) {
    auto const from = std::max<std::int64_t>(0, static_cast<std::int64_t>(std::floor(x - half)));
    auto const to = std::min(cells - 1, static_cast<std::int64_t>(std::floor(x + half)) + 1);
    taps.first = from;
    for (std::int64_t c = from; c <= to; ++c) {
        double const off = x - static_cast<double>(c);
        taps.plain.push_back(half > 0.0 ? (hat_up_to(off + half) - hat_up_to(off - half)) / (2.0 * half)
                                        : std::max(0.0, 1.0 - std::fabs(off)));
    }
    taps.weights = taps.plain;
}

/// Cubic convolution (a = -1/2); a cell beyond the edge lies on the line through the two before it.
void cubic_taps(Taps& taps, double x, std::int64_t cells) {
    std::int64_t const left = std::min(static_cast<std::int64_t>(std::floor(x)), cells - 2);
    double const t = x - static_cast<double>(left);
    std::array<double, 4> w = {((-0.5 * t + 1.0) * t - 0.5) * t, (1.5 * t - 2.5) * t * t + 1.0,
                               ((-1.5 * t + 2.0) * t + 0.5) * t, (0.5 * t - 0.5) * t * t};
    if (left == 0) {
        w[1] += 2.0 * w[0];
        w[2] -= w[0];
        w[0] = 0.0;
    }
    if (left == cells - 2) {
        w[2] += 2.0 * w[3];
        w[1] -= w[3];
        w[3] = 0.0;
    }
    taps.first = std::max<std::int64_t>(left - 1, 0);
    for (std::int64_t c = taps.first; c <= std::min(left + 2, cells - 1); ++c) {
        taps.weights.push_back(w[static_cast<std::size_t>(c - left + 1)]);
        taps.plain.push_back(std::max(0.0, 1.0 - std::fabs(x - static_cast<double>(c))));
    }
}

std::vector<Taps> taps_of_axis(std::int64_t cells, std::int64_t vertices) {
    std::vector<Taps> axis(static_cast<std::size_t>(vertices));
    double const step = static_cast<double>(cells - 1) / static_cast<double>(vertices - 1);
    for (std::int64_t i = 0; i < vertices; ++i) {
        Taps& taps = axis[static_cast<std::size_t>(i)];
        // exact at both ends, and where vertices are cells
        double const x = static_cast<double>(i * (cells - 1)) / static_cast<double>(vertices - 1);
        if (step < 1.0) {
            cubic_taps(taps, x, cells);
        } else {
            double const half = step == 1.0 ? 0.0 : std::min({0.5 * step, x, static_cast<double>(cells - 1) - x});
            average_taps(taps, x, half, cells);
        }
        taps.nearest = static_cast<std::int64_t>(std::floor(x + 0.5));
    }
    return axis;
}

/// The height at a vertex.
float vertex_height(Raster<float> const& dem, Taps const& column, Taps const& row) {
    if (std::isnan(dem[Cell{column.nearest, row.nearest}])) {
        return std::numeric_limits<float>::quiet_NaN();
    }
    double sum = 0.0;
    double plain_sum = 0.0;
    double plain_weight = 0.0;
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    bool is_whole = true;
    for (std::size_t r = 0; r < row.weights.size(); ++r) {
        auto const cells = dem.row(row.first + static_cast<std::int64_t>(r));
        for (std::size_t c = 0; c < column.weights.size(); ++c) {
            double const weight = row.weights[r] * column.weights[c];
            double const plain = row.plain[r] * column.plain[c];
            if (weight == 0.0 && plain == 0.0) {
                continue;
            }
            auto const z = static_cast<double>(cells[static_cast<std::size_t>(column.first) + c]);
            if (std::isnan(z)) {
                is_whole = false;
                continue;
            }
            sum += weight * z;
            if (plain > 0.0) {
                plain_sum += plain * z;
                plain_weight += plain;
                low = std::min(low, z);
                high = std::max(high, z);
            }
        }
    }
    return static_cast<float>(std::clamp(is_whole ? sum : plain_sum / plain_weight, low, high));
}

/// Vertices of a lattice in the frame of its mesh.
class LatticeFrame {
public:
    LatticeFrame(Lattice const& of, double exaggeration) : of_(of), exaggeration_(exaggeration) {
        require_in("core.surface_mesh", "exaggeration", exaggeration, Range::above(0.0));
        double low = std::numeric_limits<double>::infinity();
        for (float const z : of.z.values()) {
            low = std::isnan(z) ? low : std::min(low, static_cast<double>(z));
        }
        Vec2 const half = 0.5 * of.extent_m();
        origin_ = {of.north_west().x + half.x, of.north_west().y - half.y, low};
        half_ = half;
    }
    Vec3 at(std::int64_t col, std::int64_t row) const {
        return {static_cast<double>(col) * of_.z.grid().cell_m - half_.x,
                half_.y - static_cast<double>(row) * of_.row_step_m,
                (static_cast<double>(of_.z[Cell{col, row}]) - origin_.z) * exaggeration_};
    }
    Vec3 origin() const { return origin_; }

private:
    Lattice const& of_;
    double exaggeration_;
    Vec3 origin_;
    Vec2 half_;
};

constexpr std::uint32_t no_vertex = std::numeric_limits<std::uint32_t>::max();

/// Three corners of a square of vertices, by index of the lattice's vertices.
using Corners = std::array<std::int64_t, 3>;

/// The triangles between four vertices; cell: the vertex in the north-west.
struct SplitSquare {
    std::array<Corners, 2> triangles{};
    int count = 0;
};
SplitSquare cut_at(Raster<float> const& z, Cell cell) {
    std::int64_t const nw = z.grid().index(cell);
    std::array<std::int64_t, 4> const corners = {nw, nw + z.width(), nw + z.width() + 1, nw + 1}; // from above
    auto const at = [&](std::size_t k) { return corners[k % 4]; };
    std::size_t hole = 4;
    int holes = 0;
    for (std::size_t k = 0; k < 4; ++k) {
        if (std::isnan(z[at(k)])) {
            hole = k;
            ++holes;
        }
    }
    if (holes == 0) {
        std::size_t const k = std::fabs(z[at(0)] - z[at(2)]) <= std::fabs(z[at(1)] - z[at(3)]) ? 0 : 1;
        return {{Corners{at(k), at(k + 1), at(k + 2)}, Corners{at(k), at(k + 2), at(k + 3)}}, 2};
    }
    return holes == 1 ? SplitSquare{{Corners{at(hole + 1), at(hole + 2), at(hole + 3)}}, 1} : SplitSquare{};
}

/// Calls add(corners) for the triangles of a lattice.
template <class Add> void for_triangles(Raster<float> const& z, Run const& run, Add const& add) {
    for (std::int64_t row = 0; row + 1 < z.height(); ++row) {
        run.check();
        for (std::int64_t col = 0; col + 1 < z.width(); ++col) {
            SplitSquare const cut = cut_at(z, {col, row});
            for (int k = 0; k < cut.count; ++k) {
                add(cut.triangles[static_cast<std::size_t>(k)]);
            }
        }
    }
}

} // namespace

Lattice lattice(Raster<float> const& dem, std::int64_t width, std::int64_t height, Run const& run) {
    constexpr double most = 16385.0;
    require_in("core.lattice", "width", width, Range::between(2.0, most), "vertices");
    require_in("core.lattice", "height", height, Range::between(2.0, most), "vertices");
    refuse_if<BadInput>(dem.width() < 2 || dem.height() < 2, "core.lattice",
                        "the DEM has {} x {} cells: a mesh needs at least 2 x 2", dem.width(), dem.height());
    Grid grid = dem.grid();
    Vec2 const first = grid.centre({0, 0});
    double const cell_m = grid.cell_m;
    auto const step = [cell_m](std::int64_t cells, std::int64_t vertices) {
        return cells == vertices ? cell_m : cell_m * static_cast<double>(cells - 1) / static_cast<double>(vertices - 1);
    };
    if (width != grid.width || height != grid.height) {
        grid.width = width;
        grid.height = height;
        grid.cell_m = step(dem.width(), width);
        grid.west = first.x - 0.5 * grid.cell_m;
        grid.north = first.y + 0.5 * grid.cell_m;
    }
    Lattice out{Raster<float>(grid), step(dem.height(), height)};
    std::vector<Taps> const columns = taps_of_axis(dem.width(), width);
    std::vector<Taps> const rows = taps_of_axis(dem.height(), height);
    constexpr std::int64_t band = 256;
    for (std::int64_t from = 0; from < height; from += band) {
        run.at(static_cast<double>(from) / static_cast<double>(height), "resample");
        parallel_ranges(run, std::min(band, height - from), 8, [&](std::int64_t begin, std::int64_t end) {
            for (std::int64_t row = from + begin; row < from + end; ++row) {
                for (std::int64_t col = 0; col < width; ++col) {
                    out.z[Cell{col, row}] =
                        vertex_height(dem, columns[static_cast<std::size_t>(col)], rows[static_cast<std::size_t>(row)]);
                }
            }
        });
    }
    return out;
}

LatticeMesh surface_mesh(Lattice const& lattice, double exaggeration, Run const& run) {
    Raster<float> const& z = lattice.z;
    LatticeFrame const frame(lattice, exaggeration);
    LatticeMesh mesh{{}, {}, {}, frame.origin()};
    std::vector<std::uint32_t> number(static_cast<std::size_t>(z.cells()), no_vertex);
    for_triangles(z, run, [&](Corners const& corners) {
        for (std::int64_t const i : corners) {
            number[static_cast<std::size_t>(i)] = 0;
        }
    });
    for (std::int64_t i = 0; i < z.cells(); ++i) {
        if (number[static_cast<std::size_t>(i)] != no_vertex) {
            Cell const c = z.grid().at(i);
            number[static_cast<std::size_t>(i)] = static_cast<std::uint32_t>(mesh.vertices.size());
            mesh.vertices.push_back(frame.at(c.col, c.row));
            mesh.places.push_back({static_cast<double>(c.col) / static_cast<double>(z.width() - 1),
                                   static_cast<double>(c.row) / static_cast<double>(z.height() - 1)});
        }
    }
    refuse_if<BadInput>(mesh.vertices.empty(), "core.surface_mesh", "no three vertices side by side have heights");
    for_triangles(z, run, [&](Corners const& corners) {
        auto const of = [&](std::size_t k) { return number[static_cast<std::size_t>(corners[k])]; };
        mesh.triangles.push_back({of(0), of(1), of(2)});
    });
    return mesh;
}

double height_on_mesh(Lattice const& lattice, Vec2 position) {
    Raster<float> const& z = lattice.z;
    Vec2 const first = lattice.north_west();
    double const x = (position.x - first.x) / z.grid().cell_m;
    double const y = (first.y - position.y) / lattice.row_step_m;
    double const none = std::numeric_limits<double>::quiet_NaN();
    if (!(x >= 0.0 && y >= 0.0 && x <= static_cast<double>(z.width() - 1) &&
          y <= static_cast<double>(z.height() - 1))) {
        return none;
    }
    Cell const cell{std::min(static_cast<std::int64_t>(x), z.width() - 2),
                    std::min(static_cast<std::int64_t>(y), z.height() - 2)};
    auto const place = [&](std::int64_t i) {
        Cell const c = z.grid().at(i);
        return Vec2{static_cast<double>(c.col), static_cast<double>(-c.row)};
    };
    Vec2 const p{x, -y};
    SplitSquare const cut = cut_at(z, cell);
    for (int k = 0; k < cut.count; ++k) {
        auto const& [a, b, c] = cut.triangles[static_cast<std::size_t>(k)];
        double const of_a = cross(p, place(b), place(c)); // twice the area of the triangle is 1
        double const of_b = cross(p, place(c), place(a));
        double const of_c = cross(p, place(a), place(b));
        if (std::min({of_a, of_b, of_c}) >= -1e-9) {
            return of_a * static_cast<double>(z[a]) + of_b * static_cast<double>(z[b]) +
                   of_c * static_cast<double>(z[c]);
        }
    }
    return none;
}

LatticeMesh solid_mesh(Lattice const& lattice, double base_m, double exaggeration, Run const& run) {
    require_in("core.solid_mesh", "base", base_m, Range::above(0.0), "m");
    Raster<float> const& z = lattice.z;
    for (std::int64_t i = 0; i < z.cells(); ++i) {
        if (!std::isfinite(z[i])) {
            Cell const c = z.grid().at(i);
            refuse_if<BadInput>(true, "core.solid_mesh",
                                "the vertex at column {}, row {} has no height: a solid has none missing; fill the "
                                "DEM's holes first (gdal_fillnodata.py)",
                                c.col, c.row);
        }
    }
    LatticeMesh mesh = surface_mesh(lattice, exaggeration, run);
    mesh.places.clear();
    std::vector<std::uint32_t> rim; // counterclockwise from above
    auto const add = [&](std::int64_t col, std::int64_t row) {
        rim.push_back(static_cast<std::uint32_t>(z.grid().index({col, row})));
    };
    std::int64_t const east = z.width() - 1;
    std::int64_t const south = z.height() - 1;
    for (std::int64_t row = 0; row < south; ++row) {
        add(0, row);
    }
    for (std::int64_t col = 0; col < east; ++col) {
        add(col, south);
    }
    for (std::int64_t row = south; row > 0; --row) {
        add(east, row);
    }
    for (std::int64_t col = east; col > 0; --col) {
        add(col, 0);
    }
    double const floor_z = -base_m * exaggeration;
    auto const feet = static_cast<std::uint32_t>(mesh.vertices.size());
    for (std::uint32_t const top : rim) {
        Vec3 const v = mesh.vertices[top];
        mesh.vertices.push_back({v.x, v.y, floor_z});
    }
    auto const middle = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.push_back({0.0, 0.0, floor_z});
    for (std::size_t k = 0; k < rim.size(); ++k) {
        std::size_t const next = (k + 1) % rim.size();
        auto const foot = static_cast<std::uint32_t>(feet + k);
        auto const next_foot = static_cast<std::uint32_t>(feet + next);
        mesh.triangles.push_back({rim[next], rim[k], foot});
        mesh.triangles.push_back({rim[next], foot, next_foot});
        mesh.triangles.push_back({next_foot, foot, middle});
    }
    return mesh;
}

} // namespace thalweg
