// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/internal/conditions.hpp>
#include <thalweg/pipeline/recipe/internal/sections.hpp>

#include <thalweg/core/run/error.hpp>

#include <fmt/format.h>

namespace thalweg::pipeline {

namespace {

using fractal::Stencil;

/// A number of neighbours, or a word.
Stencil stencil_of(Value const& v) {
    if (auto const* word = std::get_if<std::string>(&v)) {
        if (*word != "exact") {
            refuse_word(*word, {"4", "12", "16", "exact"});
        }
        return Stencil::exact;
    }
    switch (std::int64_t const n = as_integer(v)) {
    case 4: return Stencil::four;
    case 12: return Stencil::twelve;
    case 16: return Stencil::sixteen;
    default: throw BadParameter(fmt::format("{} is not one of 4, 12, 16, exact", n));
    }
}

Value value_of_stencil(Stencil s) {
    if (s == Stencil::exact) {
        return std::string("exact");
    }
    return std::int64_t{s == Stencil::four ? 4 : s == Stencil::twelve ? 12 : 16};
}

Use by_midpoint() {
    return is("detail.method", {"midpoint"});
}

Use few_neighbours() {
    return when("detail.stencil = 4, 12 or 16",
                [](Recipe const& r) { return r.detail && r.detail->midpoint.stencil != Stencil::exact; });
}

Rows<DetailRecipe> detail_method_keys() {
    return {
        choice("method", &DetailRecipe::method)
            .one_of({{"midpoint", DetailMethod::midpoint}, {"none", DetailMethod::none}})
            .used(has_surface())
            .means("fractal detail between every 2^levels-th cell"),
    };
}

Rows<fractal::MidpointParams> midpoint_keys() {
    using fractal::Adaptation;
    using fractal::MidpointParams;
    using fractal::Noise;
    Use const displaced = has_surface() && by_midpoint();
    return {
        number("levels", &MidpointParams::levels).range({1, 12}).used(displaced).means("how often cells are halved"),
        number("hurst", &MidpointParams::hurst)
            .range({0.05, 0.95})
            .used(displaced)
            .means("Hurst exponent H = 3 - fractal dimension; left out: estimated, with rivers 0.6"),
        number("sigma", &MidpointParams::sigma)
            .unit("m")
            .range({0, 1e6})
            .used(displaced)
            .means("root mean square difference of heights 2^levels cells apart; left out: estimated, with rivers it "
                   "must be given"),
        choice("stencil", &MidpointParams::stencil)
            .type("integer or text")
            .form("4 | 12 | 16 | exact")
            .suggests({"4", "12", "16", "exact"})
            .reads(stencil_of)
            .shows(value_of_stencil)
            .used(displaced)
            .means("number of neighbours that a height is interpolated from; 4 with the published variance; exact: a "
                   "fractional Brownian surface through all coarse cells, of which there are up to 2000"),
        choice("noise", &MidpointParams::noise)
            .one_of({{"normal", Noise::normal}, {"uniform", Noise::uniform}})
            .used(displaced && few_neighbours())
            .means("distribution of the displacements"),
        choice("adaptation", &MidpointParams::adaptation)
            .one_of({{"global", Adaptation::global}, {"local", Adaptation::local}})
            .used(by_midpoint() && few_neighbours() && without("network"))
            .means("one H and sigma for the grid, or local ones where they differ"),
    };
}

} // namespace

Rows<DetailRecipe> detail_keys() {
    return joined<DetailRecipe>({detail_method_keys(), inside("", &DetailRecipe::midpoint, midpoint_keys())});
}

} // namespace thalweg::pipeline
