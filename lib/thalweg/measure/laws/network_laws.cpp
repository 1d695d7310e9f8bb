// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/laws/network_laws.hpp>

#include <algorithm>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/sums.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/measure/laws/internal/network_laws.hpp>

namespace thalweg::measure {
namespace {

void require_all(std::size_t arcs, NetworkOrders const& orders, std::vector<double> const& areas) {
    refuse_if<BadInput>(orders.strahler.size() != arcs || areas.size() != arcs, "measure.horton",
                        "{} orders and {} areas for {} arcs; order and measure the network again",
                        orders.strahler.size(), areas.size(), arcs);
    auto const low = std::find_if(orders.strahler.begin(), orders.strahler.end(), [](int s) { return s < 1; });
    if (low != orders.strahler.end()) {
        throw BadInput("measure.horton", fmt::format("arc {} has Strahler order {}; orders begin with 1",
                                                     low - orders.strahler.begin() + 1, *low));
    }
}

/// The least-squares line through ln(value) over the order.
template <class Value> std::optional<LineFit> fit(std::vector<StreamOrder> const& orders, Value value) {
    std::vector<Vec2> points;
    for (StreamOrder const& o : orders) {
        if (double const v = value(o); v > 0.0) {
            points.push_back({static_cast<double>(o.order), portable::log(v)});
        }
    }
    return fit_line(points);
}

std::optional<HortonRatio> ratio(std::optional<LineFit> const& fit, double sign) {
    return fit ? std::optional(HortonRatio{portable::exp(sign * fit->slope), fit->r2, fit->points}) : std::nullopt;
}

struct MeanAndDeviation {
    double mean = 0.0;
    double deviation = 0.0; // of the population, not of a sample
};

// values: at least one.
MeanAndDeviation mean_and_deviation(std::span<double const> values) {
    auto const n = static_cast<double>(values.size());
    CompensatedSum sum;
    for (double const v : values) {
        sum.add(v);
    }
    double const mean = sum.value() / n;
    CompensatedSum squares;
    for (double const v : values) {
        squares.add((v - mean) * (v - mean));
    }
    return {mean, std::sqrt(squares.value() / n)};
}

/// The position on a link at a distance upstream from the end of an arc; nothing: the link is shorter than half of it.
std::optional<Vec2> chord_up(StreamNetwork const& network, std::size_t arc, double reach_m) {
    double left = reach_m;
    Vec2 const foot = network.node(network.to(arc)).at;
    Vec2 at = foot;
    for (std::size_t a = arc;;) {
        auto const& line = network.arc(a).line;
        for (std::size_t i = line.size() - 1; i-- > 0;) {
            double const step = distance(at, line[i]);
            if (step >= left) {
                double const share = left / step;
                return Vec2{at.x + share * (line[i].x - at.x) - foot.x, at.y + share * (line[i].y - at.y) - foot.y};
            }
            left -= step;
            at = line[i];
        }
        auto const& above = network.in(network.from(a));
        if (above.size() != 1) {
            break;
        }
        a = above.front();
    }
    return left > 0.5 * reach_m ? std::nullopt : std::optional(Vec2{at.x - foot.x, at.y - foot.y});
}

LengthSpread spread_of(std::vector<double> lengths) {
    LengthSpread spread;
    spread.links = static_cast<std::int64_t>(lengths.size());
    if (lengths.empty()) {
        return spread;
    }
    auto const [mean, deviation] = mean_and_deviation(lengths);
    spread.mean_m = mean;
    spread.cv = deviation / mean;
    std::sort(lengths.begin(), lengths.end());
    std::size_t const middle = lengths.size() / 2;
    spread.median_m =
        lengths.size() % 2 == 1 ? lengths[middle] : lengths[middle - 1] + 0.5 * (lengths[middle] - lengths[middle - 1]);
    return spread;
}

} // namespace

HortonLaws horton(StreamNetwork const& network, NetworkOrders const& orders, std::vector<double> const& ds_area_m2) {
    std::size_t const arcs = network.arc_count();
    require_all(arcs, orders, ds_area_m2);
    HortonLaws laws;
    if (arcs == 0) {
        return laws;
    }
    auto const highest = static_cast<std::size_t>(*std::max_element(orders.strahler.begin(), orders.strahler.end()));
    laws.orders.resize(highest);
    std::vector<CompensatedSum> length(highest);
    std::vector<CompensatedSum> area(highest);
    std::vector<std::int64_t> known_areas(highest, 0);
    for (std::size_t a = 0; a < arcs; ++a) {
        auto const k = static_cast<std::size_t>(orders.strahler[a]) - 1;
        length[k].add(network.length_m(a));
        ArcId const next = network.out(network.to(a));
        bool const ends = next == no_arc || orders.strahler[next] != orders.strahler[a];
        if (ends) {
            ++laws.orders[k].streams;
            if (ds_area_m2[a] > 0.0) {
                ++known_areas[k];
                area[k].add(ds_area_m2[a]);
            }
        }
    }
    for (std::size_t k = 0; k < highest; ++k) {
        StreamOrder& o = laws.orders[k];
        o.order = static_cast<int>(k) + 1;
        if (o.streams > 0) {
            o.length_m = length[k].value() / static_cast<double>(o.streams);
        }
        if (known_areas[k] > 0) {
            o.area_m2 = area[k].value() / static_cast<double>(known_areas[k]);
        }
    }
    laws.bifurcation =
        ratio(fit(laws.orders, [](StreamOrder const& o) { return static_cast<double>(o.streams); }), -1.0);
    laws.length = ratio(fit(laws.orders, [](StreamOrder const& o) { return o.length_m; }), 1.0);
    laws.area = ratio(fit(laws.orders, [](StreamOrder const& o) { return o.area_m2; }), 1.0);
    return laws;
}

std::optional<TokunagaLaw> tokunaga(std::vector<double> const& side_branches) {
    std::vector<Vec2> points;
    for (std::size_t i = 0; i < side_branches.size(); ++i) {
        if (side_branches[i] > 0.0) {
            points.push_back({static_cast<double>(i), portable::log(side_branches[i])});
        }
    }
    auto const fit = fit_line(points);
    if (!fit) {
        return std::nullopt;
    }
    return TokunagaLaw{portable::exp(fit->intercept), portable::exp(fit->slope), fit->r2, fit->slope_error,
                       fit->points};
}

JunctionAngles junction_angles(StreamNetwork const& network, double reach_m) {
    refuse_if<BadParameter>(!(reach_m > 0.0) || std::isinf(reach_m), "measure.junction_angles",
                            "the reach is {} m; it must be above 0", reach_m);
    JunctionAngles angles;
    angles.reach_m = reach_m;
    std::vector<double> degrees;
    for (NodeId n = 0; n < network.node_count(); ++n) {
        auto const& above = network.in(n);
        if (above.size() < 2 || network.out(n) == no_arc) {
            continue;
        }
        auto const one = chord_up(network, above[0], reach_m);
        auto const other = chord_up(network, above[1], reach_m);
        auto const is_zero = [](Vec2 v) { return v == Vec2{}; };
        if (above.size() > 2 || !one || !other || is_zero(*one) || is_zero(*other)) {
            ++angles.left_out;
            continue;
        }
        double const cross = one->x * other->y - one->y * other->x;
        double const dot = one->x * other->x + one->y * other->y;
        degrees.push_back(portable::atan2(std::fabs(cross), dot) * (180.0 / portable::pi));
    }
    angles.junctions = static_cast<std::int64_t>(degrees.size());
    if (degrees.empty()) {
        return angles;
    }
    auto const [mean, deviation] = mean_and_deviation(degrees);
    angles.mean_deg = mean;
    angles.std_deg = deviation;
    return angles;
}

LinkLengths link_lengths(StreamNetwork const& network) {
    std::vector<double> exterior;
    std::vector<double> interior;
    for (std::size_t a = 0; a < network.arc_count(); ++a) {
        std::size_t const above = network.in(network.from(a)).size();
        if (above == 1) {
            continue;
        }
        double length = network.length_m(a);
        for (NodeId at = network.to(a); network.in(at).size() == 1 && network.out(at) != no_arc;) {
            auto const next = network.out(at);
            length += network.length_m(next);
            at = network.to(next);
        }
        (above == 0 ? exterior : interior).push_back(length);
    }
    LinkLengths lengths{spread_of(std::move(exterior)), spread_of(std::move(interior)), std::nullopt};
    if (lengths.exterior.links > 0 && lengths.interior.links > 0 && lengths.interior.mean_m > 0.0) {
        lengths.ratio = lengths.exterior.mean_m / lengths.interior.mean_m;
    }
    return lengths;
}

std::optional<PowerLaw> hack(StreamNetwork const& network, std::vector<double> const& ds_area_m2,
                             std::vector<double> const& head_m, PowerLawParams const& params) {
    std::size_t const nodes = network.node_count();
    refuse_if<BadInput>(ds_area_m2.size() != network.arc_count() || (!head_m.empty() && head_m.size() != nodes),
                        "measure.hack", "{} areas for {} arcs and {} heads for {} nodes; measure the network again",
                        ds_area_m2.size(), network.arc_count(), head_m.size(), nodes);
    std::vector<double> longest(nodes, 0.0); // longest flow path upstream of a node
    std::vector<AtArea> ends(network.arc_count());
    for (auto n = network.upstream_order().rbegin(); n != network.upstream_order().rend(); ++n) {
        if (network.in(*n).empty() && !head_m.empty()) {
            longest[*n] = head_m[*n];
        }
        if (network.out(*n) != no_arc) {
            auto const a = network.out(*n);
            double const length = longest[*n] + network.length_m(a);
            longest[network.to(a)] = std::max(longest[network.to(a)], length);
            ends[a] = {ds_area_m2[a], length};
        }
    }
    return fit_power_law(ends, params);
}

std::optional<PowerLaw> concavity(ElevatedNetwork const& network, flow::ContributingAreas const& areas,
                                  PowerLawParams const& params) {
    std::size_t const arcs = network.planform.arc_count();
    refuse_if<BadInput>(areas.us_area_m2.size() != arcs || areas.ds_area_m2.size() != arcs ||
                            network.arc_z.size() != arcs,
                        "measure.concavity", "{} and {} areas and heights of {} for {} arcs; measure the network again",
                        areas.us_area_m2.size(), areas.ds_area_m2.size(), network.arc_z.size(), arcs);
    std::vector<AtArea> slopes;
    slopes.reserve(arcs);
    for (std::size_t a = 0; a < arcs; ++a) {
        double const drop = network.arc_z[a].front() - network.arc_z[a].back();
        slopes.push_back({0.5 * (areas.us_area_m2[a] + areas.ds_area_m2[a]), drop / network.planform.length_m(a)});
    }
    return fit_power_law(slopes, params);
}

NetworkLaws network_laws(ElevatedNetwork const& network, NetworkOrders const& orders,
                         flow::ContributingAreas const& areas, NetworkLawsParams const& params) {
    if (!(params.land_m2 > 0.0) || std::isinf(params.land_m2)) {
        throw BadParameter("measure.network_laws",
                           fmt::format("the land has {} m2; it must have some", double{params.land_m2}));
    }
    NetworkLaws laws;
    laws.horton = horton(network.planform, orders, areas.ds_area_m2);
    laws.tokunaga = tokunaga(params.side_branches);
    laws.hack = hack(network.planform, areas.ds_area_m2, params.head_m);
    laws.concavity = concavity(network, areas);
    CompensatedSum length;
    for (double const l : network.planform.length_m()) {
        length.add(l);
    }
    laws.drainage_density_m = length.value() / params.land_m2;
    laws.links = link_lengths(network.planform);
    laws.junctions = junction_angles(network.planform, params.junction_reach_m);
    return laws;
}

} // namespace thalweg::measure
