// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/box_means.hpp>
#include <thalweg/core/run/beside.hpp>
#include <thalweg/core/run/messages.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/run/small_blocks.hpp>
#include <thalweg/draw/comparison.hpp>
#include <thalweg/draw/diagrams.hpp>
#include <thalweg/draw/map.hpp>
#include <thalweg/draw/sections.hpp>
#include <thalweg/draw/wireframe.hpp>
#include <thalweg/flow/catchments.hpp>
#include <thalweg/io/mesh/points.hpp>
#include <thalweg/io/mesh/tin.hpp>
#include <thalweg/io/network/write_network.hpp>
#include <thalweg/io/raster/dem_derivatives.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/io/sources/sources.hpp>
#include <thalweg/make/file_values.hpp>
#include <thalweg/make/river_claims.hpp>
#include <thalweg/make/rivers.hpp>
#include <thalweg/network/order/order.hpp>
#include <thalweg/network/planform/split_confluences.hpp>
#include <thalweg/recipe/recipe_files.hpp>
#include <thalweg/report/internal/qgis_files.hpp>
#include <thalweg/report/landmarks.hpp>
#include <thalweg/report/page.hpp>
#include <thalweg/report/pictures.hpp>
#include <thalweg/report/report.hpp>

namespace thalweg::report {

namespace {

namespace fs = std::filesystem;

constexpr std::int64_t largest_report = 1 << 30;

std::vector<std::string> files_left_in(std::string const& folder) {
    std::string const report = folder + "/report.json";
    return fs::exists(report) ? files_of_report(io::read_text(report, largest_report)) : std::vector<std::string>{};
}

using Heights = std::optional<std::pair<double, double>>;

double relief_m(Heights const& heights) {
    return heights ? heights->second - heights->first : 0.0;
}

/// In the recipe's unit.
/// \param heights [m] range of the terrain
double contour_interval(make::MakeResult const& t, Heights const& heights) {
    double const asked = t.recipe.output.contour_interval;
    return asked > 0.0 ? asked : round_interval(relief_m(heights) / metres_in(t.recipe.output.units));
}

/// For pictures and the page, which are in metres.
double contour_interval_m(make::MakeResult const& t, Heights const& heights) {
    return t.recipe.output.units == HeightUnit::metre ? contour_interval(t, heights)
                                                      : round_interval(relief_m(heights));
}

/// Writes the network in another schema, with confluences split if it limits the number of arcs at a node.
void write_in_schema(make::MakeResult const& t, io::OutputFolder const& out, Run const& run) {
    io::SchemaTable const& schema = io::table_of(t.recipe.output.schema);
    network::Split split{t.terrain.rivers.network, {}};
    if (schema.most_upstream > 0) {
        split =
            network::split_confluences(t.terrain.rivers.network, {schema.most_upstream, t.terrain.grid.cell_m}, run);
    }
    std::vector<double> us_area_m2 = t.terrain.water.areas.us_area_m2;
    std::vector<double> ds_area_m2 = t.terrain.water.areas.ds_area_m2;
    make::add_pieces(split.pieces, us_area_m2, ds_area_m2);
    NetworkOrders const orders = make::order_rivers(split.network.planform, t.terrain.rivers.clues);
    std::vector<double> const node_area_m2 = make::node_areas(split.network.planform, us_area_m2, ds_area_m2);
    auto const user = make::user_data(t, split.network.planform);
    io::NetworkTables tables{split.network, orders, us_area_m2, ds_area_m2, node_area_m2, t.terrain.grid.crs, {}};
    tables.user = user ? &*user : nullptr;
    io::write_network(tables, out.path(fmt::format("network_{}.gpkg", schema.name)), {.schema = schema.schema}, run);
}

/// Calls write(tables) with what the files of a network hold.
template <class Write> void with_tables(make::MakeResult const& t, Write const& write) {
    std::map<std::string, std::string> const about = {{"version", version()},
                                                      {"seed", fmt::format("{}", t.recipe.seed)},
                                                      {"area_from", t.terrain.water.areas.source},
                                                      {"height_unit", name_of(t.recipe.output.units)}};
    auto const user = make::user_data(t, t.terrain.rivers.network.planform);
    io::NetworkTables const tables{t.terrain.rivers.network,
                                   t.terrain.rivers.orders,
                                   t.terrain.water.areas.us_area_m2,
                                   t.terrain.water.areas.ds_area_m2,
                                   t.terrain.water.areas.node_m2,
                                   t.terrain.grid.crs,
                                   about,
                                   t.terrain.rivers.types.braided.empty() ? nullptr : &t.terrain.rivers.types.braided,
                                   &t.terrain.ground.ridges,
                                   t.assessment.given ? &t.assessment.given->secondary : nullptr,
                                   user ? &*user : nullptr,
                                   t.recipe.output.units,
                                   true,
                                   t.assessment.sinks};
    write(tables);
}

void write_network(make::MakeResult const& t, io::OutputFolder const& out, Run const& run) {
    with_tables(t, [&](io::NetworkTables const& tables) {
        io::write_geopackage(tables, out.path("network"), run);
        io::write_shapefiles(tables, out.path("network"), run);
    });
    if (t.recipe.output.schema != io::Schema::native) {
        write_in_schema(t, out, run);
    }
    io::write_mask(make::river_mask(t.terrain.bed.valley), out.path("network.tif"), run);
    if (t.terrain.bed.lakes > 0) {
        io::write_mask(make::lake_cells(t.terrain.bed.channels), out.path("lakes.tif"), run);
    }
}

void write_catchments(make::MakeResult const& t, io::OutputFolder const& out, Run const& run) {
    auto const rows = make::catchment_rows(flow::reaches_of(t.terrain.rivers.network.planform),
                                           t.terrain.rivers.orders.arc_basin, *t.assessment.catchments);
    io::write_catchments({t.assessment.catchments->reach, rows}, out.path("catchments.gpkg"), run);
}

void write_areas(make::WaterAreas const& areas, io::OutputFolder const& out, Run const& run) {
    io::write_field(areas.d8, out.path("area_d8.tif"), run);
    io::write_field(areas.dinf, out.path("area_dinf.tif"), run);
}

void write_strata(make::MakeResult const& t, io::OutputFolder const& out, Run const& run) {
    io::write_codes(t.assessment.layers, out.path("strata.tif"), run);
    Raster<float> bed = make::bed_of(t.recipe, t.terrain.ground, t.terrain.grid, run);
    if (HeightUnit const unit = t.recipe.output.units; unit != HeightUnit::metre) {
        bed = make::in_unit(bed, unit);
    }
    io::write_dem(bed, out.path("strata_bed.tif"), run);
}

void write_uplift(make::MakeResult const& t, io::OutputFolder const& out, Run const& run) {
    Raster<float> const uplift = make::relative_uplift(t.recipe, t.terrain.grid, run);
    Raster<double> field(t.terrain.grid, 1.0);
    std::copy(uplift.values().begin(), uplift.values().end(), field.values().begin());
    io::write_field(field, out.path("uplift.tif"), run);
}

void write_tin(make::MakeResult const& t, io::OutputFolder const& out, Run const& run) {
    HeightUnit const unit = t.recipe.output.units;
    Tin const tin = make::in_unit(t.terrain.ground.tin, unit);
    io::write_tin(tin, t.terrain.grid.crs, out.path("tin.2dm"), io::TinFormat::mesh_2dm, unit, run);
    io::write_tin(tin, t.terrain.grid.crs, out.path("tin.ply"), io::TinFormat::ply, unit, run);
}

/// "": the heights follow from what was given, or of a terrain that is not of a place.
std::string remark_on_heights(make::MakeResult const& t) {
    return make::heights_are_invented(t.recipe) ? make::invented_heights : "";
}

void write_dem(make::MakeResult const& t, io::OutputFolder const& out, Run const& run) {
    HeightUnit const unit = t.recipe.output.units;
    Raster<float> const& dem = t.terrain.ground.dem;
    io::DemLabel const label{unit, remark_on_heights(t)};
    if (unit == HeightUnit::metre) {
        io::write_dem(dem, out.path("dem.tif"), label, run);
    } else {
        io::write_dem(make::in_unit(dem, unit), out.path("dem.tif"), label, run);
    }
}

/// What a comparison shows: rasters of at most so many columns.
struct ShownAgainst {
    Raster<std::uint8_t> shade_of_dem;
    Raster<std::uint8_t> shade;
    Raster<float> difference;
    Mask divides_of_dem;
    Mask divides;
    double limit_m = 1.0;

