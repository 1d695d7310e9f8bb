// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/internal/conditions.hpp>
#include <thalweg/pipeline/recipe/internal/sections.hpp>

namespace thalweg::pipeline {

Rows<skeleton::RegressParams> regression_keys() {
    using skeleton::EighthTerm;
    using skeleton::RegressParams;
    using skeleton::SlopeMode;
    Use const by_regression = from_points() && is("surface.method", {"regress"});
    return {
        number("frequency_x", &RegressParams::frequency_x)
            .unit("cycles")
            .range({0, 1e4})
            .used(by_regression)
            .means("f_x over the grid's width; 0 leaves its term out"),
        number("frequency_y", &RegressParams::frequency_y)
            .unit("cycles")
            .range({0, 1e4})
            .used(by_regression)
            .means("f_y over the grid's height; 0 leaves its term out"),
        choice("slope_mode", &RegressParams::slope)
            .one_of({{"none", SlopeMode::none}, {"centre", SlopeMode::centre}, {"mean", SlopeMode::mean}})
            .used(by_regression)
            .means("what statistics.slope constrains: nothing, the slope at the grid's centre, or the mean square "
                   "slope"),
        choice("eighth_term", &RegressParams::eighth)
            .one_of({{"x2y2", EighthTerm::x2y2}, {"x3y", EighthTerm::x3y}})
            .used(by_regression)
            .means("the eighth term, whose exponents are illegible in Zhang, Liu and Li"),
    };
}

} // namespace thalweg::pipeline
