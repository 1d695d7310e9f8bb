// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/internal/conditions.hpp>
#include <thalweg/pipeline/recipe/internal/sections.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace thalweg::pipeline {

namespace {

/// Says what is wrong with it.
void require_increment(Value const& v) {
    surface::increments(1, {as_text(v)});
}

} // namespace

Rows<surface::DilateParams> dilation_keys() {
    using surface::DilateParams;
    using surface::IncrementParams;
    using surface::Metric;
    return {
        text("increment", &DilateParams::increment, &IncrementParams::increment)
            .form(fmt::format("{} | an expression in x", fmt::join(surface::increment_names(), " | ")))
            .suggests(surface::increment_names())
            .checked(require_increment)
            .used(by_dilation())
            .means("height increment dh of the x-th dilation"),
        choice("metric", &DilateParams::metric)
            .one_of({{"cityblock", Metric::cityblock}, {"euclid", Metric::euclid}})
            .used(by_dilation())
            .means("distance to the valley: over 4 neighbours as published, or Euclidean"),
        number("relief", &DilateParams::relief_m)
            .unit("m")
            .range({0, 1e5})
            .used(method_is({"equilibrium", "dilate"}))
            .means("equilibrium: height from the lowest to the highest cell, 0: see mean_slope; dilate: greatest sum "
                   "of the increments, 0: published units times the cell size"),
        yes_no("allow_negative", &DilateParams::increment, &IncrementParams::allow_negative)
            .used(by_dilation())
            .means("keep increments below 0"),
    };
}

} // namespace thalweg::pipeline