    draw::ComparisonSheet sheet() const { return {shade_of_dem, shade, difference, divides_of_dem, divides, limit_m}; }
};

ShownAgainst shown_against(make::Against const& against, Raster<float> const& dem, std::int64_t most_columns) {
    std::int64_t const columns = std::min(most_columns, dem.width());
    Raster<float> land = box_means(dem, columns);
    ShownAgainst shown;
    shown.shade = io::hillshade(land);
    shown.difference = box_means(against.difference, columns);
    for (std::int64_t i = 0; i < land.cells(); ++i) {
        land[i] -= shown.difference[i]; // now the DEM
    }
    shown.shade_of_dem = io::hillshade(land);
    shown.divides_of_dem = box_marks(against.divides_of_dem, columns);
    shown.divides = box_marks(against.divides, columns);
    shown.limit_m = draw::limit_of_differences(against.difference);
    return shown;
}

ElevatedNetwork const* network_of(make::MakeResult const& t) {
    return t.recipe.network ? &t.terrain.rivers.network : nullptr;
}

NetworkOrders const* orders_of(make::MakeResult const& t) {
    return t.recipe.network ? &t.terrain.rivers.orders : nullptr;
}

/// What several files of a terrain's surface need.
class SurfaceParts {
public:
    /// \param map whose width its means have
    explicit SurfaceParts(make::MakeResult const& made, draw::MapParams map = {}) : made_(made), map_(std::move(map)) {}

