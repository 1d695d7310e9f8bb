// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/elevation/set_heights.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/network/order/internal/require_trees.hpp>

namespace thalweg::network {
namespace {

// The next larger double; 0 counts as the least height above 0.
double next_above(double below) {
    return below * (1.0 + 0x1p-52);
}

// Checks that heights can be assigned: as require_trees, and no arc has length 0.
void require_positive_lengths(StreamNetwork const& network, std::string_view who) {
    require_trees(network, who);
    for (std::size_t a = 0; a < network.arc_count(); ++a) {
        if (!(network.length_m(a) > 0.0)) {
            Vec2 const at = network.node(network.from(a)).at;
            throw BadInput(std::string(who),
                           fmt::format("arc {} at ({:.3f}, {:.3f}) has no length; remove it", a + 1, at.x, at.y));
        }
    }
}

// Distances [m] of a line's vertices from its first.
std::vector<double> distances_along(std::vector<Vec2> const& line) {
    std::vector<double> way{0.0};
    for (std::size_t i = 1; i < line.size(); ++i) {
        way.push_back(way.back() + distance(line[i - 1], line[i]));
    }
    return way;
}

// Interpolates heights of a line's vertices, from z_up to z_down as `way` grows from 0 to its last value, above 0.
// Returns the ends bit for bit; no vertex is above the previous one if z_up > z_down.
std::vector<double> between(std::vector<double> const& way, double z_up, double z_down) {
    std::vector<double> z;
    double const lower = std::min(z_up, z_down);
    double const upper = std::max(z_up, z_down);
    for (double const so_far : way) {
        // Every operation is monotone in so_far, so no vertex rises; the clamp keeps the last ones above the end.
        z.push_back(std::clamp(z_up + (z_down - z_up) * (so_far / way.back()), lower, upper));
    }
    z.back() = z_down;
    return z;
}

// Throws BadInput naming the node when a height is not a number (lengths or slopes beyond the range of double).
void require_heights(StreamNetwork const& network, std::vector<double> const& node_z, std::string_view who) {
    for (std::size_t n = 0; n < node_z.size(); ++n) {
        if (!std::isfinite(node_z[n])) {
            throw BadInput(std::string(who),
                           fmt::format("the height of the node at ({}, {}) is not a finite number; the rivers "
                                       "below it are too long, or too steep",
                                       network.node(n).at.x, network.node(n).at.y));
        }
    }
}

// Assigns node heights to a network, with vertices linear by length along arcs. Throws as require_heights.
ElevatedNetwork elevate_linearly(StreamNetwork const& network, std::vector<double> node_z, std::string_view who) {
    require_heights(network, node_z, who);
    ElevatedNetwork raised{network, std::move(node_z), {}};
    for (std::size_t a = 0; a < network.arc_count(); ++a) {
        raised.arc_z.push_back(between(distances_along(network.arc(a).line), raised.node_z[network.from(a)],
                                       raised.node_z[network.to(a)]));
    }
    return raised;
}

/// The least slope of a repaired arc as a share of the wanted slope (docs/decisions/0004-heights.md).
constexpr double least_share = 0.01;

std::vector<double> straight_heights(StreamNetwork const& network, double slope) {
    std::vector<double> z(network.node_count(), 0.0);
    for (NodeId const n : network.upstream_order()) {
        NodeId const outlet = network.outlets()[network.basin(n) - 1];
        z[n] = slope * distance(network.node(n).at, network.node(outlet).at);
    }
    return z;
}

/// From the outlet upstream: at least `floor`, and above the next node downstream by `least_slope` along the arc.
std::vector<double> majorant(StreamNetwork const& network, std::vector<double> const& floor, double least_slope) {
    std::vector<double> z(floor);
    for (NodeId const n : network.upstream_order()) {
        if (network.out(n) == no_arc) {
            continue;
        }
        auto const arc = network.out(n);
        double const below = z[network.to(arc)];
        // A rise smaller than one ulp would leave the arc level.
        z[n] = std::max({floor[n], below + least_slope * network.length_m(arc), next_above(below)});
    }
    return z;
}

void report_uphill(StreamNetwork const& network, std::vector<double> const& straight, HeightReport& report) {
    for (std::size_t a = 0; a < network.arc_count(); ++a) {
        double const rise = straight[network.to(a)] - straight[network.from(a)];
        if (rise >= 0.0) {
            ++report.uphill_arcs;
            report.uphill_length_m += network.length_m(a);
            report.max_rise_m = std::max(report.max_rise_m, rise);
        }
    }
}

void report_lift(std::vector<double> const& straight, std::vector<double> const& z, HeightReport& report) {
    double squares = 0.0;
    for (std::size_t n = 0; n < z.size(); ++n) {
        if (double const lift = z[n] - straight[n]; lift > 0.0) {
            ++report.lifted;
            report.max_lift_m = std::max(report.max_lift_m, lift);
            squares += lift * lift;
        }
    }
    if (report.lifted > 0) {
        report.rms_lift_m = std::sqrt(squares / static_cast<double>(report.lifted));
    }
}

void require(GradedParams const& params) {
    constexpr char const* self = "network.set_heights_graded";
    require_in(self, "slope", params.slope, Range::above(0.0));
    require_in(self, "theta", params.theta, Range::between(0.0, 1.0));
    require_in(self, "least_area_m2", params.least_area_m2, Range::above(0.0));
}

void require_areas(StreamNetwork const& network, std::vector<double> const& us_area_m2,
                   std::vector<double> const& ds_area_m2) {
    std::size_t const arcs = network.arc_count();
    refuse_if<BadInput>(us_area_m2.size() != arcs || ds_area_m2.size() != arcs, "network.set_heights_graded",
                        "{} and {} areas for {} arcs; give one for each end", us_area_m2.size(), ds_area_m2.size(),
                        arcs);
    for (std::size_t a = 0; a < arcs; ++a) {
        for (double const area : {us_area_m2[a], ds_area_m2[a]}) {
            if (!(area >= 0.0) || !std::isfinite(area)) {
                Vec2 const at = network.node(network.from(a)).at;
                throw BadInput(
                    "network.set_heights_graded",
                    fmt::format("an area of arc {} at ({:.3f}, {:.3f}) is {} m2; it must be a number of 0 or more",
                                a + 1, at.x, at.y, area));
            }
        }
    }
}

/// One half of the points and weights of Gauss-Legendre quadrature on [-1, 1].
struct Abscissa {
    double at;
    double weight;
};
constexpr std::array<Abscissa, 4> gauss_8{{{0.1834346424956498049, 0.3626837833783619830},
                                           {0.5255324099163289858, 0.3137066458778872873},
                                           {0.7966664774136267396, 0.2223810344533744706},
                                           {0.9602898564975362317, 0.1012285362903762591}}};

/// Integral of A^-theta from area a to b, 0 < a <= b <= panel_ratio a: exact to rounding.
double panel(double a, double b, double theta) {
    double const middle = 0.5 * (a + b);
    double const half = 0.5 * (b - a);
    double sum = 0.0;
    for (Abscissa const& x : gauss_8) {
        sum += x.weight * (portable::pow(middle - half * x.at, -theta) + portable::pow(middle + half * x.at, -theta));
    }
    return half * sum;
}

/// Mean of A^-theta between two areas. Integrated by panels: the closed form loses digits if the areas, or theta and 1,
/// are nearly equal.
double mean_power(double a, double b, double theta) {
    constexpr double panel_ratio = 1.5; // a panel's error is then 1e-16
    if (a == b) {
        return portable::pow(a, -theta);
    }
    double const low = std::min(a, b);
    double const high = std::max(a, b);
    double sum = 0.0;
    for (double from = low; from < high; from *= panel_ratio) {
        sum += panel(from, std::min(from * panel_ratio, high), theta);
    }
    return sum / (high - low);
}

/// Fall from a line's first vertex to each vertex for k_s = 1.
std::vector<double> fall_along(std::vector<Vec2> const& line, double us_area, double ds_area, double theta) {
    std::vector<double> const way = distances_along(line);
    auto const area = [&](double so_far) {
        double const share = so_far / way.back();
        return us_area * (1.0 - share) + ds_area * share;
    };
    std::vector<double> fall{0.0};
    for (std::size_t i = 1; i < way.size(); ++i) {
        fall.push_back(fall.back() + (way[i] - way[i - 1]) * mean_power(area(way[i - 1]), area(way[i]), theta));
    }
    return fall;
}

/// Accumulates the values of arcs from the outlets upstream.
std::vector<double> sum_upstream(StreamNetwork const& network, std::vector<double> const& by_arc) {
    std::vector<double> sum(network.node_count(), 0.0);
    for (NodeId const n : network.upstream_order()) {
        if (network.out(n) != no_arc) {
            auto const a = network.out(n);
            // An increment smaller than one ulp would leave the arc level.
            sum[n] = std::max(sum[network.to(a)] + by_arc[a], next_above(sum[network.to(a)]));
        }
    }
    return sum;
}

constexpr std::uint64_t slope_stage = 0x736c6f7065627974; // "slopebyt"

double slope_at(Vec2 place, Rosgen type, HeightsByTypeParams const& params) {
    SlopeRange const range = slope_range(type);
    if (params.draw == SlopeDraw::middle) {
        return range.usual;
    }
    // Adding 0 makes both signed zeros one position.
    auto const word = random_word(params.seed, slope_stage, std::bit_cast<std::uint64_t>(place.x + 0.0),
                                  std::bit_cast<std::uint64_t>(place.y + 0.0));
    return std::min(range.low + (range.high - range.low) * unit(word), range.high);
}

} // namespace

NetworkWithHeights set_heights(StreamNetwork const& network, HeightParams const& params, Run const& run) {
    require_in("network.set_heights", "slope", params.slope, Range::above(0.0), "m/m");
    require_positive_lengths(network, "network.set_heights");
    run.check();

    NetworkWithHeights raised;
    std::vector<double> const straight = straight_heights(network, params.slope);
    report_uphill(network, straight, raised.report);
    std::vector<double> z;
    switch (params.mode) {
    case HeightMode::straight: z = straight; break;
    case HeightMode::straight_repaired:
        z = majorant(network, straight, least_share * params.slope);
        report_lift(straight, z, raised.report);
        break;
    case HeightMode::along_stream: z = majorant(network, straight, params.slope); break;
    }

    raised.network = elevate_linearly(network, std::move(z), "network.set_heights");
    return raised;
}

GradedNetwork set_heights_graded(StreamNetwork const& network, std::vector<double> const& us_area_m2,
                                 std::vector<double> const& ds_area_m2, GradedParams const& params, Run const& run) {
    require(params);
    require_positive_lengths(network, "network.set_heights_graded");
    require_areas(network, us_area_m2, ds_area_m2);

    double const least_m2 = params.least_area_m2;
    std::vector<std::vector<double>> falls;
    std::vector<double> whole;
    for (std::size_t a = 0; a < network.arc_count(); ++a) {
        run.check();
        falls.push_back(fall_along(network.arc(a).line, std::max(us_area_m2[a], least_m2),
                                   std::max(ds_area_m2[a], least_m2), params.theta));
        whole.push_back(falls.back().back());
    }

    GradedNetwork graded{{network, std::vector<double>(network.node_count(), 0.0), {}}, 0.0};
    if (network.arcs().empty()) {
        return graded;
    }
    std::vector<double> const way = sum_upstream(network, network.length_m());
    auto const source = static_cast<std::size_t>(std::ranges::max_element(way) - way.begin());
    graded.steepness = params.slope * way[source] / sum_upstream(network, whole)[source];
    for (double& fall : whole) {
        fall *= graded.steepness;
    }
    graded.network.node_z = sum_upstream(network, whole);
    require_heights(network, graded.network.node_z, "network.set_heights_graded");
    for (std::size_t a = 0; a < network.arc_count(); ++a) {
        graded.network.arc_z.push_back(
            between(falls[a], graded.network.node_z[network.from(a)], graded.network.node_z[network.to(a)]));
    }
    return graded;
}

ElevatedNetwork set_heights_by_type(StreamNetwork const& network, RiverTypes const& types,
                                    HeightsByTypeParams const& params, Run const& run) {
    require_positive_lengths(network, "network.set_heights_by_type");
    refuse_if<BadInput>(types.type.size() != network.arc_count(), "network.set_heights_by_type",
                        "{} types for {} arcs; give the types that network.assign_types returns", types.type.size(),
                        network.arc_count());
    run.check();

    std::vector<double> z(network.node_count(), 0.0);
    for (NodeId const n : network.upstream_order()) {
        if (network.out(n) != no_arc) {
            auto const a = network.out(n);
            double const below = z[network.to(a)];
            double const slope = slope_at(network.node(n).at, types.type[a], params);
            // A rise smaller than one ulp would leave the arc level.
            z[n] = std::max(below + slope * network.length_m(a), next_above(below));
        }
    }
    return elevate_linearly(network, std::move(z), "network.set_heights_by_type");
}

} // namespace thalweg::network
