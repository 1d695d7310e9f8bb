// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/network/planform/internal/meander.hpp>

// Described in docs/equilibrium.md.

namespace thalweg::network {
namespace {

double smooth_step(double t) {
    double const u = std::clamp(t, 0.0, 1.0);
    return u * u * (3.0 - 2.0 * u);
}

/// By node: the largest arc upstream; no_arc: a source.
std::vector<ArcId> main_arcs(StreamNetwork const& network, std::vector<double> const& area_m2) {
    std::vector<ArcId> out(network.node_count(), no_arc);
    for (NodeId n = 0; n < out.size(); ++n) {
        for (ArcId const a : network.in(n)) {
            if (out[n] == no_arc || area_m2[a] > area_m2[out[n]]) {
                out[n] = a;
            }
        }
    }
    return out;
}

void add_point(Stems& out, Vec2 at, double area_m2) {
    bool const first = out.at.size() == out.stems.back().begin;
    out.way_m.push_back(first ? 0.0 : out.way_m.back() + distance(out.at.back(), at));
    out.at.push_back(at);
    out.area_m2.push_back(area_m2);
    out.stem_of.push_back(static_cast<std::uint32_t>(out.stems.size() - 1));
}

/// Adds an arc's points; its first already exists if the stem continues.
void add_arc_points(Stems& out, std::vector<Vec2> const& line, double area_m2, double step_m) {
    if (out.at.size() == out.stems.back().begin) {
        add_point(out, line.front(), area_m2);
    }
    for (std::size_t i = 1; i < line.size(); ++i) {
        if (line[i] == line[i - 1]) {
            continue;
        }
        auto const [count, step] = steps_between(line[i - 1], line[i], step_m);
        for (double k = 1.0; k < count; k += 1.0) {
            add_point(out, {line[i - 1].x + k * step.x, line[i - 1].y + k * step.y}, area_m2);
        }
        add_point(out, line[i], area_m2);
    }
}

constexpr std::uint64_t stage_plain = 0x6265'6e64;    // "bend"
constexpr std::uint64_t stage_river = 0x7761'6e64;    // "wand"
constexpr std::uint64_t stage_reach = 0x7265'6163;    // "reac"
constexpr std::uint64_t stage_straight = 0x7374'7261; // "stra"
constexpr double floor_cells = 0.08;                  // width of a valley floor divided by area ^ 0.4 (cells)
constexpr double wave_widths = 12.0;                  // wavelength relative to the width
constexpr double shortest_wave = 10.0;                // [cells]
constexpr double longest_reach = 20.0;                // [cells]
constexpr double straight_reach = 11.0;               // [cells] on either side
constexpr double amplitude = 0.16;                    // relative to the wavelength
constexpr std::array<double, 3> long_waves = {160.0, 72.0, 32.0}; // [cells]
constexpr std::uint64_t waves_each = 4;
constexpr double shear = 0.22;  // slope of one wave
constexpr double margin = 24.0; // [cells] over which the plain's waves fade

/// A river's points, and their derived values.
struct River {
    std::size_t begin;
    std::size_t end;
    std::vector<double> const& way_m;