    Overview const& overview(Run const& run) {
        std::call_once(seen_made_, [&] {
            Raster<float> const& dem = made_.terrain.ground.dem;
            seen_ = overview_of(dem, draw::columns_of_map(dem.grid(), map_), run);
        });
        return seen_;
    }
    /// In metres, for a map of all cells.
    std::vector<io::ContourLine> const& contours(Run const& run) {
        double const step = contour_interval_m(made_, overview(run).range);
        std::call_once(contours_made_, [&] { contours_ = io::contours(made_.terrain.ground.dem, step, run); });
        return contours_;
    }
    std::vector<Summit> const& summits(Run const& run) {
        Overview const& seen = overview(run);
        std::call_once(summits_made_,
                       [&] { summits_ = report::summits(made_.terrain.ground.dem, seen, summits_named, run); });
        return summits_;
    }

private:
    make::MakeResult const& made_;
    draw::MapParams map_;
    std::once_flag seen_made_;
    std::once_flag contours_made_;
    std::once_flag summits_made_;
    Overview seen_;
    std::vector<io::ContourLine> contours_;
    std::vector<Summit> summits_;
};

/// Whether a map shows each cell of the terrain, with its contours; else it has others.
bool shows_each_cell(make::MakeResult const& t, draw::MapParams const& map) {
    Raster<float> const& dem = t.terrain.ground.dem;
    return dem.width() <= draw::columns_of_map(dem.grid(), map);
}

draw::Picture map_with(make::MakeResult const& t, SurfaceParts& parts, draw::MapParams map, Run const& run) {
    Raster<float> const& dem = t.terrain.ground.dem;
    Mask const lakes = t.terrain.bed.lakes > 0 ? make::lake_cells(t.terrain.bed.channels) : Mask{};
    Overview const& seen = parts.overview(run);
    ShownLand const land(dem, seen, lakes, run);
    draw::MapSheet sheet = land.sheet();
    sheet.network = network_of(t);
    sheet.orders = orders_of(t);
    sheet.ridges = &t.terrain.ground.ridges;
    sheet.areas_m2 = t.terrain.water.areas.ds_area_m2;
    map.contour_interval_m = contour_interval_m(t, seen.range);
    map.remark = remark_on_heights(t);
    if (land.is_whole()) {
        for (auto const& [z, line] : parts.contours(run)) {
            sheet.contours.emplace_back(z, line);
        }
    } else {
        sheet.contours = land.contours(map.contour_interval_m, run);
    }
    return draw_land(std::move(sheet), sea_of(t.terrain), parts.summits(run), map);
}

void write_contours(make::MakeResult const& t, SurfaceParts& parts, io::OutputFolder const& out, Run const& run) {
    HeightUnit const unit = t.recipe.output.units;
    double const step = contour_interval(t, parts.overview(run).range);
    auto const write = [&](std::vector<io::ContourLine> const& contours) {
        io::write_contours(contours, step, t.terrain.grid.crs, out.path("contours.gpkg"), unit, run);
    };
    if (unit != HeightUnit::metre) {
        write(io::contours(make::in_unit(t.terrain.ground.dem, unit), step, run));
    } else if (shows_each_cell(t, {})) {
        write(parts.contours(run));
    } else { // not kept for the map
        write(io::contours(t.terrain.ground.dem, step, run));
    }
}

draw::Picture curve_of(make::MakeResult const& t) {
    return draw::curve(t.terrain.ground.dilated().increments, {t.recipe.surface->dilate.increment.increment});
}

draw::Picture wireframe_of(make::MakeResult const& t, std::string const& title) {
    draw::WireframeScene const land{t.terrain.ground.dem, network_of(t), orders_of(t)};
    draw::WireframeParams wireframe;
    wireframe.title = title;
    wireframe.azimuth_deg = draw::azimuth_up_valley(land);
    return draw::wireframe(land, wireframe);
}

draw::Picture sections_of(make::MakeResult const& t, std::string const& title) {
    draw::SectionsParams sections;
    sections.title = title;
    if (make::has_layers(t.recipe, t.terrain.ground)) {
        sections.below = layers_below(t.recipe, t.terrain.ground.dem, t.terrain.ground.equilibrium()->strata_shift_m);
    }
    return draw::sections(t.terrain.ground.dem, network_of(t), orders_of(t), sections);
}

draw::Picture profile_of(make::MakeResult const& t, std::string const& title) {
    draw::ProfileParams profile;
    profile.title = title;
    return draw::profile(t.terrain.rivers.network, t.terrain.rivers.orders, profile);
}

/// Writes the folder of a terrain, each group of files beside the others and beside the work of the caller.
class FolderWriter {
public:
    /// \param made outlives this object
    FolderWriter(make::MakeResult const& made, std::string const& folder, io::Existing existing, Run const& run)
        : made_(made), out_(folder, existing, files_left_in(folder)), run_(run), title_(recipe::title_of(made.recipe)),
          recipe_(recipe::keep_inputs(made.recipe, out_)), parts_(made), jobs_(run, "write") {}

