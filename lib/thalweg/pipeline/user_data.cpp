// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/user_data.hpp>

namespace thalweg::pipeline {

std::optional<io::UserData> user_data(Terrain const& t, StreamNetwork const& plan) {
    if (!t.sources.knows_any()) {
        return std::nullopt;
    }
    io::UserData user{t.attributes, {}, t.sources.of(plan)};
    for (ArcId const arc : NetworkIndex(plan).arcs) {
        user.record.push_back(plan[arc].feature);
    }
    return user;
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
