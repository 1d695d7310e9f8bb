// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/tin/level_areas.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/solver/linear/linear.hpp>

namespace thalweg::surface {
namespace {

using Corner = std::uint32_t;

std::uint64_t edge_key(Corner a, Corner b) {
    return (std::uint64_t{std::min(a, b)} << 32U) | std::max(a, b);
}

bool is_level(Tin const& tin, std::size_t t) {
    auto const& v = tin.triangles[t];
    double const z = tin.vertices[v[0]].z;
    return tin.vertices[v[1]].z == z && tin.vertices[v[2]].z == z;
}

/// The vertices that share an edge with each vertex.
std::vector<std::vector<Corner>> beside_vertices(Tin const& tin) {
    std::vector<std::vector<Corner>> beside(tin.vertices.size());
    for (auto const& t : tin.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            beside[t[k]].push_back(t[(k + 1) % 3]);
            beside[t[k]].push_back(t[(k + 2) % 3]);
        }
    }
    for (std::vector<Corner>& of : beside) {
        std::ranges::sort(of);
        of.erase(std::unique(of.begin(), of.end()), of.end());
    }
    return beside;
}

/// Finds the vertices around a place that tell its height.
class Samples {
public:
    explicit Samples(Tin const& tin) : tin_(tin), beside_(beside_vertices(tin)), ring_(tin.vertices.size(), 0) {}

    /// \param a, b vertices beside the place
    std::vector<Vec3> around(Vec2 place, Corner a, Corner b) {
        std::vector<Corner> const near = rings_around(a, b);
        std::array<std::vector<std::pair<double, Corner>>, 8> octants;
        for (Corner const v : near) {
            Vec2 const off = in_plan(tin_.vertices[v]) - place;
            octants[octant_of(off)].emplace_back(off.x * off.x + off.y * off.y, v);
        }
        std::vector<Vec3> out;
        for (auto& octant : octants) {
            std::ranges::sort(octant);
            take_from(octant, out);
        }
        return out;
    }

private:
    static std::size_t octant_of(Vec2 off) {
        std::size_t const quadrant = (off.y < 0.0 ? 2U : 0U) + (off.x < 0.0 ? 1U : 0U);
        return 2 * quadrant + (std::fabs(off.x) < std::fabs(off.y) ? 1U : 0U);
    }

    /// The nearest two vertices of each of the nearest three heights.
    void take_from(std::vector<std::pair<double, Corner>> const& octant, std::vector<Vec3>& out) const {
        std::vector<std::pair<double, int>> heights;
        for (auto const& [away, v] : octant) {
            double const z = tin_.vertices[v].z;
            auto found = std::ranges::find(heights, z, &std::pair<double, int>::first);
            if (found == heights.end()) {
                if (heights.size() == 3) {
                    return;
                }
                found = heights.insert(heights.end(), {z, 0});
            }
            if (found->second < 2) {
                ++found->second;
                out.push_back(tin_.vertices[v]);
            }
        }
    }

    /// Vertices a few edges away, until there are three heights.
    std::vector<Corner> rings_around(Corner a, Corner b) {
        constexpr int fewest_rings = 4;
        constexpr int most_rings = 12;
        constexpr std::size_t most = 1500;
        ++round_;
        std::vector<Corner> near{a, b};
        std::vector<double> heights;
        ring_[a] = ring_[b] = round_;
        std::size_t begin = 0;
        for (int ring = 0; ring < most_rings && near.size() < most; ++ring) {
            std::size_t const end = near.size();
            for (std::size_t i = begin; i < end; ++i) {
                for (Corner const v : beside_[near[i]]) {
                    if (ring_[v] != round_) {
                        ring_[v] = round_;
                        near.push_back(v);
                    }
                }
            }
            for (std::size_t i = begin; i < near.size() && heights.size() < 4; ++i) {
                double const z = tin_.vertices[near[i]].z;
                if (std::ranges::find(heights, z) == heights.end()) {
                    heights.push_back(z);
                }
            }
            begin = end;
            if (ring + 1 >= fewest_rings && heights.size() > 3) {
                break;
            }
        }
        return near;
    }

