// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/blend/paste_tin.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/solver/linear/sparse.hpp>

namespace thalweg::blend {
namespace {

using geometry::Measured;

constexpr std::uint32_t no_unknown = std::numeric_limits<std::uint32_t>::max();

bool is_finite(Vec3 const& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

void check(Tin const& parameter, std::vector<CoordinateGradients> const& guidance) {
    if (guidance.size() != parameter.triangles.size()) {
        throw BadInput(fmt::format("blend.paste_tin: guidance for {} triangles, the mesh has {}", guidance.size(),
                                   parameter.triangles.size()));
    }
    for (std::size_t i = 0; i < guidance.size(); ++i) {
        if (!is_finite(guidance[i].x) || !is_finite(guidance[i].y) || !is_finite(guidance[i].z)) {
            throw BadInput(fmt::format("blend.paste_tin: the guidance of triangle {} is not finite", i + 1));
        }
    }
}

std::vector<std::optional<Vec3>> places_of(Tin const& parameter, std::vector<FixedVertex> const& fixed) {
    std::vector<std::optional<Vec3>> places(parameter.vertices.size());
    for (FixedVertex const& f : fixed) {
        if (f.vertex >= places.size() || !is_finite(f.at)) {
            throw BadInput(fmt::format("blend.paste_tin: vertex {} of {} is fixed at ({}, {}, {})", f.vertex + 1,
                                       places.size(), f.at.x, f.at.y, f.at.z));
        }
        auto& place = places[f.vertex];
        if (place && *place != f.at) {
            throw BadInput(fmt::format("blend.paste_tin: vertex {} is fixed at ({}, {}, {}) and at ({}, {}, {}): give "
                                       "one of them",
                                       f.vertex + 1, place->x, place->y, place->z, f.at.x, f.at.y, f.at.z));
        }
        place = f.at;
    }
    return places;
}

// Every part of the mesh must hang on a fixed vertex.
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
            throw BadInput(fmt::format("blend.paste_tin: the part of the mesh with vertex {} at ({}, {}, {}) has no "
                                       "fixed vertex: fix one",
                                       t[0] + 1, p.x, p.y, p.z));
        }
    }
}

/// What is sought is how far vertices move from the parameter mesh, a system for each coordinate.
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