    /// The first point at least this far along the river; `end`: none. Looks from a point that is near.
    std::size_t first(double way, std::size_t near) const {
        std::size_t low = near;
        std::size_t high = near;
        if (way_m[near] < way) {
            for (std::size_t step = 1; high < end && way_m[high] < way; step *= 2) {
                low = high;
                high += std::min(step, end - high);
            }
        } else {
            for (std::size_t step = 1; low > begin && !(way_m[low] < way); step *= 2) {
                high = low;
                low -= std::min(step, low - begin);
            }
        }
        auto const from = way_m.begin();
        return static_cast<std::size_t>(
            std::lower_bound(from + static_cast<std::ptrdiff_t>(low), from + static_cast<std::ptrdiff_t>(high), way) -
            from);
    }
};

/// Unit vector to the left of a river, from points a quarter wave upstream and downstream.
Vec2 across(Stem const& stem, std::vector<double> const& way_m, std::vector<Vec2> const& at, std::size_t i,
            double reach) {
    River const river{stem.begin, stem.end, way_m};
    std::size_t const last = stem.end - 1;
    std::size_t const up = std::min(river.first(way_m[i] - reach, i), i > stem.begin ? i - 1 : i);
    std::size_t const down = std::max(std::min(river.first(way_m[i] + reach, i), last), std::min(i + 1, last));
    double const length = distance(at[up], at[down]);
    if (!(length > 0.0)) {
        return {};
    }
    return {-(at[down].y - at[up].y) / length, (at[down].x - at[up].x) / length};
}

/// A shear wave: moves positions along its crests and preserves areas.
struct Wave {
    Vec2 across; ///< unit vector
    double number = 0.0;
    double phase = 0.0;
    double amplitude = 0.0;
};

std::vector<Wave> waves_of(Grid const& grid, double gain, std::uint64_t seed) {
    std::vector<Wave> out;
    auto const least = static_cast<double>(std::min(grid.width, grid.height));
    for (double const cells : long_waves) {
        double const wave = std::min(cells, 0.5 * least) * grid.cell_m;
        for (std::uint64_t k = 0; k < waves_each; ++k) {
            auto const words = random_block(seed, stage_plain, static_cast<std::uint64_t>(cells), k);
            double const way = 2.0 * portable::pi * unit(words[0]);
            out.push_back({{portable::cos(way), portable::sin(way)},
                           2.0 * portable::pi / wave,
                           2.0 * portable::pi * unit(words[1]),
                           gain * shear * wave / (2.0 * portable::pi)});
        }
    }
    return out;
}

/// A raster's value at a position, bilinear between cell centres.
double between_cells(Raster<std::uint8_t> const& raster, Vec2 p) {
    Grid const& grid = raster.grid();
    double const x = (p.x - grid.west) / grid.cell_m - 0.5;
    double const y = (grid.north - p.y) / grid.cell_m - 0.5;
    double const col = std::floor(x);
    double const row = std::floor(y);
    auto const corner = [&](double dx, double dy) {
        Cell const c{std::clamp<std::int64_t>(static_cast<std::int64_t>(col + dx), 0, grid.width - 1),
                     std::clamp<std::int64_t>(static_cast<std::int64_t>(row + dy), 0, grid.height - 1)};
        return static_cast<double>(raster[c]);
    };
    double const north = corner(0.0, 0.0) * (1.0 - (x - col)) + corner(1.0, 0.0) * (x - col);
    double const south = corner(0.0, 1.0) * (1.0 - (x - col)) + corner(1.0, 1.0) * (x - col);
    return north * (1.0 - (y - row)) + south * (y - row);
}

/// Length of river represented by each point [m].
std::vector<double> weights(Stems const& stems) {
    std::vector<double> out(stems.at.size(), 0.0);
    for (Stem const& stem : stems.stems) {
        for (std::size_t i = stem.begin + 1; i < stem.end; ++i) {
            double const half = 0.5 * (stems.way_m[i] - stems.way_m[i - 1]);
            out[i - 1] += half;
            out[i] += half;
        }
    }
    return out;
}

/// The weighted mean of values within a distance of a point, with parabolic weights; the distance shrinks towards the
/// ends, so that these stay.
class MeanNear {
public:
    explicit MeanNear(Stems const& stems) : stems_(stems), weight_(weights(stems)) {}

