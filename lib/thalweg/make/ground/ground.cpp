// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/make/internal/ground.hpp>

#include <thalweg/recipe/check_recipe.hpp>

namespace thalweg::make {

Equilibrium const* Ground::equilibrium() const {
    auto const* const rebuilt = std::get_if<Rebuilt>(&how);
    return rebuilt != nullptr ? rebuilt : std::get_if<Equilibrium>(&how);
}

ByDilation const& Ground::dilated() const {
    static ByDilation const not_dilated;
    auto const* const found = std::get_if<ByDilation>(&how);
    return found != nullptr ? *found : not_dilated;
}

MakeGround ground_of(recipe::Recipe const& recipe) {
    if (recipe::on_raster(recipe)) {
        return &raster;
    }
    if (!recipe.network) {
        return recipe.statistics && recipe.statistics->skeleton != recipe::Prior::points ? &statistics : &points;
    }
    if (recipe::in_equilibrium(recipe)) {
        return recipe.network->heights == recipe::Heights::file ? &rebuild : &equilibrium;
    }
    switch (recipe.surface->method) {
    case recipe::Method::diffuse: return &diffuse;
    case recipe::Method::tin: return &tin;
    default: return &dilate;
    }
}

} // namespace thalweg::make