    /// Begins with the files that need no assessment.
    void begin() {
        if (made_.terrain.has_surface()) {
            begin_surface();
        }
        if (made_.recipe.network && writes(recipe::OutputFiles::pictures)) {
            add_picture("write_profile", "profile.svg", [this] { return profile_of(made_, title_); });
        }
        if (!made_.terrain.ground.tin.vertices.empty() && made_.recipe.skeleton && made_.recipe.skeleton->tin &&
            writes(recipe::OutputFiles::tin)) {
            add("write_tin", [this](Run const& run) { write_tin(made_, out_, run); });
        }
    }

    /// Writes the others.
    /// \return the names of the files, report.json last
    std::vector<std::string> finish() {
        if (made_.recipe.network && writes(recipe::OutputFiles::network)) {
            add("write_network", [this](Run const& run) { write_network(made_, out_, run); });
        }
        std::string const recipe_toml = recipe::write_recipe(recipe_);
        if (writes(recipe::OutputFiles::page)) {
            add("write_page", [this, recipe_toml](Run const& run) {
                PageParams params = page_params_of(made_, recipe_toml);
                if (made_.terrain.has_surface()) {
                    params.summits = parts_.summits(run);
                }
                io::write_text(out_.path("report.html"), page(made_, params, run));
            });
        }
        if (made_.assessment.layers.cells() > 0 && writes(recipe::OutputFiles::dem)) {
            add("write_strata", [this](Run const& run) { write_strata(made_, out_, run); });
        }
        if (made_.assessment.catchments && writes(recipe::OutputFiles::catchments)) {
            add("write_catchments", [this](Run const& run) { write_catchments(made_, out_, run); });
        }
        if (made_.assessment.against && writes(recipe::OutputFiles::pictures)) {
            add_picture("write_against", "against.png",
                        [this] { return comparison_against(*made_.assessment.against, made_.terrain, title_); });
        }
        if (made_.assessment.water_areas && writes(recipe::OutputFiles::areas)) {
            add("write_areas", [this](Run const& run) { write_areas(*made_.assessment.water_areas, out_, run); });
        }
        if (made_.recipe.output.uplift && made_.terrain.ground.equilibrium()) {
            add("write_uplift", [this](Run const& run) { write_uplift(made_, out_, run); });
        }
        jobs_.wait();
        if (writes(recipe::OutputFiles::qgis)) {
            add("write_qgis", [this](Run const& /*run*/) { write_qgis_files(made_, title_, out_); });
            jobs_.wait();
        }
        io::write_text(out_.path("recipe.toml"), recipe_toml);
        std::vector<std::string> files = out_.files();
        files.emplace_back("report.json");
        io::write_text(out_.path("report.json"), write_report(made_, files, {times_.begin(), times_.end()}));
        run_.at(1.0, "write");
        out_.commit();
        return files;
    }

private:
    bool writes(recipe::OutputFiles files) const { return made_.recipe.output.has(files); }

