// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/relief/natural_ranges.hpp>

#include <algorithm>
#include <array>

namespace thalweg::measure {

namespace {

constexpr std::array<NaturalRange, 9> ranges = {{
    {"bifurcation", 3.0, 5.0, "Strahler 1964: basins whose pattern the rock does not distort"},
    {"length", 1.5, 3.5, "Rodríguez-Iturbe and Valdés 1979, after Smart 1972: natural basins"},
    {"area", 3.0, 6.0, "Rodríguez-Iturbe and Valdés 1979, after Smart 1972 and Schumm 1956: natural basins"},
    {"tokunaga_a", 1.0, 1.5, "Dodds and Rothman 1999: compiled from maps and DEMs, after Tokunaga 1978"},
    {"tokunaga_c", 2.0, 3.0, "Dodds and Rothman 1999: compiled from maps and DEMs, after Tokunaga 1978"},
    {"hack", 0.52, 0.60, "Rigon et al. 1996: DEMs; Hack 1957: 0.6, Shenandoah Valley"},
    {"concavity", 0.3, 0.6,
     "Whipple and Tucker 1999; Gailleton et al. 2021: median 0.425, quartiles 0.225 and 0.575 of mountain basins"},
    {"drainage_density", 0.55, 374.0,
     "Langbein 1947: from 0.55 to 2.09 in humid lands, on maps; Schumm 1956: 374 in badlands, surveyed"},
    {"junction_angle", 45.0, 72.0,
     "Seybold, Rothman and Kirchner 2017: arid to humid, a million junctions of the United States; Devauchelle et al. "
     "2012: 72 where springs cut the valleys"},
}};

} // namespace

std::span<NaturalRange const> natural_ranges() {
    return ranges;
}

NaturalRange const* natural_range(std::string_view law) {
    auto const at = std::find_if(ranges.begin(), ranges.end(), [&](NaturalRange const& r) { return r.law == law; });
    return at == ranges.end() ? nullptr : &*at;
}

} // namespace thalweg::measure
