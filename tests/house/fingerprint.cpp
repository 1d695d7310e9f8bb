// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Prints a hash of the bits of every stage's result, from random numbers to surfaces. Every machine, compiler, build
// type and number of threads must print tests/data/fingerprint.txt. Of DEMs it prints a hash of the heights of each,
// whatever bytes GDAL writes for them (docs/gallery/terrain.txt). Usage: fingerprint [THREADS], fingerprint dem.tif ...
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <span>

#include <thalweg/blend/deform.hpp>
#include <thalweg/blend/paste.hpp>
#include <thalweg/blend/tin.hpp>
#include <thalweg/core/lattice.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/flow/catchments.hpp>
#include <thalweg/flow/condition.hpp>
#include <thalweg/flow/extract_streams.hpp>
#include <thalweg/flow/route.hpp>
#include <thalweg/fractal/estimate_fractal.hpp>
#include <thalweg/fractal/internal/refine.hpp>
#include <thalweg/fractal/match_statistics.hpp>
#include <thalweg/fractal/midpoint.hpp>
#include <thalweg/geometry/natural_neighbours.hpp>
#include <thalweg/geometry/tin_of_dem.hpp>
#include <thalweg/geometry/triangulate.hpp>
#include <thalweg/growth/dla/grow_dla.hpp>
#include <thalweg/growth/forest/coast.hpp>
#include <thalweg/growth/forest/grow_forest.hpp>
#include <thalweg/growth/tokunaga/embed_tree.hpp>
#include <thalweg/growth/tokunaga/grow_strokes.hpp>
#include <thalweg/growth/tokunaga/grow_tokunaga.hpp>
#include <thalweg/growth/tokunaga/lsystem.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/make/laws.hpp>
#include <thalweg/measure/relief/statistics.hpp>
#include <thalweg/network/channels/channels.hpp>
#include <thalweg/network/channels/lakes.hpp>
#include <thalweg/network/channels/side_valleys.hpp>
#include <thalweg/network/elevation/known_heights.hpp>
#include <thalweg/network/elevation/river_types.hpp>
#include <thalweg/network/elevation/set_heights.hpp>
#include <thalweg/network/import/import_lines.hpp>
#include <thalweg/network/import/land_and_sea.hpp>
#include <thalweg/network/order/order.hpp>
#include <thalweg/network/planform/carry_outlets.hpp>
#include <thalweg/network/planform/meander.hpp>
#include <thalweg/network/planform/rotate.hpp>
#include <thalweg/network/planform/split_confluences.hpp>
#include <thalweg/network/vectorise/prune.hpp>
#include <thalweg/network/vectorise/rasterise.hpp>
#include <thalweg/network/vectorise/vectorise.hpp>
#include <thalweg/recipe/frame.hpp>
#include <thalweg/skeleton/draw_skeleton.hpp>
#include <thalweg/skeleton/midpoint_inverse.hpp>
#include <thalweg/skeleton/random_fields.hpp>
#include <thalweg/skeleton/regress.hpp>
#include <thalweg/skeleton/ridges.hpp>
#include <thalweg/skeleton/scatter.hpp>
#include <thalweg/solver/grid/internal/poisson.hpp>
#include <thalweg/solver/spectral/fft.hpp>
#include <thalweg/solver/statistics/field_statistics.hpp>
#include <thalweg/surface/diffusion/diffusion.hpp>
#include <thalweg/surface/diffusion/internal/diffusion.hpp>
#include <thalweg/surface/dilation/dilation.hpp>
#include <thalweg/surface/dilation/separable.hpp>
#include <thalweg/surface/equilibrium/equilibrium.hpp>
#include <thalweg/surface/equilibrium/rebuild.hpp>
#include <thalweg/surface/tin/rasterise_tin.hpp>

#include "fnv.hpp"

using namespace thalweg;