    void begin_surface() {
        // All threads read the cells once, before jobs of one thread begin.
        if (writes(recipe::OutputFiles::contours) || writes(recipe::OutputFiles::pictures)) {
            Stopwatch const stopwatch;
            parts_.overview(run_);
            times_.push_back(stopwatch.time_of("overview"));
        }
        // The longest first, and the one with the most memory: later the assessment has its catchments beside it.
        if (writes(recipe::OutputFiles::contours)) {
            add("write_contours", [this](Run const& run) { write_contours(made_, parts_, out_, run); });
        }
        if (writes(recipe::OutputFiles::pictures)) {
            add("write_map", [this](Run const& run) {
                draw::MapParams map;
                map.title = title_;
                io::write_text(out_.path("map.png"), map_with(made_, parts_, map, run).bytes);
            });
        }
        if (writes(recipe::OutputFiles::dem)) {
            add("write_dem", [this](Run const& run) { write_dem(made_, out_, run); });
        }
        if (writes(recipe::OutputFiles::pictures)) {
            if (!made_.terrain.ground.dilated().increments.empty()) {
                add_picture("write_curve", "curve.svg", [this] { return curve_of(made_); });
            }
            add_picture("write_wireframe", "wireframe.svg", [this] { return wireframe_of(made_, title_); });
            add_picture("write_sections", "sections.svg", [this] { return sections_of(made_, title_); });
        }
    }

