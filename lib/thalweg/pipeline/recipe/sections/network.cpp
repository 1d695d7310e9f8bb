// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/internal/conditions.hpp>
#include <thalweg/pipeline/recipe/internal/sections.hpp>

#include <thalweg/pipeline/recipe/internal/recipe_asks.hpp>

namespace thalweg::pipeline {

namespace {

/// Whether rivers have these heights, or may have them once their file is read.
bool may_be(Recipe const& r, Heights heights) {
    if (!r.network) {
        return false;
    }
    if (r.network->heights != Heights::automatic) {
        return r.network->heights == heights;
    }
    return heights == (in_equilibrium(r) ? Heights::graded : Heights::straight_repaired) ||
           (heights == Heights::file && r.network->source == Source::lines);
}

Use by_slope() {
    return when("network.heights other than \"rosgen\", and other than \"graded\" with surface.method = "
                "\"equilibrium\", whose rivers are graded with the terrain",
                [](Recipe const& r) {
                    bool const by_terrain = in_equilibrium(r);
                    bool found = by_terrain ? false : may_be(r, Heights::graded);
                    for (Heights const h : {Heights::straight, Heights::straight_repaired, Heights::along_stream,
                                            Heights::file, Heights::soft, Heights::fixed, Heights::ends}) {
                        found = found || may_be(r, h);
                    }
                    return found;
                });
}

Use is_graded() {
    return when("network.heights = \"graded\"", [](Recipe const& r) { return may_be(r, Heights::graded); });
}

Use given_heights() {
    return is("network.heights", {"auto", "file", "soft", "fixed"});
}

Use rosgen_heights() {
    return is("network.heights", {"rosgen"});
}

/// Where rivers come from, and their heights.
Rows<NetworkRecipe> source_keys() {
    return {
        choice("source", &NetworkRecipe::source)
            .one_of({{"dla", Source::dla},
                     {"tokunaga", Source::tokunaga},
                     {"forest", Source::forest},
                     {"lines", Source::lines}})
            .means("where the rivers come from: a DLA cluster, a Tokunaga tree, a forest of trees that grow inland "
                   "from a coast, or lines of a file"),
        number("prune", &NetworkRecipe::prune_cells)
            .unit("cells")
            .range({0, 1e7})
            .standard("20 for dla and forest, else 0")
            .means("length threshold: shorter leaf arcs are removed"),
        choice("heights", &NetworkRecipe::heights)
            .one_of({{"auto", Heights::automatic},
                     {"straight", Heights::straight},
                     {"straight_repaired", Heights::straight_repaired},
                     {"along_stream", Heights::along_stream},
                     {"rosgen", Heights::rosgen},
                     {"graded", Heights::graded},
                     {"file", Heights::file},
                     {"soft", Heights::soft},
                     {"fixed", Heights::fixed},
                     {"ends", Heights::ends}})
            .means("elevations of the rivers. auto: file where the lines have Z, else graded with equilibrium and "
                   "straight_repaired otherwise. With equilibrium, soft, fixed and ends take those of the file or "
                   "straight_repaired: as upper bounds, as they are, or only at sources and outlets"),
        number("slope", &NetworkRecipe::slope)
            .unit("m/m")
            .range({0, 10, left_open})
            .used(by_slope())
            .means("channel slope s; with graded heights the mean slope of the main stem"),
        number("heights_tolerance", &NetworkRecipe::heights_tolerance_m)
            .unit("m")
            .range({0, 1e4})
            .used(source_is("lines") && given_heights())
            .means("vertices whose heights in the file dem.tif misses by more, beside what the river falls within a "
                   "cell, are counted in a warning"),
        number("concavity", &NetworkRecipe::concavity)
            .range({0, 1})
            .earlier(0.45)
            .used(is_graded() || by_equilibrium())
            .means("concavity theta of graded rivers and of equilibrium terrain: slope ~ area^-theta"),
    };
}

/// Where rivers run once they are there.
Rows<NetworkRecipe> course_keys() {
    return {
        number("rotate", &NetworkRecipe::rotate_deg)
            .unit("degrees")
            .range({-180, 180})
            .used(source_is("dla"))
            .means("rotation of the cluster, counterclockwise; left out: random with equilibrium, else 0"),
        number("meander", &NetworkRecipe::meander)
            .range({0, 2})
            .means("meander amplitude, 1 as in nature; left out: 1 for grown rivers with equilibrium, 0.3 where they "
                   "end on a coast, else 0"),
        choice("inland", &NetworkRecipe::inland)
            .one_of({{"carry", InlandEnds::carry}, {"sink", InlandEnds::sink}, {"coast", InlandEnds::coast}})
            .used(by_equilibrium() && is("network.source", {"dla", "tokunaga", "lines"}))
            .means("rivers that end inside the grid: extend them to its border or the sea, keep them as sinks, "
                   "or take their ends for mouths on a coast and make what lies before them the sea"),
        yes_no("fill_space", &NetworkRecipe::fill_space)
            .used(by_equilibrium())
            .means("add the side valleys of the terrain to the network as arcs"),
        number("support", &NetworkRecipe::support_cells)
            .unit("cells")
            .range({1, 1e9})
            .used(by_equilibrium() && is("network.fill_space", {"true"}))
            .means("drainage area at which a side valley begins"),
    };
}

Choices<std::optional<network::Rosgen>> rosgen_choices() {
    Choices<std::optional<network::Rosgen>> types{{"by_order", std::nullopt}};
    for (network::Rosgen const type : network::rosgen_types) {
        types.emplace_back(network::name_of(type), type);
    }
    return types;
}

Rows<NetworkRecipe> rosgen_keys() {
    using network::SlopeDraw;
    return {
        choice("rosgen", &NetworkRecipe::rosgen)
            .one_of(rosgen_choices())
            .used(rosgen_heights() || above("network.coast", 0.0))
            .means("Rosgen type of rivers without one: by Strahler order, or one type for all"),
        choice("rosgen_slope", &NetworkRecipe::rosgen_slope)
            .one_of({{"middle", SlopeDraw::middle}, {"uniform", SlopeDraw::uniform}})
            .used(rosgen_heights())
            .means("slope of a river within its type's range: the usual value, or a random one"),
        number("coast", &NetworkRecipe::coast_m)
            .unit("m")
            .range({0, 1e9})
            .means("rivers closer to their outlet than this, along the stream, are marked as braided"),
    };
}

} // namespace

Rows<NetworkRecipe> network_keys() {
    return joined<NetworkRecipe>({source_keys(), course_keys(), rosgen_keys(), dla_keys(),
                                  inside("tokunaga.", &NetworkRecipe::tokunaga, tokunaga_keys()),
                                  inside("forest.", &NetworkRecipe::forest, forest_keys()),
                                  inside("lines.", &NetworkRecipe::lines, lines_keys())});
}

} // namespace thalweg::pipeline