namespace {

void print(char const* stage, Fnv const& fnv) {
    std::printf("%-28s %016llx\n", stage, static_cast<unsigned long long>(fnv.hash()));
}

Fnv hash_of_chance() {
    Fnv fnv;
    for (std::uint64_t i = 0; i < 1000; ++i) {
        fnv.add_all(random_block(7, i, i + 1, i * i, ~i));
    }
    return fnv;
}

Fnv hash_of_elementary() {
    Fnv fnv;
    for (int i = 1; i <= 20000; ++i) {
        double const x = i * 0.37;
        fnv.put(portable::exp((x - 3700.0) * 0.1), portable::log(x), portable::pow(x, 0.7), portable::sin(x),
                portable::cos(x), portable::atan2(x - 3700.0, x));
    }
    return fnv;
}

Fnv hash_of(std::vector<Cell> const& cells) {
    return Fnv().each(cells);
}

Fnv hash_of(StreamNetwork const& network) {
    Fnv fnv;
    for (ArcId arc = 0; arc < network.arc_count(); ++arc) {
        fnv.put(network.from(arc), network.to(arc), network.arc(arc).persistence).each(network.arc(arc).line);
    }
    return fnv;
}

Fnv hash_of(NetworkOrders const& orders) {
    Fnv fnv;
    fnv.add_all(orders.strahler);
    fnv.add_all(orders.shreve);
    fnv.add_all(orders.hack);
    fnv.add_all(orders.topological);
    fnv.add_all(orders.node_dist_out_m);
    return fnv;
}

Fnv hash_of(network::RiverTypes const& types) {
    Fnv fnv;
    fnv.each(types.type).add_all(types.braided);
    return fnv;
}

Fnv hash_of(ElevatedNetwork const& network) {
    Fnv fnv;
    fnv.add_all(network.node_z);
    for (std::vector<double> const& z : network.arc_z) {
        fnv.add_all(z);
    }
    return fnv;
}

template <class T> Fnv hash_of(Raster<T> const& raster) {
    Fnv fnv;
    for (T const value : raster.values()) {
        fnv.add(value == value ? value : T{}); // which NaN it is may differ
    }
    return fnv;
}

Fnv hash_of(Tin const& tin) {
    Fnv fnv;
    fnv.each(tin.vertices);
    for (auto const& [a, b, c] : tin.triangles) {
        fnv.put(std::uint64_t{a}, std::uint64_t{b}, std::uint64_t{c});
    }
    return fnv;
}

/// Breaklines of a network.
std::vector<std::vector<Vec3>> lines_of(ElevatedNetwork const& network) {
    std::vector<std::vector<Vec3>> lines;
    for (ArcId a = 0; a < network.planform.arc_count(); ++a) {
        auto& line = lines.emplace_back();
        for (std::size_t k = 0; Vec2 const& p : network.planform.arc(a).line) {
            line.push_back({p.x, p.y, network.arc_z[a][k++]});
        }
    }
    return lines;
}

Fnv hash_of(surface::Expansion const& expansion) {
    Fnv fnv;
    fnv.add_all(expansion.level.values());
    fnv.add_all(expansion.base.values());
    return fnv;
}

Fnv hash_of(Raster<solver::Complex> const& raster) {
    return Fnv().each(raster.values());
}

Fnv hash_of(measure::Statistics const& s) {
    return Fnv().put(s.mean, s.std, s.skew, s.kurtosis, s.roughness_m, s.slope_rad, s.lx.cells, s.ly.cells, s.dimension,
                     s.dimension_dyadic);
}

/// Lengths with the factors 2, 3, 5 and 7, for which the transform has code of its own or a general one.
Raster<solver::Complex> transformed(Run const& run) {
    Raster<solver::Complex> values(Grid{180, 98, 1.0, 0.0, 0.0, ""});
    for (std::int64_t i = 0; i < values.cells(); ++i) {
        auto const words = random_block(9, static_cast<std::uint64_t>(i));
        values[i] = {unit(words[0]) - 0.5, unit(words[1]) - 0.5};
    }
    return solver::fft(std::move(values), solver::Direction::forward, run);
}

/// The rivers that a DEM draws by itself, and their laws.
void print_laws(Raster<float> const& dem, Run const& run) {
    flow::FlowField const drainage = flow::route(dem, run);
    print("flow_lengths", hash_of(flow::flow_lengths(drainage, run)));
    print("extract_streams", hash_of(flow::extract_streams(drainage, dem, {.support_cells = 20}, run).network));
    Fnv fnv;
    auto const found = make::laws_of_dem(dem, drainage, {.network_m = 400.0 * dem.grid().cell_m}, run);
    fnv.add(found.support_cells);
    for (make::LawRow const& row : make::law_rows(found.laws)) {
        fnv.add(row.value.value_or(0.0));
        for (auto const& [name, figure] : row.details) {
            fnv.add(std::isnan(figure) ? 0.0 : figure); // a NaN has many bits
        }
    }
    print("network_laws", fnv);
}

void print_lands_of_statistics(Run const& run) {
    print("fft", hash_of(transformed(run)));
    Grid const grid{130, 40, 300.0, 0.0, 0.0, ""};
    skeleton::FieldParams const field{536.0, 131.6, 20.68, 39.74, 3};
    print("separable_ar", hash_of(skeleton::separable_ar(grid, field, run)));
    Raster<float> const literal = skeleton::markov3(grid, field, run);
    print("markov3", hash_of(literal));
    print("attract", hash_of(skeleton::attract(literal, {{91, 1}, 1038.0, 20.0})));
    print("shift_mean", hash_of(skeleton::shift_mean(literal, 600.0)));
    solver::StableCovariance const prior = solver::with_slope({20.68, 39.74, 2.39}, 131.6, 1.51);
    Raster<float> const land =
        skeleton::grf(grid, {.mean = 536.0, .std = 131.6, .covariance = prior, .seed = 3}, run).dem;
    print("grf", hash_of(land));
    fractal::Targets targets;
    targets.mean = 536.0;
    targets.std = 131.6;
    targets.max = fractal::FixedHeight{{91, 1}, 1038.0};
    targets.min = fractal::FixedHeight{{129, 26}, 276.0};
    targets.lx_cells = 20.68;
    targets.ly_cells = 39.74;
    targets.slope_rad = 1.499;
    targets.dimension = 2.39;
    auto const projected = fractal::match_statistics(land, targets, {{{20, 20}, 500.0}}, {.prior = prior}, run);
    print("project", hash_of(projected.dem));
    print("statistics", hash_of(measure::statistics(projected.dem, run)));
    print_laws(projected.dem, run);
}

void print_points(Run const& run) {
    Grid const grid{130, 40, 300.0, 0.0, 0.0, ""};
    skeleton::ScatterParams params;
    params.count = 200;
    params.mean_m = 536.0;
    params.std_m = 131.6;
    params.highest = Vec3{27450.0, -450.0, 1038.0};
    params.reach_cells = 8.0;
    params.spacing_cells = 3.0;
    FeaturePoints const darts = skeleton::scatter(grid, params, run).points;
    params.spacing_cells = 4.2;
    params.law = skeleton::HeightLaw::normal;
    FeaturePoints const spread = skeleton::scatter(grid, params, run).points;
    print("scatter", Fnv().each(darts.points).each(spread.points));
    print("regress", hash_of(skeleton::regress(darts, grid, {}, run).surface));
    skeleton::RegressParams steep;
    steep.slope = skeleton::SlopeMode::mean;
    steep.slope_rad = 1.4;
    print("regress, mean slope", hash_of(skeleton::regress(darts, grid, steep, run).surface));
}

/// Ridges between streams, by both methods.
void print_ridges(ElevatedNetwork const& rivers, Grid const& grid, Run const& run) {
    auto const streams = network::streams(rivers.planform, network::order(rivers.planform));
    Fnv labels;
    labels.add_all(streams);
    print("streams", labels);
    using Method = skeleton::RidgesParams::Method;
    for (Method const method : {Method::voronoi, Method::segments}) {
        skeleton::RidgesParams params;
        params.method = method;
        Fnv fnv;
        for (RidgeLine const& ridge : skeleton::ridges(rivers, streams, grid, params, run).lines) {
            fnv.put(ridge.left, ridge.right).each(ridge.line);
        }
        print(method == Method::voronoi ? "ridges, voronoi" : "ridges, segments", fnv);
    }
}

/// What a surface is drawn through: the valley's rivers, lines across as ridges, and a point.
void print_skeleton(Valley const& valley, Run const& run) {
    Grid const& grid = valley.z.grid();
    std::vector<skeleton::PlaceOnLine> places;
    RidgeLines ridges;
    for (std::int64_t k = 1; k < 8; ++k) {
        Vec2 const from = grid.centre({0, k * (grid.height - 1) / 8});
        Vec2 const to = grid.centre({grid.width - 1, (8 - k) * (grid.height - 1) / 8});
        double const z = 100.0 * static_cast<double>(k);
        ridges.lines.push_back({{{from.x, from.y, z}, {to.x, to.y, 900.0 - z}}, k, k + 1});
        places.push_back({from, 0.1 * static_cast<double>(k)});
        places.push_back({to, 0.1 * static_cast<double>(k)});
    }
    skeleton::NoiseAlongParams const noise{3, 25.0, 10.0 * grid.cell_m};
    Fnv fnv;
    fnv.add_all(skeleton::noise_along(places, {grid.west, grid.north}, noise, run));
    print("noise_along", fnv);
    Vec2 const middle = grid.centre({grid.width / 2, grid.height / 3});
    FeaturePoints const points{{{middle.x, middle.y, 777.0}}, ""};
    Skeleton const drawn = skeleton::draw_skeleton(valley, ridges, points, {noise}, run).skeleton;
    print("draw_skeleton", hash_of(drawn.z));
    for (skeleton::HeightLaw const law : {skeleton::HeightLaw::uniform, skeleton::HeightLaw::normal}) {
        auto const scattered = skeleton::scatter_between(valley, {}, {5, 60, 4.0, 0.3, 0.0, law}, run).points;
        print(law == skeleton::HeightLaw::uniform ? "scatter_between" : "scatter_between, normal",
              Fnv().each(scattered.points));
    }
    print("midpoint_inverse", hash_of(skeleton::midpoint_inverse(drawn, {6.0}, run).z));
}

/// The expansion without the vector instructions of this processor, which the C library's masks do not hide.
surface::Expansion expand_plain(Valley const& valley, Run const& run) {
    using namespace surface::separable;
    surface::Expansion expansion{Raster<std::int32_t>(valley.z.grid()), Raster<float>(valley.z.grid())};
    auto const swept = sweep_down<std::uint16_t>(valley, expansion.base, Lanes::plain, run);
    sweep_up(swept, expansion.base, expansion.level, Lanes::plain, run);
    return expansion;
}

Fnv hash_of(fractal::Fractal const& fractal) {
    return Fnv().put(fractal.hurst, fractal.sigma);
}

/// Coarse land with a hole, at random.
Raster<float> coarse_land() {
    Raster<float> z(Grid{23, 19, 16.0, 0.0, 0.0, ""});
    for (std::int64_t i = 0; i < z.cells(); ++i) {
        z[i] = static_cast<float>(100.0 * unit(random_word(5, static_cast<std::uint64_t>(i))));
    }
    z[{11, 7}] = std::numeric_limits<float>::quiet_NaN();
    return z;
}

/// Midpoint displacement without the vector instructions of this processor.
Raster<float> midpoint_plain(Raster<float> const& coarse, fractal::MidpointParams const& params, Run const& run) {
    fractal::Refinement refinement;
    refinement.coarse = &coarse;
    refinement.holes = true;
    refinement.levels = params.levels;
    refinement.stencil = params.stencil;
    refinement.noise = params.noise;
    refinement.seed = params.seed;
    refinement.character.hurst = *params.hurst;
    refinement.character.sigma = *params.sigma;
    Raster<float> dem(Grid{params.width, params.height, 1.0, 0.0, 0.0, ""});
    fractal::Floors floors;
    fractal::refine(refinement, dem, floors, run);
    return dem;
}

void print_detail(Run const& run) {
    Raster<float> const coarse = coarse_land();
    fractal::MidpointParams params;
    params.width = 339;
    params.height = 287;
    params.hurst = 0.6;
    params.sigma = 20.0;
    Raster<float> const dem = fractal::midpoint(coarse, params, run).dem;
    print("midpoint 16", hash_of(dem));
    print("estimate_fractal", hash_of(fractal::estimate_fractal(dem, {}, run)));
    print("estimate_fractal, absolute",
          hash_of(fractal::estimate_fractal(dem, {fractal::Differences::absolute, {}}, run)));
    print("midpoint 16, plain", hash_of(midpoint_plain(coarse, params, run)));
    params.noise = fractal::Noise::uniform;
    params.stencil = fractal::Stencil::four;
    print("midpoint 4, uniform", hash_of(fractal::midpoint(coarse, params, run).dem));
    print("midpoint 4, uniform, plain", hash_of(midpoint_plain(coarse, params, run)));
    params = {};
    params.stencil = fractal::Stencil::twelve;
    params.adaptation = fractal::Adaptation::local;
    print("midpoint 12, local", hash_of(fractal::midpoint(coarse, params, run).dem));
    params.stencil = fractal::Stencil::exact;
    params.adaptation = fractal::Adaptation::global;
    params.hurst = 0.8;
    print("midpoint exact", hash_of(fractal::midpoint(coarse, params, run).dem));
}

/// A terrain resampled for engines, finer along one axis and coarser along the other, and as a solid.
void print_lattice(Raster<float> const& land, Run const& run) {
    Lattice const samples = lattice(land, 2 * land.width() + 5, land.height() / 3, run);
    print("lattice", hash_of(samples.z));
    LatticeMesh const solid = solid_mesh(samples, 50.0, 1.5, run);
    print("solid_mesh", hash_of(Tin{solid.vertices, solid.triangles}));
}

/// Types of rivers, and the heights that follow from them or from areas.
void print_rivers(StreamNetwork const& network, Grid const& grid, Run const& run) {
    network::RiverTypes const types =
        network::assign_types(network, network::order(network), {.coast_m = 20.0 * grid.cell_m}, run);
    print("assign_types", hash_of(types));
    print("set_heights_by_type",
          hash_of(network::set_heights_by_type(network, types, {.draw = network::SlopeDraw::uniform, .seed = 3}, run)));
    flow::ContributingAreas const areas = flow::areas_nearest(network, grid, run);
    network::GradedNetwork const graded = network::set_heights_graded(
        network, areas.us_area_m2, areas.ds_area_m2, {.least_area_m2 = grid.cell_m * grid.cell_m}, run);
    print("set_heights_graded", hash_of(graded.network));
}

/// Rivers drawn in all directions, found by angles and by a DEM.
void print_directions(StreamNetwork const& network, Raster<float> const& dem, Run const& run) {
    RiverLines lines;
    for (ArcId arc = 0; arc < network.arc_count(); ++arc) {
        RiverLine& line = lines.lines.emplace_back();
        line.feature = static_cast<std::int64_t>(arc) + 1;
        for (Vec2 const& p : network.arc(arc).line) {
            line.vertices.push_back({p.x, p.y, 0.0});
        }
        if (random_word(5, arc) % 2 == 0) {
            std::reverse(line.vertices.begin(), line.vertices.end());
        }
    }
    for (Raster<float> const* const heights : {static_cast<Raster<float> const*>(nullptr), &dem}) {
        network::ImportedNetwork const imported = network::import_lines(lines, {.dem = heights}, run);
        Fnv fnv = hash_of(imported.network);
        for (Finding const& doubt : imported.directions.doubts) {
            fnv.add(doubt.amount);
        }
        fnv.add(imported.directions.expected_wrong_m);
        print(heights == nullptr ? "directions" : "directions by a DEM", fnv);
    }
}

/// Squares turned by 20 degrees around a place, with waves.
Tin small_mesh(Vec2 middle, double side_m) {
    constexpr std::uint32_t across = 7;
    blend::LinearMap const turn = blend::rotation({0.0, 0.0, 1.0}, 20.0, side_m);
    Tin tin;
    for (std::uint32_t i = 0; i < across * across; ++i) {
        double const x = static_cast<double>(i % across) - 3.0;
        double const y = static_cast<double>(i / across) - 3.0;
        tin.vertices.push_back({middle.x + turn[0].x * x + turn[0].y * y, middle.y + turn[1].x * x + turn[1].y * y,
                                x * y + static_cast<double>(i * i % 11)});
        if (i % across + 1 < across && i / across + 1 < across) {
            tin.triangles.push_back({i, i + 1, i + across});
            tin.triangles.push_back({i + 1, i + across + 1, i + across});
        }
    }
    return tin;
}

/// A piece of one land set into another, on the grid and over triangles; a region bent.
void print_blend(Raster<float> const& target, Tin const& tin, Run const& run) {
    blend::PlacePatchParams placing;
    placing.at = target.grid().centre({target.width() / 2, target.height() / 2});
    placing.rotate_deg = 33.0;
    placing.scale = 6.0 * target.grid().cell_m / 16.0; // of its cells, which are 16 m wide
    blend::Patch const patch = blend::place_patch(coarse_land(), target.grid(), placing, run);
    Fnv placed = hash_of(patch.z);
    placed.add_all(patch.mask.values());
    print("place_patch", placed);
    print("paste", hash_of(blend::paste(target, patch, {}, run).dem));
    blend::PasteParams mixed;
    mixed.relief = blend::Relief::mixed;
    mixed.holes = blend::Holes::fill;
    mixed.feather_cells = 5.0;
    print("paste, mixed, feathered", hash_of(blend::paste(target, patch, mixed, run).dem));
    Cell const middle{target.width() / 2, target.height() / 2};
    print("deform", hash_of(blend::deform(target, patch.mask, {{middle, 100.0}}, {.scale = 1.5}, run).dem));
    auto guidance = blend::gradients_of(tin, tin.vertices, geometry::Measured::on_surface);
    for (std::size_t i = 0; i < guidance.size(); i += 3) {
        guidance[i] = blend::mapped(blend::rotation({1.0, 2.0, 3.0}, 20.0, 1.1), guidance[i]);
    }
    print("paste_tin",
          hash_of(blend::paste_tin(tin, guidance, {{0, tin.vertices[0]}}, geometry::Measured::on_surface, run).tin));
    auto const [west, east] = std::ranges::minmax_element(tin.vertices, {}, [](Vec3 const& v) { return v.x; });
    auto const [south, north] = std::ranges::minmax_element(tin.vertices, {}, [](Vec3 const& v) { return v.y; });
    Vec2 const middle_of_tin{0.5 * (west->x + east->x), 0.5 * (south->y + north->y)};
    print("fuse_tin", hash_of(blend::fuse_tin(tin, small_mesh(middle_of_tin, 0.05 * (east->x - west->x)), run).tin));
}

/// solve_poisson with the loops of any processor of the architecture.
Raster<double> poisson_plain(solver::GridProblem problem, Run const& run) {
    auto const contents = solver::survey_problem(problem, "fingerprint", run);
    auto iterate = solver::coloured(problem, contents, run);
    auto const& rows = solver::grid_rows(Lanes::plain);
    double const zero = solver::residual_norm(iterate, rows, run);
    solver::set_guess(problem, contents, iterate, run);
    auto levels = solver::coarse_levels(problem.kind, run);
    solver::conjugate_gradients(iterate, levels, zero, {1e-9, 1000}, rows, run);
    solver::collect(iterate, contents, problem, run);
    return problem.value;
}

void print_diffused(Valley const& valley, Run const& run) {
    auto const problem = surface::problem_through(valley.z, {}, "fingerprint", run);
    print("solve_poisson", hash_of(solver::solve_poisson(problem, {1e-9, 1000}, run).value));
    print("solve_poisson, plain", hash_of(poisson_plain(problem, run)));
    print("harmonic", hash_of(surface::harmonic(valley, run)));
    surface::DiffuseParams params;
    params.noise_m = 3.0;
    print("diffuse", hash_of(surface::diffuse({valley.z}, params, run).dem));
    params.mode = surface::Diffusion::explicit_sweeps;
    params.iterations = 50;
    print("diffuse, explicit", hash_of(surface::diffuse({valley.z}, params, run).dem));
}

Fnv hash_of(growth::TokunagaTree const& tree) {
    Fnv fnv;
    for (growth::TreeLink const& link : tree.links) {
        fnv.add(link.down);
        fnv.add_all(link.up);
        fnv.put(static_cast<std::int64_t>(link.order), static_cast<std::int64_t>(link.turn));
    }
    fnv.add(tree.link_length);
    return fnv;
}

/// Of a land rough enough that some of its depressions are filled and others cut.
void print_drained(Raster<float> land, Valley const& valley, Run const& run) {
    for (std::int64_t i = 0; i < land.cells(); ++i) {
        if (std::isnan(valley.z[i])) {
            land[i] += static_cast<float>(random_word(7, static_cast<std::uint64_t>(i)) >> 40U) * 0x1p-21F; // up to 8 m
        }
    }
    print("fill", hash_of(flow::condition(land, valley, {flow::Conditioning::fill}, run).dem));
    print("carve", hash_of(flow::condition(land, valley, {flow::Conditioning::carve}, run).dem));
}

void print_water(Raster<float> const& land, StreamNetwork const& rivers, Run const& run) {
    flow::FlowField const d8 = flow::route(land, run);
    print("drain", hash_of(d8.area_cells));
    flow::DinfFlow const dinf = flow::route_dinf(land, d8, run);
    print("drain_dinf", hash_of(dinf.bearing));
    print("drain_dinf, areas", hash_of(dinf.area_cells));
    print("catchments", hash_of(flow::catchments(flow::reaches_of(rivers), d8, run).reach));
}

void print_trees(Run const& run) {
    growth::TokunagaTree const tree = growth::grow_tokunaga({.generator = 3, .order = 5}, run);
    print("grow_tokunaga", hash_of(tree));
    Fnv word;
    for (char const letter : growth::write_lsystem(tree)) {
        word.add(static_cast<std::int64_t>(letter));
    }
    print("write_lsystem", word);
    Fnv turtle;
    growth::LSystem const rules =
        growth::read_rules("axiom G\niterations 6\nG -> F[--G]F[-G][+G]\nF -> FF\nF -> F[++G]F", "");
    for (auto const& line : growth::draw_word(growth::rewrite(rules, 7, run), rules.angle_deg, run)) {
        turtle.each(line);
    }
    print("rewrite, draw_word", turtle);
    growth::EmbedParams const params{.region = {{0, 0}, {4000, 0}, {4000, 2500}, {1500, 2000}, {0, 4000}},
                                     .mouth = {2000, 0}};
    print("embed_tree", hash_of(growth::embed_tree(tree, params, run).network));
    RiverLines strokes;
    strokes.lines.resize(2);
    strokes.lines[0].vertices = {{500, 0, 0}, {700, 900, 0}, {500, 1900, 0}};
    strokes.lines[1].vertices = {{696, 880, 0}, {1500, 1600, 0}};
    strokes.lines[1].lambda = 3;
    Grid const grid{200, 200, 10.0, 0.0, 2000.0, ""};
    print("grow_strokes", hash_of(growth::grow_strokes(strokes, grid, {}, run).network));
}

/// Land in equilibrium, and all that stands before and after it.
void print_equilibrium(StreamNetwork const& pruned, Grid const& box, Run const& run) {
    network::RotatedNetwork const turned =
        network::rotate(pruned, Grid{0, 0, box.cell_m, box.west, box.north, ""}, {20.0});
    print("rotate", hash_of(turned.network));
    Grid const& grid = turned.grid;
    StreamNetwork const carried = network::carry_outlets(turned.network, grid).network;
    std::vector<double> const areas = flow::areas_nearest(carried, grid, run).ds_area_m2;
    StreamNetwork const bent = network::meander(carried, grid, areas, {}, run).network;
    print("meander", hash_of(bent));
    network::ChannelsOfArcs const drawn = network::channels(bent, grid, {}, run);
    Fnv cells;
    cells.add_all(drawn.channels.cell);
    cells.add_all(drawn.channels.receiver);
    print("channels", cells);
    network::ChooseLakesParams const lakes{.share = 0.3, .min_area_cells = 200.0};
    network::FloodedLakes const flooded =
        network::flood_lakes(drawn, network::choose_lakes(drawn, areas, lakes, run), run);
    for (auto const edge : {surface::Edge::open, surface::Edge::closed, surface::Edge::coast}) {
        surface::EquilibriumParams params;
        params.edge = edge;
        print("equilibrium", hash_of(surface::equilibrium(flooded.drawn.channels, {}, params, run).dem));
    }
    surface::EquilibriumTerrain const land = surface::equilibrium(drawn.channels, {}, {}, run);
    network::ShortenedChannels const kept = network::shorten(bent, drawn, land.shortened);
    ElevatedNetwork const raised = network::elevate_from_dem(kept.network, kept.drawn.channels, land.dem);
    print("raise_from_land", hash_of(raised));
    flow::FlowField const drainage = flow::route(land.dem, run);
    print("side_valleys",
          hash_of(network::side_valleys(raised, kept.drawn.channels, land.dem, drainage, {60}, run).network));
    surface::EquilibriumParams fixed;
    fixed.heights = surface::RiverHeights::soft;
    Channels given = drawn.channels;
    given.z = network::channel_heights(network::set_heights(bent, {}, run).network, given);
    print("equilibrium, soft", hash_of(surface::equilibrium(given, {}, fixed, run).dem));
    print("rebuild", hash_of(surface::rebuild(given, {}, {}, run).terrain.dem));
}

void print_forest(Run const& run) {
    Grid grid;
    grid.width = 320;
    grid.height = 240;
    grid.cell_m = 30.0;
    Mask const island = growth::shape_island(grid, {0.8, 7}, run);
    print("shape_island", hash_of(island));
    std::vector<Cell> const outlets = growth::spread_outlets(island, growth::coast_cells(island), {}, run);
    print("spread_outlets", hash_of(outlets));
    growth::ForestParams slow;
    slow.sticking = 0.6;
    slow.visits = 2;
    print("plant_forest S=0.6 M=2", hash_of(growth::plant_forest(island, outlets, slow, run).network));
    StreamNetwork const planted = growth::plant_forest(island, outlets, {}, run).network;
    print("plant_forest", hash_of(planted));
    print("land_behind_outlets", hash_of(network::land_behind_outlets(planted, grid, run)));
    RiverLines coast;
    coast.lines.emplace_back().vertices = {{-100.0, -3000.0, 0.0}, {4000.0, -2500.0, 0.0}, {9700.0, -3300.0, 0.0}};
    print("land_and_sea", hash_of(network::land_and_sea(coast, {}, grid, run).land));
}

void print_dems(std::span<char*> files) {
    for (char const* const file : files) {
        print(file, hash_of(io::read_dem(file)));
    }
}

} // namespace

