// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/planform/meander.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/geometry/crossings.hpp>
#include <thalweg/network/order/internal/require_trees.hpp>
#include <thalweg/network/planform/internal/crowding.hpp>
#include <thalweg/network/planform/internal/meander.hpp>

// Described in docs/equilibrium.md.

namespace thalweg::network {
namespace {

/// The shares [0,1] of their shifts by which points move.
class Shares {
public:
    explicit Shares(Stems const& stems)
        : stems_(stems), share_(stems.at.size(), 1.0), factor_(share_.size(), 1.0), changed_(stems.stems.size(), 1) {}

    double of(std::size_t point) const { return share_[point]; }
    /// Whether a share of a stem has changed since settle().
    bool changed(std::size_t stem) const { return changed_[stem] != 0; }
    void settle() { std::ranges::fill(changed_, std::uint8_t{0}); }

    /// Halves the shares of points, and reduces those of their neighbours within a distance along the river by less;
    /// small ones become 0.
    /// \return the number of points eased
    std::int64_t ease(std::vector<std::size_t> const& points, double reach_m) {
        constexpr double least = 1.0 / 64.0;
        for (std::size_t const i : points) {
            Stem const& stem = stems_.stems[stems_.stem_of[i]];
            auto const lower = [&](std::size_t j) {
                double const t = std::fabs(stems_.way_m[j] - stems_.way_m[i]) / reach_m;
                if (t < 1.0) {
                    if (factor_[j] == 1.0) {
                        near_.push_back(j);
                    }
                    factor_[j] = std::min(factor_[j], 0.5 + 0.5 * t);
                }
                return t < 1.0;
            };
            for (std::size_t j = i; j < stem.end && lower(j); ++j) {
            }
            for (std::size_t j = i; j-- > stem.begin && lower(j);) {
            }
        }
        std::int64_t eased = 0;
        for (std::size_t const i : near_) {
            double const factor = std::exchange(factor_[i], 1.0);
            if (factor < 1.0 && share_[i] > 0.0) {
                ++eased;
                share_[i] *= factor;
                share_[i] = share_[i] < least ? 0.0 : share_[i];
                changed_[stems_.stem_of[i]] = 1;
            }
        }
        near_.clear();
        return eased;
    }

private:
    Stems const& stems_;
    std::vector<double> share_;         // by point
    std::vector<double> factor_;        // by point: 1 between calls
    std::vector<std::size_t> near_;     // points with a factor below 1
    std::vector<std::uint8_t> changed_; // by stem
};

/// Moves the points of a stem by their shares; a river that joins another follows its mouth.
void shift_stem(Stems const& stems, Stem const& stem, std::vector<Vec2> const& at, std::vector<Vec2> const& shift,
                Shares const& shares, double cell_m, std::vector<Vec2>& out) {
    for (std::size_t i = stem.begin; i < stem.end; ++i) {
        out[i] = {at[i].x + shares.of(i) * shift[i].x, at[i].y + shares.of(i) * shift[i].y};
    }
    if (!stem.joins) {
        return;
    }
    Vec2 const mouth = out[stems.node_point[stem.mouth]];
    Vec2 const by{mouth.x - out[stem.end - 1].x, mouth.y - out[stem.end - 1].y};
    double const reach = std::max(8.0 * cell_m, 3.0 * std::sqrt(by.x * by.x + by.y * by.y));
    double const end_m = stems.way_m[stem.end - 1];
    for (std::size_t i = stem.end; i-- > stem.begin && end_m - stems.way_m[i] < reach;) {
        double const t = (end_m - stems.way_m[i]) / reach;
        double const follows = 1.0 - t * t * (3.0 - 2.0 * t);
        out[i] = {out[i].x + follows * by.x, out[i].y + follows * by.y};
    }
    out[stem.end - 1] = mouth;
}

constexpr double eased_reach = 6.0;   // [cells] along a river on either side of a conflict
constexpr double smoothed_near = 8.0; // [cells] along a river within which smoothing may bring it closer to itself
constexpr int rounds_of_halving = 48;

void check(StreamNetwork const& network, Grid const& grid, std::vector<double> const& area_m2,
           MeanderParams const& params) {
    require_in("network.meander", "gain", params.gain, Range::between(0.0, 2.0));
    require_in("network.meander", "gap_cells", params.gap_cells, Range::between(0.5, 4.0));
    require_trees(network, "network.meander");
    refuse_if<BadInput>(area_m2.size() != network.arc_count(), "network.meander",
                        "{} areas for {} arcs; give those of this network", area_m2.size(), network.arc_count());
    for (std::size_t a = 0; a < network.arc_count(); ++a) {
        refuse_if<BadInput>(!(area_m2[a] >= 0.0) || !std::isfinite(area_m2[a]), "network.meander",
                            "the area of arc {} is {}; it must be 0 or more", a + 1, area_m2[a]);
        if (!(network.length_m(a) > 0.0)) {
            Vec2 const at = network.node(network.from(a)).at;
            throw BadInput("network.meander",
                           fmt::format("arc {} at ({:.3f}, {:.3f}) has no length; remove it", a + 1, at.x, at.y));
        }
        cells_of_vertices(network.arc(a).line, grid, fmt::format("arc {}", a + 1));
    }
}

/// Arcs through points, and the point of each vertex.
struct Lines {
    std::vector<std::vector<Vec2>> line;
    std::vector<std::vector<std::size_t>> point;
};

Lines lines_through(Stems const& stems, StreamNetwork const& network, std::vector<Vec2> const& at) {
    Lines out;
    for (std::size_t a = 0; a < network.arc_count(); ++a) {
        auto& line = out.line.emplace_back();
        auto& point = out.point.emplace_back();
        line.reserve(stems.last_point[a] - stems.first_point[a] + 1);
        point.reserve(line.capacity());
        for (std::size_t i = stems.first_point[a]; i <= stems.last_point[a]; ++i) {
            if (line.empty() || !(line.back() == at[i])) {
                line.push_back(at[i]);
                point.push_back(i);
            }
        }
    }
    return out;
}

/// Points at which arcs meet away from nodes.
std::vector<std::size_t> meeting_points(Lines const& lines, StreamNetwork const& network, Run const& run) {
    std::vector<geometry::EndNodes> nodes;
    for (std::size_t a = 0; a < network.arc_count(); ++a) {
        nodes.push_back({network.from(a), network.to(a)});
    }
    std::vector<std::size_t> found;
    for (geometry::Meeting const& m : geometry::meetings(lines.line, nodes, run)) {
        found.push_back(lines.point[m.line][m.segment]);
        found.push_back(lines.point[m.line][m.segment + 1]);
        found.push_back(lines.point[m.other][m.other_segment]);
        found.push_back(lines.point[m.other][m.other_segment + 1]);
    }
    for (std::size_t a = 0; a < network.arc_count(); ++a) {
        if (lines.line[a].size() < 2) { // collapsed to a point
            found.push_back(lines.point[a].front());
        }
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
}

/// The points, and for those without a remaining shift the position on the larger river that they follow.
std::vector<std::size_t> with_mouths(Stems const& stems, std::vector<std::size_t> points, Shares const& shares) {
    for (std::size_t k = 0; k < points.size(); ++k) {
        Stem const& stem = stems.stems[stems.stem_of[points[k]]];
        if (stem.joins && shares.of(points[k]) == 0.0) {
            points.push_back(stems.node_point[stem.mouth]);
        }
    }
    return points;
}

class Meandering {
public:
    Meandering(StreamNetwork const& network, Grid const& grid, Mask const& land, std::vector<double> const& area_m2,
               MeanderParams const& params, Run const& run)
        : network_(network), area_m2_(area_m2), grid_(grid), land_(land), params_(params), run_(run),
          to_fixed_(distance_to_fixed(network, grid, land)) {
        take_points();
    }

    MeanderedNetwork made() {
        // Reduces the plain's waves until none remain.
        for (double const bend : {1.0, 0.5, 0.25, 0.0}) {
            if (try_with(bend * params_.gain)) {
                return with_vertices();
            }
        }
        out_.network = network_; // rivers that touch after rounding
        return with_vertices();
    }

private:
    MeanderedNetwork with_vertices() {
        out_.vertices = static_cast<std::int64_t>(stems_.at.size());
        return std::move(out_);
    }

    bool try_with(double bend) {
        base_ = bend_plain(stems_.at, to_fixed_, bend, params_.seed);
        for (std::size_t i = 0; i < base_.size(); ++i) {
            base_[i] = settled(i, base_[i]);
        }
        if (!is_proven(base_) || went_to_sea()) {
            return false;
        }
        bool const wanders = params_.gain > 0.0;
        double const cell = grid_.cell_m;
        move(smoothing(stems_, base_, wave_m_, cell, wanders ? Rounding::river : Rounding::half_a_cell),
             smoothed_near * cell);
        if (wanders) {
            move(meander_shifts(stems_, base_, wave_m_, cell, params_.gain, MeanderKind::bends, params_.seed), 0.0);
            refine();
            move(lean_in(stems_, base_, cell, params_.seed), 0.0);
            for (MeanderKind const which : {MeanderKind::reaches, MeanderKind::straights}) {
                move(meander_shifts(stems_, base_, wave_m_, cell, params_.gain, which, params_.seed), 0.0);
            }
        }
        out_.network = through(base_);
        measure_shift();
        return true;
    }

    /// Moves the points as far as rivers keep apart; not at all if that does not converge.
    void move(std::vector<Vec2> const& shift, double near_m) {
        Shares shares(stems_);
        Crowding crowding(stems_, base_, grid_, land_, {params_.gap_cells * grid_.cell_m, near_m});
        std::vector<Vec2> loose(base_.size()); // before rounding
        std::vector<Vec2> at(base_.size());
        for (int round = 0; round < rounds_of_halving; ++round) {
            run_.check();
            shift_changed(shift, shares, loose, at);
            std::vector<std::size_t> bad = crowding.points(at, run_);
            if (bad.empty()) {
                bad = meeting_points(lines_through(stems_, network_, at), network_, run_);
            }
            if (bad.empty()) {
                base_ = std::move(at);
                return;
            }
            ++out_.rounds;
            std::int64_t const eased =
                shares.ease(with_mouths(stems_, std::move(bad), shares), eased_reach * grid_.cell_m);
            if (eased == 0) {
                return;
            }
            out_.eased += eased;
        }
    }

    /// Shifts the stems whose shares or mouths have changed.
    void shift_changed(std::vector<Vec2> const& shift, Shares& shares, std::vector<Vec2>& loose,
                       std::vector<Vec2>& at) const {
        for (std::size_t s = 0; s < stems_.stems.size(); ++s) {
            Stem const& stem = stems_.stems[s];
            bool const follows = stem.joins && !(loose[stems_.node_point[stem.mouth]] == loose[stem.end - 1]);
            if (!shares.changed(s) && !follows) {
                continue;
            }
            shift_stem(stems_, stem, base_, shift, shares, grid_.cell_m, loose);
            for (std::size_t i = stem.begin; i < stem.end; ++i) {
                at[i] = settled(i, loose[i]);
            }
        }
        shares.settle();
    }

    /// A point rounded for output. One that did not move keeps every bit.
    Vec2 settled(std::size_t point, Vec2 p) const { return p == stems_.at[point] ? stems_.at[point] : rounded(p); }

    bool is_proven(std::vector<Vec2> const& at) const {
        return meeting_points(lines_through(stems_, network_, at), network_, run_).empty();
    }

    /// Whether a river that was on land now lies in the sea.
    bool went_to_sea() const {
        for (std::size_t i = 0; i < base_.size(); ++i) {
            if (leaves_land(stems_, base_, i, land_) && !leaves_land(stems_, stems_.at, i, land_)) {
                return true;
            }
        }
        return false;
    }

    /// Bends have lengthened rivers: resamples points a cell apart.
    void refine() {
        network_ = through(base_);
        measure_shift();
        take_points();
        base_ = stems_.at;
    }

    void take_points() {
        stems_ = stems_of(network_, area_m2_, grid_.cell_m);
        wave_m_ = params_.gain > 0.0 ? wavelengths(stems_, grid_.cell_m) : std::vector<double>();
    }

    void measure_shift() {
        double most = 0.0;
        for (std::size_t i = 0; i < base_.size(); ++i) {
            most = std::max(most, distance(base_[i], stems_.at[i]));
        }
        out_.max_shift_m += most;
    }

    StreamNetwork through(std::vector<Vec2> const& at) const {
        Lines lines = lines_through(stems_, network_, at);
        NetworkDraft bent;
        for (NodeId n = 0; n < network_.node_count(); ++n) {
            bool const has_arcs = network_.out(n) != no_arc || !network_.in(n).empty();
            bent.add_node(has_arcs ? at[stems_.node_point[n]] : network_.node(n).at);
        }
        for (std::size_t a = 0; a < network_.arc_count(); ++a) {
            Arc arc = network_.arc(a);
            arc.line = std::move(lines.line[a]);
            bent.add_arc(network_.from(a), network_.to(a), std::move(arc));
        }
        return bent;
    }

    StreamNetwork network_; ///< the input, then bent
    std::vector<double> const& area_m2_;
    Grid const& grid_;
    Mask const& land_;
    MeanderParams const& params_;
    Run const& run_;
    Raster<std::uint8_t> to_fixed_;
    Stems stems_;
    std::vector<double> wave_m_; ///< by point: wavelengths, where rivers wander
    std::vector<Vec2> base_;     ///< by point: the last valid positions
    MeanderedNetwork out_;
};

void require_apart(StreamNetwork const& network, Run const& run) {
    std::vector<std::vector<Vec2>> lines;
    std::vector<geometry::EndNodes> nodes;
    for (std::size_t a = 0; a < network.arc_count(); ++a) {
        auto& line = lines.emplace_back(network.arc(a).line);
        line.erase(std::unique(line.begin(), line.end()), line.end());
        nodes.push_back({network.from(a), network.to(a)});
    }
    auto const found = geometry::meetings(lines, nodes, run);
    if (!found.empty()) {
        geometry::Meeting const& m = found.front();
        throw BadInput("network.meander",
                       fmt::format("arcs {} and {} meet at ({:.3f}, {:.3f}), where no node is; mend the network first",
                                   m.line + 1, m.other + 1, m.at.x, m.at.y));
    }
}

MeanderedNetwork wandering(StreamNetwork const& network, Grid const& grid, Mask const& land,
                           std::vector<double> const& area_m2, MeanderParams const& params, Run const& run) {
    check(network, grid, area_m2, params);
    if (network.arc_count() == 0) {
        return {network, 0, 0, 0, 0.0};
    }
    require_apart(network, run);
    return Meandering(network, grid, land, area_m2, params, run).made();
}

} // namespace

MeanderedNetwork meander(StreamNetwork const& network, Grid const& grid, std::vector<double> const& area_m2,
                         MeanderParams const& params, Run const& run) {
    return wandering(network, grid, {}, area_m2, params, run);
}

MeanderedNetwork meander(StreamNetwork const& network, Mask const& land, std::vector<double> const& area_m2,
                         MeanderParams const& params, Run const& run) {
    return wandering(network, land.grid(), land, area_m2, params, run);
}

} // namespace thalweg::network