    Tin const& tin_;
    std::vector<std::vector<Corner>> beside_;
    std::vector<std::uint32_t> ring_; ///< by vertex: the round that saw it last
    std::uint32_t round_ = 0;
};

/// r^2 ln r^2.
double bending(Vec2 off) {
    double const r2 = off.x * off.x + off.y * off.y;
    return r2 > 0.0 ? r2 * portable::log(r2) : 0.0;
}

/// The height of a thin-plate spline at a place.
double spline_at(Vec2 place, std::vector<Vec3> const& samples) {
    std::size_t const n = samples.size();
    double reach = 0.0;
    for (Vec3 const& s : samples) {
        reach = std::max(reach, norm(in_plan(s) - place));
    }
    std::vector<Vec2> at;
    for (Vec3 const& s : samples) { // the place is the origin: of the plane only its constant counts there
        at.push_back((1.0 / reach) * (in_plan(s) - place));
    }
    solver::Matrix matrix(n + 3, n + 3);
    std::vector<double> right(n + 3, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = 0; k < n; ++k) {
            matrix.at(i, k) = bending(at[i] - at[k]);
        }
        std::array<double, 3> const plane{1.0, at[i].x, at[i].y};
        for (std::size_t k = 0; k < 3; ++k) {
            matrix.at(i, n + k) = matrix.at(n + k, i) = plane[k];
        }
        right[i] = samples[i].z - samples.front().z;
    }
    std::vector<double> const weights = solver::least_squares(matrix, right).x;
    double z = samples.front().z + weights[n];
    for (std::size_t i = 0; i < n; ++i) {
        z += weights[i] * bending(at[i]);
    }
    return z;
}

/// The height between contours at a place on the chord of one; nothing: all samples have that contour's height.
std::optional<double> height_between(Vec2 place, double contour_m, std::vector<Vec3> const& samples) {
    double interval = std::numeric_limits<double>::infinity();
    for (Vec3 const& s : samples) {
        interval = s.z == contour_m ? interval : std::min(interval, std::fabs(s.z - contour_m));
    }
    constexpr std::size_t fewest = 6;
    if (!std::isfinite(interval) || samples.size() < fewest) {
        return std::nullopt;
    }
    constexpr double most = 0.95; // of the interval, or the next contour would be there
    double const rise = spline_at(place, samples) - contour_m;
    return contour_m + std::clamp(rise, -most * interval, most * interval);
}

} // namespace

double level_share(Tin const& tin) {
    double level_m2 = 0.0;
    double all_m2 = 0.0;
    for (std::size_t t = 0; t < tin.triangles.size(); ++t) {
        auto const& v = tin.triangles[t];
        double const m2 = 0.5 * std::fabs(cross(in_plan(tin.vertices[v[0]]), in_plan(tin.vertices[v[1]]),
                                                in_plan(tin.vertices[v[2]])));
        all_m2 += m2;
        level_m2 += is_level(tin, t) ? m2 : 0.0;
    }
    return all_m2 > 0.0 ? level_m2 / all_m2 : 0.0;
}

std::vector<Vec3> medial_points(geometry::Triangulation const& contours, Run const& run) {
    Tin const& tin = contours.tin;
    std::unordered_set<std::uint64_t> lines; // only looked up
    for (auto const& chain : contours.chains) {
        for (std::size_t i = 1; i < chain.size(); ++i) {
            lines.insert(edge_key(chain[i - 1], chain[i]));
        }
    }
    std::unordered_map<std::uint64_t, int> level_sides; // only looked up: -1 with a triangle that is not level
    for (std::size_t t = 0; t < tin.triangles.size(); ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
            int& sides = level_sides[edge_key(tin.triangles[t][k], tin.triangles[t][(k + 1) % 3])];
            sides = !is_level(tin, t) || sides < 0 ? -1 : sides + 1;
        }
    }
    Samples samples(tin);
    std::vector<Vec3> points;
    for (std::size_t t = 0; t < tin.triangles.size(); ++t) {
        if (!is_level(tin, t)) {
            continue;
        }
        run.at(static_cast<double>(t) / static_cast<double>(tin.triangles.size()), "level areas");
        for (std::size_t k = 0; k < 3; ++k) {
            Corner const a = tin.triangles[t][k];
            Corner const b = tin.triangles[t][(k + 1) % 3];
            int& sides = level_sides.at(edge_key(a, b));
            if (sides < 1 || lines.contains(edge_key(a, b))) {
                continue;
            }
            sides = -1; // once
            Vec2 const middle = 0.5 * (in_plan(tin.vertices[a]) + in_plan(tin.vertices[b]));
            double const z = tin.vertices[a].z;
            auto const height = height_between(middle, z, samples.around(middle, a, b));
            if (height && *height != z) {
                points.push_back({middle.x, middle.y, *height});
            }
        }
    }
    return points;
}

} // namespace thalweg::surface