int main(int count, char** words) {
    if (count > 1 && std::isdigit(static_cast<unsigned char>(*words[1])) == 0) {
        print_dems({words + 1, words + count});
        return 0;
    }
    Run run;
    run.threads = count > 1 ? std::atoi(words[1]) : 0;

    print("chance", hash_of_chance());
    print("elementary", hash_of_elementary());
    growth::DlaParams const thick{.particles = 3000, .sticking = 0.3, .visits = 1, .seed = 11};
    print("grow_dla S=0.3 M=1", hash_of(growth::grow_dla(thick, run).cells));
    growth::Cluster const cluster = growth::grow_dla({.particles = 6000}, run);
    print("grow_dla S=0.85 M=3", hash_of(cluster.cells));
    print_forest(run);
    growth::Branch const branch = growth::pick_branch(cluster);
    print("pick_branch", hash_of(branch.cells));
    recipe::FramedBranch const framed = recipe::frame_branch(branch, {});
    Mask const skeleton = network::thin(framed.mask, run);
    print("thin", hash_of(skeleton));
    StreamNetwork const traced = network::trace(skeleton, {framed.mouth}, run);
    print("trace", hash_of(traced));
    double const cell_m = skeleton.grid().cell_m;
    StreamNetwork const pruned = network::prune(traced, {.length_m = 8 * cell_m, .cell_m = cell_m}, run).network;
    print("prune", hash_of(pruned));
    print("order", hash_of(network::order(pruned)));
    network::NetworkWithHeights const raised = network::set_heights(pruned, {}, run);
    print("set_heights", hash_of(raised.network));
    print_rivers(pruned, skeleton.grid(), run);
    Valley const valley = network::rasterise(raised.network, skeleton.grid()).valley;
    print("rasterise", hash_of(valley.z));
    print("split_confluences",
          hash_of(network::split_confluences(raised.network, {.distance_m = cell_m}, run).network));
    print("expand", hash_of(surface::expand(valley, run)));
    print("expand, plain", hash_of(expand_plain(valley, run)));
    print("expand_frontier", hash_of(surface::expand_frontier(valley, Mask(skeleton.grid(), 1), run)));
    auto const lines = lines_of(raised.network);
    Tin const tin = geometry::triangulate({}, lines, run).tin;
    Grid const& grid = skeleton.grid();
    print("triangulate", hash_of(tin));
    print("rasterise_tin",
          hash_of(surface::rasterise_tin(tin, grid, {surface::RasteriseTinParams::Outside::nearest}, run)));
    std::vector<Vec3> points;
    for (auto const& line : lines) {
        points.push_back(line.front());
    }
    print("natural_neighbours", hash_of(geometry::natural_neighbours(points, grid, {}, run)));
    Raster<float> const land = surface::dilate(valley, {{"rise_fall"}, surface::Metric::euclid, 500.0}, run).dem;
    print("tin_of_dem", hash_of(geometry::tin_of_dem(land, {20.0}, run).tin));
    print_directions(pruned, land, run);
    print("drape", hash_of(network::drape(pruned, land)));
    for (char const* increment : {"uniform", "decreasing", "rise_fall", "2+sin(x/7)*exp(-x/50)+x^0.3"}) {
        for (auto const metric : {surface::Metric::cityblock, surface::Metric::euclid}) {
            surface::DilateParams const params{{increment}, metric, 500.0};
            print(increment, hash_of(surface::dilate(valley, params, run).dem));
        }
    }
    print_diffused(valley, run);
    print_detail(run);
    print_lattice(land, run);
    print_lands_of_statistics(run);
    print_points(run);
    print_blend(land, tin, run);
    print_ridges(raised.network, grid, run);
    print_skeleton(valley, run);
    print_drained(land, valley, run);
    print_water(land, raised.network.planform, run);
    print_trees(run);
    print_equilibrium(pruned, grid, run);
}
