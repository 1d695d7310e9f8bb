// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/internal/conditions.hpp>
#include <thalweg/pipeline/recipe/internal/sections.hpp>

#include <cmath>

namespace thalweg::pipeline {

namespace {

constexpr char const* place_words = "[z, column, row], columns and rows from 0 in the north-west";

bool is_place(Triple const& t) {
    return std::fabs(t[0]) <= 1e6 && t[1] >= 0.0 && t[2] >= 0.0 && t[1] < 1e6 && t[2] < 1e6 &&
           t[1] == std::floor(t[1]) && t[2] == std::floor(t[2]);
}

bool are_lengths(Pair const& p) {
    return p[0] > 0.0 && p[1] > 0.0 && p[0] <= 1e6 && p[1] <= 1e6;
}

Rows<StatisticsRecipe> target_keys() {
    return {
        number("mean", &StatisticsRecipe::mean)
            .unit("m")
            .range({-1e6, 1e6})
            .used(without("network"))
            .means("mean height"),
        number("std", &StatisticsRecipe::std)
            .unit("m")
            .range({0, 1e6, left_open})
            .used(without("network"))
            .means("standard deviation of heights"),
        numbers("max", &StatisticsRecipe::max)
            .unit("m")
            .form(place_words, is_place)
            .used(without("network"))
            .means("highest cell"),
        numbers("min", &StatisticsRecipe::min)
            .unit("m")
            .form(place_words, is_place)
            .used(without("network"))
            .means("lowest cell"),
        numbers("length", &StatisticsRecipe::length)
            .unit("cells")
            .form("[Lx, Ly] above 0", are_lengths)
            .used(without("network"))
            .means("correlation lengths: where the autocorrelation falls to 1/e"),
        number("slope", &StatisticsRecipe::slope)
            .unit("rad")
            .range({0, 1.5707, left_open})
            .used(without("network"))
            .means("mean arctan of the slope, in metres per cell"),
        number("dimension", &StatisticsRecipe::dimension)
            .range({2.01, 2.99})
            .used(without("network"))
            .means("fractal dimension"),
    };
}

Rows<StatisticsRecipe> prior_keys() {
    using skeleton::Falloff;
    Use const pulled = is("statistics.skeleton", {"separable", "markov3"});
    return {
        choice("skeleton", &StatisticsRecipe::skeleton)
            .one_of({{"grf", Prior::grf},
                     {"separable", Prior::separable},
                     {"markov3", Prior::markov3},
                     {"points", Prior::points}})
            .used(without("network"))
            .means("terrain that is matched to the statistics: a random field, or that of the points of [skeleton]"),
        number("reach", &StatisticsRecipe::reach_cells)
            .unit("cells")
            .range({0, 1e5})
            .used(without("network") && (pulled || above("skeleton.scatter", 0.0)) && has_extremes())
            .means("R: distance within which heights are pulled towards max and min"),
        choice("falloff", &StatisticsRecipe::falloff)
            .one_of({{"continuous", Falloff::continuous}, {"literal", Falloff::literal}})
            .used(without("network") && pulled && has_extremes())
            .means("pull at distance R: continuous to 0, or with a step as published"),
    };
}

} // namespace

Rows<StatisticsRecipe> statistics_keys() {
    return joined<StatisticsRecipe>({target_keys(), prior_keys()});
}

} // namespace thalweg::pipeline