    /// Calls add(point, share) for the points near one.
    template <class Add> void each(std::size_t i, double reach, Add add) {
        Stem const& stem = stems_.stems[stems_.stem_of[i]];
        std::vector<double> const& way_m = stems_.way_m;
        double const way = way_m[i];
        double const within = std::min({reach, way - way_m[stem.begin], way_m[stem.end - 1] - way});
        std::size_t const first = River{stem.begin, stem.end, way_m}.first(way - within, i);
        std::size_t last = first;
        while (last < stem.end && way_m[last] <= way + within) {
            ++last;
        }
        parts_.resize(last - first);
        double const reached = within > 0.0 ? within : 1.0; // 0: only the point itself
        for (std::size_t k = 0; k < parts_.size(); ++k) {
            double const t = (way_m[first + k] - way) / reached;
            parts_[k] = weight_[first + k] * (1.0 - t * t);
        }
        double sum = 0.0;
        for (double const part : parts_) {
            sum += part;
        }
        if (!(sum > 0.0)) {
            add(i, 1.0);
            return;
        }
        for (double& part : parts_) {
            part /= sum;
        }
        for (std::size_t k = 0; k < parts_.size(); ++k) {
            add(first + k, parts_[k]);
        }
    }

private:
    Stems const& stems_;
    std::vector<double> weight_;
    std::vector<double> parts_; ///< keeps its memory
};

/// Half waves along a river: extremes of random size, at least `least`, mostly on alternating sides, joined smoothly.
class Noise {
public:
    Noise(double least, double takes_turns, std::uint64_t seed, std::uint64_t stage, std::uint64_t river)
        : least_(least), takes_turns_(takes_turns), seed_(seed), stage_(stage), river_(river) {
        go_to(0);
    }

    double operator()(double half_waves) {
        double const floor = std::floor(half_waves);
        if (auto const k = static_cast<std::uint64_t>(floor); k != at_) {
            go_to(k);
        }
        return here_ + (next_ - here_) * smooth_step(half_waves - floor);
    }

private:
    void go_to(std::uint64_t k) {
        at_ = k;
        here_ = extreme(k);
        next_ = extreme(k + 1);
    }

    double extreme(std::uint64_t k) const {
        auto const words = random_block(seed_, stage_, river_, k);
        double const size = least_ + (1.0 - least_) * unit(words[0]);
        bool const odd = (k % 2 == 1) != (unit(words[1]) > takes_turns_);
        return odd ? -size : size;
    }

