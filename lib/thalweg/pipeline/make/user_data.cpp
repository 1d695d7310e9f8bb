// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/make/internal/file_values.hpp>

#include <utility>

namespace thalweg::pipeline {

std::optional<io::UserData> user_data(Made const& t, StreamNetwork const& plan) {
    if (!t.rivers.file.sources.knows_any()) {
        return std::nullopt;
    }
    io::UserData user{t.rivers.file.attributes, {}, t.rivers.file.sources.of(plan)};
    for (Arc const& arc : plan.arcs()) {
        user.record.push_back(arc.feature);
    }
    return user;
}

std::vector<io::ShortenedName> shortened_names(Made const& t) {
    auto const user = user_data(t, t.terrain.network.plan);
    if (!user) {
        return {};
    }
    io::NetworkTables tables{t.terrain.network,
                             t.terrain.orders,
                             t.assessment.areas.us_area_m2,
                             t.assessment.areas.ds_area_m2,
                             t.assessment.areas.node_m2,
                             t.terrain.grid.crs,
                             {}};
    tables.user = &*user;
    return io::shortened_names(tables);
}

} // namespace thalweg::pipeline
