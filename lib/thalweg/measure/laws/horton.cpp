// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/laws/horton.hpp>

#include <algorithm>

#include <fmt/format.h>

#include <thalweg/core/numbers/compensated_sum.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/measure/laws/line_fit.hpp>

namespace thalweg::measure {

namespace {

void require_all(std::size_t arcs, NetworkOrders const& orders, std::vector<double> const& areas) {
    if (orders.strahler.size() != arcs || areas.size() != arcs) {
        throw BadInput(fmt::format("measure.horton: {} orders and {} areas for {} arcs; order and measure the network "
                                   "again",
                                   orders.strahler.size(), areas.size(), arcs));
    }
    auto const low = std::find_if(orders.strahler.begin(), orders.strahler.end(), [](int s) { return s < 1; });
    if (low != orders.strahler.end()) {
        throw BadInput(fmt::format("measure.horton: arc {} has Strahler order {}; orders begin with 1",
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
    for (std::size_t a = 0; a < arcs; ++a) {
        auto const k = static_cast<std::size_t>(orders.strahler[a]) - 1;
        length[k].add(network.length_m(a));
        ArcId const next = network.out(network.to(a));
        bool const ends = next == no_arc || orders.strahler[next] != orders.strahler[a];
        if (ends) {
            ++laws.orders[k].streams;
            area[k].add(ds_area_m2[a]);
        }
    }
    for (std::size_t k = 0; k < highest; ++k) {
        StreamOrder& o = laws.orders[k];
        o.order = static_cast<int>(k) + 1;
        if (o.streams > 0) {
            o.length_m = length[k].value() / static_cast<double>(o.streams);
            o.area_m2 = area[k].value() / static_cast<double>(o.streams);
        }
    }
    laws.bifurcation =
        ratio(fit(laws.orders, [](StreamOrder const& o) { return static_cast<double>(o.streams); }), -1.0);
    laws.length = ratio(fit(laws.orders, [](StreamOrder const& o) { return o.length_m; }), 1.0);
    laws.area = ratio(fit(laws.orders, [](StreamOrder const& o) { return o.area_m2; }), 1.0);
    return laws;
}

} // namespace thalweg::measure
