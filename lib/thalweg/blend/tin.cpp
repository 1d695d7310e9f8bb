// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/blend/tin.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include <fmt/format.h>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/solver/linear/linear.hpp>

namespace thalweg::blend {
namespace {

using geometry::Measured;

// Linear combination a x + b y + c z.
Vec3 sum(Vec3 const& row, CoordinateGradients const& g) {
    return {row.x * g.x.x + row.y * g.y.x + row.z * g.z.x, row.x * g.x.y + row.y * g.y.y + row.z * g.z.y,
            row.x * g.x.z + row.y * g.y.z + row.z * g.z.z};
}

Vec3 seen(Vec3 const& p, Measured measured) {
    return {p.x, p.y, measured == Measured::in_plan ? 0.0 : p.z};
}

constexpr std::uint32_t no_unknown = std::numeric_limits<std::uint32_t>::max();

void check(Tin const& parameter, std::vector<CoordinateGradients> const& guidance) {
    refuse_if<BadInput>(guidance.size() != parameter.triangles.size(), "blend.paste_tin",
                        "guidance for {} triangles, the mesh has {}", guidance.size(), parameter.triangles.size());
    for (std::size_t i = 0; i < guidance.size(); ++i) {
        refuse_if<BadInput>(!is_finite(guidance[i].x) || !is_finite(guidance[i].y) || !is_finite(guidance[i].z),
                            "blend.paste_tin", "the guidance of triangle {} is not finite", i + 1);
    }
}

std::vector<std::optional<Vec3>> places_of(Tin const& parameter, std::vector<FixedVertex> const& fixed) {
    std::vector<std::optional<Vec3>> places(parameter.vertices.size());
    for (FixedVertex const& f : fixed) {
        refuse_if<BadInput>(f.vertex >= places.size() || !is_finite(f.at), "blend.paste_tin",
                            "vertex {} of {} is fixed at ({}, {}, {})", f.vertex + 1, places.size(), f.at.x, f.at.y,
                            f.at.z);
        auto& place = places[f.vertex];
        if (place && *place != f.at) {
            throw BadInput("blend.paste_tin",
                           fmt::format("vertex {} is fixed at ({}, {}, {}) and at ({}, {}, {}): give one of them",
                                       f.vertex + 1, place->x, place->y, place->z, f.at.x, f.at.y, f.at.z));
        }
        place = f.at;
    }
    return places;
}

// Every part of the mesh needs a fixed vertex.
void require_held(Tin const& parameter, std::vector<std::optional<Vec3>> const& places) {
    std::vector<std::uint32_t> root(parameter.vertices.size());
    std::iota(root.begin(), root.end(), 0U);
    auto const find = [&](std::uint32_t v) {
        while (root[v] != v) {
            root[v] = root[root[v]];
            v = root[v];
        }
        return v;
    };
    for (auto const& t : parameter.triangles) {
        root[find(t[1])] = find(t[0]);
        root[find(t[2])] = find(t[0]);
    }
    std::vector<std::uint8_t> held(places.size(), 0);
    for (std::uint32_t v = 0; v < places.size(); ++v) {
        if (places[v]) {
            held[find(v)] = 1;
        }
    }
    for (auto const& t : parameter.triangles) {
        if (held[find(t[0])] == 0) {
            Vec3 const& p = parameter.vertices[t[0]];
            throw BadInput(
                "blend.paste_tin",
                fmt::format("the part of the mesh with vertex {} at ({}, {}, {}) has no fixed vertex: fix one",
                            t[0] + 1, p.x, p.y, p.z));
        }
    }
}

/// The unknowns are the shifts of vertices from the parameter mesh: one system per coordinate.
struct System {
    std::vector<std::uint32_t> unknown; // by vertex
    std::uint32_t size = 0;
    std::vector<solver::SparseEntry> entries;      // the lower half
    std::array<std::vector<double>, 3> right = {}; // by coordinate
};

double coordinate(Vec3 const& v, std::size_t k) {
    return k == 0 ? v.x : k == 1 ? v.y : v.z;
}

System system_of(Tin const& parameter, std::vector<CoordinateGradients> const& guidance,
                 std::vector<std::optional<Vec3>> const& places, Measured measured, Run const& run) {
    auto const cotangents = geometry::half_cotangents(parameter, measured);
    auto const own = gradients_of(parameter, parameter.vertices, measured);
    require_held(parameter, places);
    System system;
    std::vector<std::uint8_t> used(places.size(), 0);
    for (auto const& t : parameter.triangles) {
        used[t[0]] = used[t[1]] = used[t[2]] = 1;
    }
    system.unknown.assign(places.size(), no_unknown);
    for (std::size_t v = 0; v < places.size(); ++v) {
        if (used[v] != 0 && !places[v]) {
            system.unknown[v] = system.size++;
        }
    }
    system.right.fill(std::vector<double>(system.size, 0.0));
    auto const add = [&](std::uint32_t i, std::uint32_t j, double weight) {
        std::uint32_t const row = system.unknown[i];
        if (row == no_unknown) {
            return;
        }
        system.entries.push_back({row, row, weight});
        std::uint32_t const column = system.unknown[j];
        if (column == no_unknown) {
            for (std::size_t k = 0; k < 3; ++k) {
                system.right[k][row] += weight * coordinate(*places[j] - parameter.vertices[j], k);
            }
        } else if (column < row) {
            system.entries.push_back({row, column, -weight});
        }
    };
    for (std::size_t i = 0; i < parameter.triangles.size(); ++i) {
        if (i % 4096 == 0) {
            run.check();
        }
        auto const& t = parameter.triangles[i];
        auto const hats = hat_gradients_by_area(parameter.vertices[t[0]], parameter.vertices[t[1]],
                                                parameter.vertices[t[2]], measured);
        std::array<Vec3, 3> const more = {guidance[i].x - own[i].x, guidance[i].y - own[i].y, guidance[i].z - own[i].z};
        for (std::size_t k = 0; k < 3; ++k) {
            add(t[(k + 1) % 3], t[(k + 2) % 3], cotangents[i][k]);
            add(t[(k + 2) % 3], t[(k + 1) % 3], cotangents[i][k]);
            if (std::uint32_t const row = system.unknown[t[k]]; row != no_unknown) {
                for (std::size_t c = 0; c < 3; ++c) {
                    system.right[c][row] += dot(hats[k], more[c]);
                }
            }
        }
    }
    return system;
}

double residual_of(System const& system, std::vector<double> const& x, std::vector<double> const& b) {
    std::vector<double> rest = b;
    for (solver::SparseEntry const& e : system.entries) {
        rest[e.row] -= e.value * x[e.column];
        if (e.row != e.column) {
            rest[e.column] -= e.value * x[e.row];
        }
    }
    double squares = 0.0;
    double all = 0.0;
    for (std::size_t i = 0; i < b.size(); ++i) {
        squares += rest[i] * rest[i];
        all += b[i] * b[i];
    }
    return all > 0.0 ? std::sqrt(squares / all) : 0.0;
}

} // namespace

LinearMap rotation(Vec3 axis, double angle_deg, double scale) {
    double const axis_length = norm(axis);
    refuse_if<BadParameter>(
        !(axis_length > 0.0) || !std::isfinite(axis_length) || !(std::fabs(angle_deg) <= 1e6) || !std::isfinite(scale),
        "blend.rotation", "{} degrees about ({}, {}, {}) with a scale of {}", angle_deg, axis.x, axis.y, axis.z, scale);
    Vec3 const u = (1.0 / axis_length) * axis;
    double const c = portable::cos(angle_deg * (portable::pi / 180.0));
    double const s = portable::sin(angle_deg * (portable::pi / 180.0));
    double const rest = 1.0 - c; // Rodrigues
    return {scale * Vec3{c + u.x * u.x * rest, u.x * u.y * rest - u.z * s, u.x * u.z * rest + u.y * s},
            scale * Vec3{u.y * u.x * rest + u.z * s, c + u.y * u.y * rest, u.y * u.z * rest - u.x * s},
            scale * Vec3{u.z * u.x * rest - u.y * s, u.z * u.y * rest + u.x * s, c + u.z * u.z * rest}};
}

CoordinateGradients mapped(LinearMap const& map, CoordinateGradients const& gradients) {
    return {sum(map[0], gradients), sum(map[1], gradients), sum(map[2], gradients)};
}

std::array<Vec3, 3> hat_gradients_by_area(Vec3 const& a, Vec3 const& b, Vec3 const& c, Measured measured) {
    Vec3 const ab = seen(b - a, measured);
    Vec3 const ac = seen(c - a, measured);
    Vec3 const normal = cross(ab, ac); // its length is twice the area
    Vec3 const half = (0.5 / norm(normal)) * normal;
    return {cross(half, ac - ab), cross(half, -1.0 * ac), cross(half, ab)};
}

std::vector<CoordinateGradients> gradients_of(Tin const& parameter, std::vector<Vec3> const& places,
                                              Measured measured) {
    refuse_if<BadInput>(places.size() != parameter.vertices.size(), "blend.gradients_of",
                        "{} places for a mesh of {} vertices", places.size(), parameter.vertices.size());
    geometry::half_cotangents(parameter, measured); // throws for a triangle without area
    std::vector<CoordinateGradients> gradients;
    gradients.reserve(parameter.triangles.size());
    for (auto const& t : parameter.triangles) {
        auto const corner = [&](std::size_t k) -> Vec3 const& { return parameter.vertices[t[k]]; };
        auto const hats = hat_gradients_by_area(corner(0), corner(1), corner(2), measured);
        double const area =
            0.5 * norm(cross(seen(corner(1) - corner(0), measured), seen(corner(2) - corner(0), measured)));
        // Relative to the first corner: the hat functions sum to 1, their gradients to 0.
        Vec3 const second = (1.0 / area) * (places[t[1]] - places[t[0]]);
        Vec3 const third = (1.0 / area) * (places[t[2]] - places[t[0]]);
        auto const gradient = [&](double at_second, double at_third) {
            return Vec3{at_second * hats[1].x + at_third * hats[2].x, at_second * hats[1].y + at_third * hats[2].y,
                        at_second * hats[1].z + at_third * hats[2].z};
        };
        gradients.push_back({gradient(second.x, third.x), gradient(second.y, third.y), gradient(second.z, third.z)});
    }
    return gradients;
}

PastedTin paste_tin(Tin const& parameter, std::vector<CoordinateGradients> const& guidance,
                    std::vector<FixedVertex> const& fixed, Measured measured, Run const& run) {
    check(parameter, guidance);
    auto const places = places_of(parameter, fixed);
    System const system = system_of(parameter, guidance, places, measured, run);
    PastedTin pasted{parameter};
    for (std::size_t v = 0; v < places.size(); ++v) {
        if (places[v]) {
            pasted.tin.vertices[v] = measured == Measured::on_surface
                                         ? *places[v]
                                         : Vec3{parameter.vertices[v].x, parameter.vertices[v].y, places[v]->z};
        }
    }
    if (system.size == 0) {
        return pasted;
    }
    solver::SparseFactor const factor(system.size, system.entries);
    for (std::size_t k = measured == Measured::on_surface ? 0 : 2; k < 3; ++k) {
        run.check();
        std::vector<double> const moves = factor.solve(system.right[k]);
        pasted.residual = std::max(pasted.residual, residual_of(system, moves, system.right[k]));
        for (std::size_t v = 0; v < places.size(); ++v) {
            if (system.unknown[v] != no_unknown) {
                Vec3& p = pasted.tin.vertices[v];
                (k == 0 ? p.x : k == 1 ? p.y : p.z) += moves[system.unknown[v]];
            }
        }
    }
    return pasted;
}

} // namespace thalweg::blend