    /// Adds a job that is a stage.
    void add(char const* stage, Beside::Job work) {
        jobs_.add([stage, work = std::move(work), &time = times_.emplace_back()](Run const& run) {
            Stopwatch const stopwatch;
            work(run);
            return_small_blocks();
            time = stopwatch.time_of(stage);
        });
    }

    void add_picture(char const* stage, char const* name, std::function<draw::Picture()> drawn) {
        add(stage, [this, name, drawn = std::move(drawn)](Run const& /*run*/) {
            io::write_text(out_.path(name), drawn().bytes);
        });
    }

    make::MakeResult const& made_;
    io::OutputFolder out_;
    Run const& run_;
    std::string const title_;
    recipe::Recipe const recipe_; ///< with the names of the copies of its files
    SurfaceParts parts_;
    std::deque<StageTime> times_; ///< of the jobs, in their order
    Beside jobs_;                 ///< the last member: it uses all others
};

} // namespace

PageParams page_params_of(make::MakeResult const& made, std::string recipe) {
    PageParams params;
    params.recipe = std::move(recipe);
    if (made.terrain.has_surface()) {
        params.contour_interval_m = contour_interval_m(made, height_range(made.terrain.ground.dem));
        params.sea = sea_of(made.terrain);
        params.lakes = make::lake_cells(made.terrain.bed.channels);
    }
    return params;
}

draw::Picture differences_against(make::Against const& against, make::Terrain const& terrain, int width_px) {
    draw::ComparisonParams params;
    params.width_px = width_px;
    return draw::differences(shown_against(against, terrain.ground.dem, width_px).sheet(), params);
}

draw::Picture comparison_against(make::Against const& against, make::Terrain const& terrain, std::string const& title) {
    draw::ComparisonParams params;
    params.title = title;
    params.dem = against.dem;
    return draw::comparison(shown_against(against, terrain.ground.dem, draw::columns_of_comparison(params)).sheet(),
                            params);
}

void write_rivers(make::MakeResult const& made, std::string const& path, Run const& run) {
    refuse_if<BadInput>(!made.recipe.network, "report.write_rivers",
                        "the recipe has no [network]: there are no rivers");
    with_tables(made, [&](io::NetworkTables const& tables) { io::write_geopackage(tables, path, run); });
}

draw::Picture draw_map(make::MakeResult const& made, DrawMapParams const& params, Run const& run) {
    refuse_if<BadInput>(!made.terrain.has_surface(), "report.draw_map",
                        "the recipe asks for rivers alone: there is no terrain to draw");
    draw::MapParams map;
    map.title = params.title.value_or(recipe::title_of(made.recipe));
    map.width_px = params.width_px;
    SurfaceParts parts(made, map);
    return map_with(made, parts, map, run);
}

void check_folder(std::string const& folder, io::Existing existing) {
    io::OutputFolder const probe(folder, existing, files_left_in(folder));
}

std::vector<std::string> write_terrain(make::MakeResult const& made, std::string const& folder, io::Existing existing,
                                       Run const& run) {
    FolderWriter writer(made, folder, existing, run);
    writer.begin();
    return writer.finish();
}

make::MakeResult make_folder(recipe::Recipe const& recipe, std::string const& folder, io::Existing existing,
                             Run const& run) {
    check_folder(folder, existing);
    make::MakeResult made;
    made.plan = recipe::resolve(recipe, run);
    made.planform = make::make_planform(made.plan, run);
    return_small_blocks();
    made.terrain = make::make_terrain(made.plan, made.planform, run);
    return_small_blocks();
    made.recipe = recipe_of(made.plan, made.terrain);
    FolderWriter writer(made, folder, existing, run);
    writer.begin();
    made.assessment = make::assess(made.plan, made.planform, made.terrain, run);
    made.terrain.water.drainage.area_cells = {};
    return_small_blocks();
    writer.finish();
    return made;
}

} // namespace thalweg::report
