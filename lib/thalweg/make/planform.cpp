// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <thalweg/make/internal/planform.hpp>

#include <algorithm>
#include <functional>
#include <numeric>

#include <fmt/format.h>

#include <thalweg/core/append.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/run/result_cache.hpp>
#include <thalweg/flow/catchments.hpp>
#include <thalweg/network/elevation/known_heights.hpp>
#include <thalweg/network/import/land_and_sea.hpp>
#include <thalweg/network/planform/carry_outlets.hpp>
#include <thalweg/network/planform/meander.hpp>
#include <thalweg/network/vectorise/prune.hpp>
#include <thalweg/recipe/stage_recipes.hpp>
#include <thalweg/recipe/stages.hpp>

namespace thalweg::make {

TypedNetwork type_rivers(StreamNetwork network, recipe::NetworkRecipe const& wanted, Run const& run) {
    if (wanted.heights != recipe::Heights::rosgen && !(wanted.coast_m > 0.0)) {
        return {std::move(network), {}};
    }
    network::AssignTypesParams params;
    params.choice = wanted.rosgen ? network::TypeChoice::one : network::TypeChoice::by_order;
    params.one = wanted.rosgen.value_or(params.one);
    params.coast_m = wanted.coast_m;
    network::RiverTypes types = network::assign_types(network, network::order(network), params, run);
    NetworkDraft draft = network.draft();
    for (std::size_t a = 0; a < draft.arcs.size(); ++a) {
        draft.arcs[a].arc.type = name_of(types.type[a]);
    }
    return {std::move(draft), std::move(types)};
}

namespace {

/// Rivers with bends, and their file as it follows them.
struct BentRivers {
    StreamNetwork network;
    RiverFile file;
};

/// Bends rivers where the plan wants it; where there is a sea, none leaves the land.
BentRivers bent(recipe::Recipe const& recipe, StreamNetwork network, RiverFile file, Grid const& grid, Mask const& land,
                StageLog& stage_log, Run const& run) {
    if (!recipe::stage::meander.runs(recipe)) {
        return {std::move(network), std::move(file)};
    }
    flow::ContributingAreas const areas = flow::areas_nearest(network, grid, run);
    network::MeanderParams const params{.gain = *recipe.network->meander, .seed = recipe.seed};
    network::MeanderedNetwork meandered = stage_log.stage(recipe::stage::meander.name, [&] {
        return land.cells() > 0 ? network::meander(network, land, areas.ds_area_m2, params, run)
                                : network::meander(network, grid, areas.ds_area_m2, params, run);
    });
    stage_log.say(fmt::format("{} vertices, at most {:.0f} m aside", meandered.vertices, meandered.max_shift_m));
    RiverFile follows = std::move(file);
    double const before_m = follows.sources.length_m(network);
    follows.sources = follows.sources.bent(network, meandered.network);
    follows.lengthened = before_m > 0.0 ? follows.sources.length_m(meandered.network) / before_m : 1.0;
    follows.imported = meandered.network;
    return {std::move(meandered.network), std::move(follows)};
}

/// A note on generalised lines that stay as they are, where nobody said how much they shall bend.
std::vector<Finding> few_vertices(recipe::Recipe const& recipe, StreamNetwork const& network, double cell_m) {
    if (!recipe::from_lines(recipe) || recipe::stage::meander.runs(recipe) ||
        recipe.set_at.contains("network.meander")) {
        return {};
    }
    std::vector<double> pieces;
    for (Arc const& arc : network.arcs()) {
        for (std::size_t i = 1; i < arc.line.size(); ++i) {
            pieces.push_back(distance(arc.line[i - 1], arc.line[i]));
        }
    }
    std::ranges::sort(pieces, std::greater<>());
    double const half = 0.5 * std::accumulate(pieces.begin(), pieces.end(), 0.0);
    double longest = 0.0; // together
    double piece = 0.0;
    for (std::size_t i = 0; i < pieces.size() && longest < half; ++i) {
        piece = pieces[i];
        longest += piece;
    }
    constexpr double cells = 10.0;
    if (!(piece > cells * cell_m)) {
        return {};
    }
    return {{.kind = "few_vertices",
             .amount = piece,
             .text = fmt::format("the lines have few vertices: half of their length is straight pieces of {:.4g} m or "
                                 "more, over cells of {:.6g} m",
                                 piece, cell_m),
             .key = "network.meander"}};
}

bool is_extension(Finding const& note) {
    return note.kind == FindingKind("carried_outlet") || note.kind == FindingKind("joined_outlet");
}

/// A warning when outlets were extended far beyond the data.
std::vector<Finding> long_extensions(std::vector<Finding> const& notes, StreamNetwork const& plan) {
    constexpr std::int64_t many = 3;
    constexpr double much = 0.1; // of the length of all rivers
    double carried_m = 0.0;
    std::int64_t outlets = 0;
    for (Finding const& note : notes) {
        if (is_extension(note)) {
            carried_m += note.amount;
            ++outlets;
        }
    }
    double const length_m = std::accumulate(plan.length_m().begin(), plan.length_m().end(), 0.0);
    if (outlets < many || carried_m <= much * length_m) {
        return {};
    }
    return {{.kind = "extended_rivers",
             .amount = carried_m,
             .text = fmt::format("{} rivers end inside the grid and were extended by {:.3g} km in all, by the shortest "
                                 "ways",
                                 outlets, carried_m / 1000.0),
             .remedy = "If they end at the sea: --set network.inland=coast; in lakes: give their outlines "
                       "(--set surface.lakes=FILE) and outflows; if their water sinks in: --set network.inland=sink",
             .key = "network.inland",
             .numbers = {{"rivers", static_cast<double>(outlets)}}}};
}

/// Rivers whose outlets lie where rivers may end.
struct RiversToBorder {
    StreamNetwork network;
    Mask land;
    std::vector<Finding> notes;
};

/// Carries outlets inside the grid to where rivers may end, if the recipe wants it. Those at the sea reach it in any
/// case; what lies beside a river is land. keeps_heights: the rivers have heights, so that none may fall into another.
RiversToBorder with_outlets_carried(recipe::NetworkRecipe const& wanted, StreamNetwork network, Grid const& grid,
                                    Mask land, bool keeps_heights, Run const& run) {
    RiversToBorder result{std::move(network), std::move(land), {}};
    if (wanted.source == recipe::Source::forest) {
        return result; // its outlets lie on its coast
    }
    constexpr std::int64_t at_sea_cells = 4;
    recipe::InlandEnds const inland = wanted.inland;
    bool const all = inland != recipe::InlandEnds::sink;
    network::CarryParams const params{.join = !keeps_heights};
    auto const take = [&](network::CarriedNetwork carried) {
        append(result.notes, long_extensions(carried.notes, result.network));
        append(result.notes, std::move(carried.notes));
        result.network = std::move(carried.network);
    };
    if (result.land.cells() == 0 && inland == recipe::InlandEnds::coast) {
        result.land = network::land_behind_outlets(result.network, grid, run);
    }
    if (result.land.cells() == 0) {
        if (all) {
            take(network::carry_outlets(result.network, grid, params));
        }
        return result;
    }
    // A river that is carried may close the way of another.
    for (std::ptrdiff_t moved = 1, rounds = 0; moved > 0 && rounds < 4; ++rounds) {
        result.land = network::land_along_rivers(std::move(result.land), result.network);
        network::CarriedNetwork carried =
            network::carry_outlets(result.network, result.land, all ? grid.cells() : at_sea_cells, params);
        moved = std::ranges::count_if(carried.notes, is_extension);
        take(std::move(carried));
    }
    result.land = network::land_along_rivers(std::move(result.land), result.network);
    return result;
}

std::size_t vertices_of(StreamNetwork const& plan) {
    std::size_t count = 0;
    for (ArcId arc = 0; arc < plan.arc_count(); ++arc) {
        count += plan.arc(arc).line.size();
    }
    return count;
}

/// Rivers that run from cell to cell keep no corner where a branch was; what that shortens is measured again.
network::PrunedNetwork prune(StreamNetwork const& plan, recipe::NetworkRecipe const& rivers, double length_cells,
                             double cell_m, Run const& run) {
    network::PrunedNetwork pruned = network::prune(plan, {length_cells * cell_m, cell_m}, run);
    if (rivers.source != recipe::Source::dla && rivers.source != recipe::Source::forest) {
        return pruned;
    }
    for (std::size_t before = 0, now = vertices_of(pruned.network); now != before;) {
        StreamNetwork cut = network::cut_corners(pruned.network, cell_m, run);
        before = now;
        now = vertices_of(cut);
        pruned.network = network::prune(cut, {length_cells * cell_m, cell_m}, run).network;
    }
    return pruned;
}

// A note for each outlet of one network that another, which was pruned, has no more.
std::vector<Finding> pruned_outlets(StreamNetwork const& before, StreamNetwork const& after) {
    auto const places = [](StreamNetwork const& network) {
        std::vector<Vec2> at;
        for (NodeId const n : network.outlets()) {
            at.push_back(network.node(n).at);
        }
        std::ranges::sort(at, [](Vec2 a, Vec2 b) { return a.y != b.y ? a.y > b.y : a.x < b.x; });
        return at;
    };
    std::vector<Vec2> const left = places(after);
    std::vector<Finding> notes;
    for (Vec2 const p : places(before)) {
        if (std::ranges::find(left, p) == left.end()) {
            notes.push_back({"pruned_outlet", 0, p, 0.0,
                             fmt::format("the river that ended at ({:.1f}, {:.1f}) was pruned away, its branches are "
                                         "all too short",
                                         p.x, p.y)});
        }
    }
    return notes;
}

/// Rivers without their short branches.
struct PrunedRivers {
    StreamNetwork network;
    RiverFile file;
    std::int64_t arcs_before;
    std::vector<Finding> notes;
};

PrunedRivers pruned(recipe::NetworkRecipe const& rivers, StreamNetwork const& network, RiverFile file, double cell_m,
                    StageLog& stage_log, Run const& run) {
    network::PrunedNetwork kept = stage_log.stage(
        recipe::stage::prune.name, [&] { return prune(network, rivers, *rivers.prune_cells, cell_m, run); });
    stage_log.say(
        fmt::format("L={}   {} of {} arcs kept", *rivers.prune_cells, kept.network.arc_count(), kept.arcs_before));
    std::vector<Finding> notes;
    if (rivers.source == recipe::Source::forest) { // its rivers end where the land does
        notes = pruned_outlets(network, kept.network);
    }
    append(file.secondary, file.sources.missing(network, kept.network, LeftOut::pruned, "pruned"));
    file.imported = kept.network;
    return {std::move(kept.network), std::move(file), kept.arcs_before, std::move(notes)};
}

NetworkStatistics statistics_of(NetworkStatistics statistics, PrunedRivers const& kept) {
    statistics.arcs_traced = kept.arcs_before;
    statistics.arcs_kept = static_cast<std::int64_t>(kept.network.arc_count());
    return statistics;
}

/// Rivers of the source, what was found and the times of making them.
struct TimedSource {
    SourceRivers rivers;
    std::vector<Finding> findings;
    Timings timings_s;
};

/// About the bytes of a network's vertices.
std::int64_t bytes_of(StreamNetwork const& network) {
    constexpr std::size_t of_arc = 256;
    return static_cast<std::int64_t>(vertices_of(network) * sizeof(Vec2) + network.arc_count() * of_arc);
}

TimedSource source_of(RiversInput const& in, Run const& run) {
    return cached(
        run, "source", [&] { return recipe::cache_key(in.recipe); },
        [&] {
            StageLog stage_log(run);
            SourceRivers rivers = rivers_of_source(in, stage_log, run);
            return TimedSource{std::move(rivers), stage_log.take_findings(), stage_log.take()};
        },
        [](TimedSource const& source) {
            constexpr std::int64_t copies = 4; // of the network, with heights and features
            return copies * bytes_of(source.rivers.network) + source.rivers.land.cells();
        });
}

/// The rivers of a plan that has any.
DrawnRivers drawn(RiversInput const& in, Run const& run) {
    recipe::NetworkRecipe const& wanted = *in.recipe.network;
    StageLog stage_log(run);
    RiversInput of_source = in;
    of_source.recipe = recipe::recipe_for_source(in.recipe);
    TimedSource made = source_of(of_source, run);
    stage_log.add(made.timings_s);
    stage_log.find(made.findings);
    SourceRivers& source = made.rivers;
    PrunedRivers kept = pruned(wanted, source.network, std::move(source.file), source.grid.cell_m, stage_log, run);
    stage_log.find(kept.notes);
    NetworkStatistics statistics = statistics_of(std::move(source.statistics), kept);
    RiversToBorder carried = with_outlets_carried(wanted, std::move(kept.network), source.grid, std::move(source.land),
                                                  source.file_heights.has_value(), run);
    stage_log.find(carried.notes);
    refuse_if<BadParameter>(recipe::stage::meander.runs(in.recipe) && source.file_heights, "make.make_planform",
                            "network.meander cannot bend rivers whose heights come from their "
                            "file; set network.heights = \"graded\" or leave meander out");
    if (!source.file_heights) { // these cannot bend
        stage_log.find(few_vertices(in.recipe, carried.network, source.grid.cell_m));
    }
    BentRivers rivers =
        bent(in.recipe, std::move(carried.network), std::move(kept.file), source.grid, carried.land, stage_log, run);
    TypedNetwork typed = type_rivers(std::move(rivers.network), wanted, run);
    std::optional<ElevatedNetwork> file_heights;
    if (source.file_heights) {
        file_heights = network::keep_heights(typed.network, *source.file_heights);
    }
    return {{.grid = source.grid,
             .network = std::move(typed.network),
             .types = std::move(typed.types),
             .file_heights = std::move(file_heights),
             .land = std::move(carried.land),
             .file = std::move(rivers.file),
             .statistics = std::move(statistics),
             .findings = stage_log.take_findings(),
             .timings_s = stage_log.take()},
            made.findings.size()};
}

} // namespace

DrawnRivers draw_rivers(RiversInput const& in, Run const& run) {
    return cached(
        run, "planform", [&] { return recipe::cache_key(in.recipe); }, [&] { return drawn(in, run); },
        [](DrawnRivers const& kept) {
            constexpr std::int64_t copies = 4;
            return copies * bytes_of(kept.planform.network) + kept.planform.land.cells();
        });
}

} // namespace thalweg::make
