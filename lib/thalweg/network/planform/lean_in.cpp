// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/planform/internal/meander.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/network/planform/internal/smooth_step.hpp>

namespace thalweg::network {

namespace {

constexpr std::uint64_t stage_lean = 0x6c65'616e; // "lean"
constexpr double near_mouth = 10.0;               // [cells] over which angles are measured
constexpr double far_from_mouth = 40.0;           // [cells]

/// The nearest point of a river that lies so far above another one, or its first.
std::size_t above(Stems const& stems, std::size_t from, std::size_t begin, double way) {
    std::size_t i = from;
    while (i > begin && stems.way_m[from] - stems.way_m[i] < way) {
        --i;
    }
    return i;
}

/// Angle [radians] by which a tributary turns about its mouth, counterclockwise.
double turn_of(Stems const& stems, std::vector<Vec2> const& at, Stem const& stem, double cell_m, double widest) {
    std::size_t const mouth = stems.node_point[stem.mouth];
    Stem const& larger = stems.stems[stems.stem_of[mouth]];
    Vec2 const up_larger = at[above(stems, mouth, larger.begin, near_mouth * cell_m)];
    Vec2 const up = at[above(stems, stem.end - 1, stem.begin, near_mouth * cell_m)];
    double const angle = portable::atan2(cross(at[mouth], up, up_larger), dot(up - at[mouth], up_larger - at[mouth]));
    double const over = std::fabs(angle) - widest;
    return over > 0.0 ? std::copysign(over, angle) : 0.0;
}

} // namespace

std::vector<Vec2> lean_in(Stems const& stems, std::vector<Vec2> const& at, double cell_m, std::uint64_t seed) {
    std::vector<Vec2> out(at.size());
    for (Stem const& stem : stems.stems) {
        if (!stem.joins) {
            continue;
        }
        double const widest =
            (50.0 + 30.0 * unit(random_word(seed, stage_lean, stem.source, 0))) * portable::pi / 180.0;
        double const turn = turn_of(stems, at, stem, cell_m, widest);
        Vec2 const mouth = at[stem.end - 1];
        double const end_m = stems.way_m[stem.end - 1];
        for (std::size_t i = stem.end - 1; i-- > stem.begin && end_m - stems.way_m[i] < far_from_mouth * cell_m;) {
            double const far = (end_m - stems.way_m[i]) / cell_m;
            double const by = turn * (1.0 - smooth_step((far - near_mouth) / (far_from_mouth - near_mouth)));
            Vec2 const arm = at[i] - mouth;
            double const c = portable::cos(by);
            double const s = portable::sin(by);
            out[i] = {c * arm.x - s * arm.y - arm.x, s * arm.x + c * arm.y - arm.y};
        }
    }
    return out;
}

} // namespace thalweg::network
