// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/report/internal/page_laws.hpp>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/pipeline/make/laws.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>

namespace thalweg::pipeline {

namespace {

using nlohmann::ordered_json;

/// What stands in small print under a figure.
std::string note_of(LawRow const& row) {
    struct Way {
        std::string_view detail;
        char const* words;
    };
    static constexpr std::array<Way, 10> ways = {{{"error", "± {:.2g}"},
                                                  {"std_deg", "spread {:.0f}°"},
                                                  {"r2", "r² {:.2f}"},
                                                  {"orders", "{:.0f} orders"},
                                                  {"terms", "{:.0f} T_k"},
                                                  {"bins", "{:.0f} bins"},
                                                  {"median_m", "median {:.0f} m"},
                                                  {"cv", "cv {:.2f}"},
                                                  {"junctions", "{:.0f} junctions"},
                                                  {"links", "{:.0f} links"}}};
    std::string note;
    for (Way const& way : ways) {
        for (auto const& [name, figure] : row.details) {
            if (row.value && name == way.detail && std::isfinite(figure)) {
                note += (note.empty() ? "" : ", ") + fmt::format(fmt::runtime(way.words), figure);
            }
        }
    }
    return note;
}

ordered_json figure_of(LawRow const& row) {
    return {{"value", row.value ? ordered_json(*row.value) : ordered_json(nullptr)}, {"note", note_of(row)}};
}

ordered_json rows_of(RiverLaws const& laws) {
    std::vector<LawRow> const none;
    auto const drawn = laws.network ? law_rows(*laws.network) : none;
    auto const drained = laws.dem ? law_rows(laws.dem->laws) : none;
    ordered_json rows = ordered_json::array();
    for (std::size_t i = 0; i < std::max(drawn.size(), drained.size()); ++i) {
        LawRow const& row = i < drawn.size() ? drawn[i] : drained[i];
        ordered_json one{{"key", row.key}, {"name", row.name}, {"unit", row.unit}};
        one["network"] = drawn.empty() ? ordered_json(nullptr) : figure_of(drawn[i]);
        one["dem"] = drained.empty() ? ordered_json(nullptr) : figure_of(drained[i]);
        one["nature"] = row.nature != nullptr ? ordered_json{row.nature->low, row.nature->high} : ordered_json(nullptr);
        one["source"] = row.nature != nullptr ? row.nature->source : "";
        rows.push_back(std::move(one));
    }
    return rows;
}

ordered_json orders_of(measure::NetworkLaws const* laws) {
    ordered_json orders = ordered_json::array();
    if (laws != nullptr) {
        for (measure::StreamOrder const& o : laws->horton.orders) {
            orders.push_back(
                {{"order", o.order}, {"streams", o.streams}, {"length_m", o.length_m}, {"area_m2", o.area_m2}});
        }
    }
    return orders;
}

/// Bins as [area in km2, value in so many of its unit, places], and the two ends of the law's line.
ordered_json power_object(std::optional<measure::PowerLaw> const& law, double unit) {
    if (!law) {
        return nullptr;
    }
    ordered_json bins = ordered_json::array();
    for (measure::AreaBin const& bin : law->bins) {
        bins.push_back({bin.area_m2 / 1e6, bin.value / unit, bin.places});
    }
    ordered_json fit = ordered_json::array();
    for (measure::AreaBin const* end : {&law->bins.front(), &law->bins.back()}) {
        fit.push_back({end->area_m2 / 1e6, law->coefficient * portable::pow(end->area_m2, law->exponent) / unit});
    }
    return {{"bins", bins}, {"fit", fit}};
}

} // namespace

std::string page_laws(RiverLaws const& laws) {
    measure::NetworkLaws const* const drawn = laws.network ? &*laws.network : nullptr;
    measure::NetworkLaws const* const drained = laws.dem ? &laws.dem->laws : nullptr;
    constexpr double kilometre = 1000.0;
    auto const both = [&](auto part) {
        return ordered_json{{"network", drawn != nullptr ? part(*drawn) : ordered_json(nullptr)},
                            {"dem", drained != nullptr ? part(*drained) : ordered_json(nullptr)}};
    };
    ordered_json const out{
        {"rows", rows_of(laws)},
        {"support", laws.dem ? ordered_json{{"cells", laws.dem->support_cells},
                                            {"km2", laws.dem->support_m2 / 1e6},
                                            {"as_dense", laws.dem->as_dense}}
                             : ordered_json(nullptr)},
        {"orders", orders_of(drawn)},
        {"dem_orders", orders_of(drained)},
        {"hack", both([](measure::NetworkLaws const& l) { return power_object(l.hack, kilometre); })},
        {"concavity", both([](measure::NetworkLaws const& l) { return power_object(l.concavity, 1.0); })}};
    return out.dump();
}

} // namespace thalweg::pipeline
