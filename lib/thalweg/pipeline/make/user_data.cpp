// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/make/internal/user_data.hpp>

#include <set>
#include <utility>

namespace thalweg::pipeline {

std::optional<io::UserData> user_data(Terrain const& t, StreamNetwork const& plan) {
    if (!t.file.sources.knows_any()) {
        return std::nullopt;
    }
    io::UserData user{t.file.attributes, {}, t.file.sources.of(plan)};
    for (Arc const& arc : plan.arcs()) {
        user.record.push_back(arc.feature);
    }
    return user;
}

std::vector<SecondaryLine> secondary_of(Terrain const& t) {
    std::vector<SecondaryLine> secondary = t.file.secondary;
    std::set<std::int64_t> known;
    for (SecondaryLine const& line : t.file.secondary) {
        known.insert(line.feature);
    }
    for (auto const& of_arc : t.file.sources.of(t.network.plan)) {
        for (Stretch const& s : of_arc) {
            known.insert(s.feature);
        }
    }
    for (SecondaryLine line : t.file.drawn) {
        if (known.count(line.feature) == 0) {
            line.reason = "pruned or shortened";
            secondary.push_back(std::move(line));
        }
    }
    return secondary;
}

std::vector<io::ShortenedName> shortened_names(Terrain const& t) {
    auto const user = user_data(t, t.network.plan);
    if (!user) {
        return {};
    }
    io::NetworkTables tables{t.network,  t.orders, t.areas.us_area_m2, t.areas.ds_area_m2, t.areas.node_m2,
                             t.grid.crs, {}};
    tables.user = &*user;
    return io::shortened_names(tables);
}

} // namespace thalweg::pipeline