    double least_;
    double takes_turns_;
    std::uint64_t seed_;
    std::uint64_t stage_;
    std::uint64_t river_;
    std::uint64_t at_ = 0; ///< number of the last half wave, with the extremes at its ends
    double here_ = 0.0;
    double next_ = 0.0;
};

/// [0, 1] straightness of a river on both sides of a point: 1 within half a cell of its chord, 0 beyond one and a half.
double straightness(Stem const& stem, std::vector<double> const& way_m, std::vector<Vec2> const& at, std::size_t i,
                    double cell_m) {
    double const reach = straight_reach * cell_m;
    if (way_m[i] - way_m[stem.begin] < reach || way_m[stem.end - 1] - way_m[i] < reach) {
        return 0.0;
    }
    River const river{stem.begin, stem.end, way_m};
    std::size_t const up = river.first(way_m[i] - reach, i);
    std::size_t const down = river.first(way_m[i] + reach, i);
    double const length = distance(at[up], at[down]);
    if (!(length > reach)) {
        return 0.0;
    }
    double off = 0.0;
    for (std::size_t j = up; j <= down; ++j) {
        off = std::max(off, std::fabs(cross(at[up], at[down], at[j])) / length);
    }
    return smooth_step(1.5 - off / cell_m);
}

/// [m] by point from its river's beginning at the current positions: bends have lengthened the rivers.
std::vector<double> stretched_distances(Stems const& stems, std::vector<Vec2> const& at) {
    std::vector<double> way_m(at.size(), 0.0);
    for (Stem const& stem : stems.stems) {
        for (std::size_t i = stem.begin + 1; i < stem.end; ++i) {
            way_m[i] = way_m[i - 1] + distance(at[i - 1], at[i]);
        }
    }
    return way_m;
}

/// Parameters of a kind of wandering.
struct Kind {
    std::uint64_t stage;
    double least;       ///< minimum extreme relative to the largest
    double takes_turns; ///< how often extremes alternate sides
};

Kind kind_of(MeanderKind which) {
    switch (which) {
    case MeanderKind::bends: return {stage_river, 0.35, 0.8};
    case MeanderKind::reaches: return {stage_reach, 0.7, 0.8};
    case MeanderKind::straights: break;
    }
    return {stage_straight, 0.7, 1.0};
}

constexpr std::uint64_t stage_lean = 0x6c65'616e; // "lean"
constexpr double near_mouth = 10.0;               // [cells] over which angles are measured
constexpr double far_from_mouth = 40.0;           // [cells]

/// The nearest point of a river at this distance upstream of another one, or its first.
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

EvenSteps steps_between(Vec2 from, Vec2 to, double step_m) {
    // Diagonal steps of a lattice are not subdivided.
    double const count = std::ceil(distance(from, to) / (1.5 * step_m));
    return {count, {(to.x - from.x) / count, (to.y - from.y) / count}};
}

Stems stems_of(StreamNetwork const& network, std::vector<double> const& area_m2, double step_m) {
    Stems out;
    out.first_point.resize(network.arc_count());
    out.last_point.resize(network.arc_count());
    out.node_point.resize(network.node_count());
    std::vector<ArcId> const main = main_arcs(network, area_m2);
    for (NodeId const mouth : network.upstream_order()) { // every stem after its receiver
        bool const is_outlet = network.out(mouth) == no_arc;
        std::vector<ArcId> arriving(network.in(mouth).begin(), network.in(mouth).end());
        std::stable_partition(arriving.begin(), arriving.end(), [&](ArcId a) { return a == main[mouth]; });
        for (ArcId const last : arriving) {
            if (!is_outlet && last == main[mouth]) {
                continue; // in the middle of a stem
            }
            std::vector<ArcId> arcs;
            for (ArcId a = last; a != no_arc; a = main[network.from(a)]) {
                arcs.push_back(a);
            }
            std::reverse(arcs.begin(), arcs.end());
            bool const owns_mouth = is_outlet && last == main[mouth];
            out.stems.push_back({out.at.size(), 0, network.from(arcs.front()), mouth, !owns_mouth});
            for (std::size_t const a : arcs) {
                add_arc_points(out, network.arc(a).line, area_m2[a], step_m);
                out.last_point[a] = out.at.size() - 1;
                out.first_point[a] = a == arcs.front() ? out.stems.back().begin : out.node_point[network.from(a)];
                out.node_point[network.from(a)] = out.first_point[a];
                if (a != arcs.back() || owns_mouth) {
                    out.node_point[network.to(a)] = out.last_point[a];
                }
            }
            out.stems.back().end = out.at.size();
        }
    }
    out.at.shrink_to_fit(); // much of the memory that meanders take
    out.way_m.shrink_to_fit();
    out.area_m2.shrink_to_fit();
    out.stem_of.shrink_to_fit();
    return out;
}

Raster<std::uint8_t> distance_to_fixed(StreamNetwork const& network, Grid const& grid, Mask const& land) {
    auto const far = static_cast<std::uint8_t>(margin);
    Raster<std::uint8_t> out(grid, far);
    std::vector<std::int64_t> front;
    auto const fix = [&](Cell c) {
        if (grid.contains(c) && out[c] != 0) {
            out[c] = 0;
            front.push_back(grid.index(c));
        }
    };
    for (std::int64_t i = 0; i < land.cells(); ++i) {
        if (land[i] == 0) {
            fix(grid.at(i));
        }
    }
    for (NodeId const outlet : network.outlets()) {
        Cell const at = grid.cell_of(network.node(outlet).at);
        fix(at);
        for (Cell const step : d8_steps) {
            fix({at.col + step.col, at.row + step.row});
        }
    }
    for (std::size_t k = 0; k < front.size(); ++k) { // breadth first
        Cell const c = grid.at(front[k]);
        auto const next = static_cast<std::uint8_t>(out[c] + 1);
        for (Cell const step : d8_steps) {
            Cell const n{c.col + step.col, c.row + step.row};
            if (grid.contains(n) && next < out[n]) {
                out[n] = next;
                front.push_back(grid.index(n));
            }
        }
    }
    return out;
}

std::vector<Vec2> bend_plain(std::vector<Vec2> at, Raster<std::uint8_t> const& to_fixed, double gain,
                             std::uint64_t seed) {
    if (!(gain > 0.0)) {
        return at;
    }
    Grid const& grid = to_fixed.grid();
    std::vector<Wave> const waves = waves_of(grid, gain, seed);
    for (Vec2& p : at) {
        double const inside = std::min({p.x - grid.west, grid.east() - p.x, grid.north - p.y, p.y - grid.south()});
        double const fades =
            smooth_step(inside / (margin * grid.cell_m)) * smooth_step(between_cells(to_fixed, p) / margin);
        Vec2 shift;
        for (Wave const& wave : waves) {
            double const along = (p.x - grid.west) * wave.across.x + (grid.north - p.y) * wave.across.y;
            double const by = fades * wave.amplitude * portable::sin(wave.number * along + wave.phase);
            shift = shift + Vec2{by * wave.across.y, by * wave.across.x}; // y grows to the north
        }
        p = p + shift;
    }
    return at;
}

std::vector<double> wavelengths(Stems const& stems, double cell_m) {
    std::vector<double> own(stems.at.size());
    for (std::size_t i = 0; i < own.size(); ++i) {
        if (i > 0 && stems.area_m2[i] == stems.area_m2[i - 1]) { // on the same arc
            own[i] = own[i - 1];
            continue;
        }
        double const cells = std::max(stems.area_m2[i] / (cell_m * cell_m), 1.0);
        own[i] = cell_m * std::max(shortest_wave, wave_widths * floor_cells * portable::pow(cells, 0.4));
    }
    MeanNear mean(stems);
    std::vector<double> out(own.size(), 0.0);
    for (std::size_t i = 0; i < own.size(); ++i) {
        mean.each(i, own[i], [&](std::size_t j, double share) { out[i] += share * own[j]; });
    }
    return out;
}

std::vector<Vec2> smoothing(Stems const& stems, std::vector<Vec2> const& at, std::vector<double> const& wave_m,
                            double cell_m, Rounding rounding) {
    MeanNear mean_near(stems);
    std::vector<Vec2> out(at.size());
    for (std::size_t i = 0; i < at.size(); ++i) {
        double const reach = rounding == Rounding::river ? 2.5 * cell_m + 0.1 * wave_m[i] : 2.0 * cell_m;
        Vec2 mean;
        mean_near.each(i, reach, [&](std::size_t j, double share) {
            mean = {mean.x + share * at[j].x, mean.y + share * at[j].y};
        });
        double const far = distance(mean, at[i]);
        double const most = 0.5 * cell_m;
        double const share = rounding == Rounding::half_a_cell && far > most ? most / far : 1.0;
        out[i] = {share * (mean.x - at[i].x), share * (mean.y - at[i].y)};
    }
    if (rounding == Rounding::half_a_cell) {
        for (std::size_t const node : stems.node_point) { // points after a node would move by more
            out[node] = {};
        }
    }
    return out;
}

std::vector<Vec2> meander_shifts(Stems const& stems, std::vector<Vec2> const& at, std::vector<double> wave_m,
                                 double cell_m, double gain, MeanderKind which, std::uint64_t seed) {
    bool const bends = which == MeanderKind::bends;
    auto const [stage, least, takes_turns] = kind_of(which);
    for (double& wave : wave_m) {
        wave = bends ? wave : std::clamp(wave / 4.0, shortest_wave * cell_m, longest_reach * cell_m);
    }
    std::vector<double> const way_m = which == MeanderKind::straights ? stretched_distances(stems, at) : stems.way_m;
    std::vector<Vec2> out(at.size());
    for (Stem const& stem : stems.stems) {
        Noise noise(least, takes_turns, seed, stage, stem.source);
        double half_waves = unit(random_word(seed, stage, stem.source, ~0ULL));
        double const end_m = way_m[stem.end - 1];
        for (std::size_t i = stem.begin; i < stem.end; ++i) {
            double const step = i == stem.begin ? 0.0 : way_m[i] - way_m[i - 1];
            half_waves += 2.0 * step / wave_m[i];
            double const fades = smooth_step((end_m - way_m[i]) / (0.5 * wave_m[i]));
            double const where = which == MeanderKind::straights ? straightness(stem, way_m, at, i, cell_m) : 1.0;
            double const by = where * fades * gain * amplitude * wave_m[i] * noise(half_waves);
            Vec2 const left = across(stem, way_m, at, i, 0.25 * wave_m[i]);
            out[i] = {by * left.x, by * left.y};
        }
    }
    return out;
}

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
