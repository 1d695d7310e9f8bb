// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/elevation/set_heights_graded.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/network/elevation/internal/raise.hpp>

namespace thalweg::network {

namespace {

void require(GradedParams const& params) {
    constexpr char const* self = "network.set_heights_graded";
    require_in(self, "slope", params.slope, Range::above(0.0));
    require_in(self, "theta", params.theta, Range::between(0.0, 1.0));
    require_in(self, "least_area_m2", params.least_area_m2, Range::above(0.0));
}

void require_areas(StreamNetwork const& network, std::vector<double> const& us_area_m2,
                   std::vector<double> const& ds_area_m2) {
    std::size_t const arcs = network.arc_count();
    if (us_area_m2.size() != arcs || ds_area_m2.size() != arcs) {
        throw BadInput(fmt::format("network.set_heights_graded: {} and {} areas for {} arcs; give one for each end",
                                   us_area_m2.size(), ds_area_m2.size(), arcs));
    }
    for (std::size_t a = 0; a < arcs; ++a) {
        for (double const area : {us_area_m2[a], ds_area_m2[a]}) {
            if (!(area >= 0.0) || !std::isfinite(area)) {
                Vec2 const at = network.node(network.from(a)).at;
                throw BadInput(fmt::format("network.set_heights_graded: an area of arc {} at ({:.3f}, {:.3f}) is {} "
                                           "m2; it must be a number of 0 or more",
                                           a + 1, at.x, at.y, area));
            }
        }
    }
}

/// Points and weights of Gauss and Legendre on [-1, 1], of one side.
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

/// Mean of A^-theta between two areas. By panels and not in closed form: that loses its digits where the areas or theta
/// and 1 are nearly the same.
double mean_power(double a, double b, double theta) {
    constexpr double panel_ratio = 1.5; // the error of a panel is 1e-16 there
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

/// How far the river falls from the first vertex to each of them, were k_s 1.
std::vector<double> fall_along(std::vector<Vec2> const& line, double us_area, double ds_area, double theta) {
    std::vector<double> const way = way_along(line);
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

/// From the outlets upwards, the sum of what every arc adds.
std::vector<double> sum_upstream(StreamNetwork const& network, std::vector<double> const& by_arc) {
    std::vector<double> sum(network.node_count(), 0.0);
    for (NodeId const n : network.upstream_order()) {
        if (network.out(n) != no_arc) {
            auto const a = network.out(n);
            // An addition lost in rounding would leave the arc level.
            sum[n] = std::max(sum[network.to(a)] + by_arc[a], next_above(sum[network.to(a)]));
        }
    }
    return sum;
}

} // namespace

Graded set_heights_graded(StreamNetwork const& network, std::vector<double> const& us_area_m2,
                          std::vector<double> const& ds_area_m2, GradedParams const& params, Run const& run) {
    require(params);
    require_raisable(network, "network.set_heights_graded");
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

    Graded graded{{network, std::vector<double>(network.node_count(), 0.0), {}}, 0.0};
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

} // namespace thalweg::network
