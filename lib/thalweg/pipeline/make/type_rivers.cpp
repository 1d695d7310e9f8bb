// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/make/internal/rivers.hpp>

#include <thalweg/network/order/order.hpp>

namespace thalweg::pipeline {

Typed type_rivers(StreamNetwork plan, NetworkRecipe const& wanted, Run const& run) {
    Typed typed{std::move(plan), {}};
    if (wanted.heights != Heights::rosgen && !(wanted.coast_m > 0.0)) {
        return typed;
    }
    network::AssignTypesParams params;
    params.choice = wanted.rosgen ? network::TypeChoice::one : network::TypeChoice::by_order;
    params.one = wanted.rosgen.value_or(params.one);
    params.coast_m = wanted.coast_m;
    typed.types = network::assign_types(typed.plan, network::order(typed.plan), params, run);
    NetworkDraft draft = typed.plan.draft();
    for (std::size_t a = 0; a < draft.arcs.size(); ++a) {
        draft.arcs[a].arc.type = network::name_of(typed.types.type[a]);
    }
    typed.plan = std::move(draft);
    return typed;
}

} // namespace thalweg::pipeline
