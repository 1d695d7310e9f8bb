// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/studio/drawing_files.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include <thalweg/geometry/nearby.hpp>
#include <thalweg/io/crs/crs.hpp>
#include <thalweg/io/mesh/points.hpp>
#include <thalweg/io/network/read_rivers.hpp>
#include <thalweg/io/qgis/styles.hpp>
#include <thalweg/io/raster/polygons.hpp>
#include <thalweg/io/tables/table.hpp>
#include <thalweg/recipe/condition.hpp>

namespace thalweg::studio {
namespace {

using recipe::Recipe;

constexpr std::array own_columns{"rosgen", "lambda", "natural", "fid"};
constexpr char const* coastline = "coastline";
/// By which network.lines.filter leaves lines out.
constexpr std::array judged_columns{"waterway", "tunnel",    "man_made", "ftype", "fcode", "highway",
                                    "railway",  "aerialway", "barrier",  "power", "route"};

/// In any case of letters.
bool is_same_name(std::string_view a, std::string_view b) {
    return std::ranges::equal(a, b,
                              [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

bool is_judged(AttributeTable::Column const& column) {
    return std::ranges::any_of(judged_columns, [&](char const* name) { return is_same_name(name, column.name); });
}

DrawnLine open_ring(DrawnLine ring) {
    if (ring.size() > 1 && ring.front() == ring.back()) {
        ring.pop_back();
    }
    return ring;
}

/// Parts of a file's polygons may be empty.
bool has_shore(Polygon const& polygon) {
    return !polygon.rings.empty() && !polygon.rings.front().empty();
}

io::Source file_of(Recipe const& recipe, std::string const& name) {
    return {(std::filesystem::path(recipe.folder) / name).string(), io::Access::recipe};
}

DrawnLine line_in(std::vector<Vec3> const& vertices) {
    DrawnLine line = in_plan(vertices);
    line.erase(std::unique(line.begin(), line.end()), line.end());
    return line;
}

bool is_coast(AttributeTable const& attributes, std::int64_t record) {
    auto const column = std::ranges::find(attributes.columns, "natural", &AttributeTable::Column::name);
    if (column == attributes.columns.end() || record <= 0) {
        return false;
    }
    auto const& value =
        attributes
            .rows[static_cast<std::size_t>(record - 1)][static_cast<std::size_t>(column - attributes.columns.begin())];
    auto const* text = std::get_if<std::string>(&value);
    return text != nullptr && *text == coastline;
}

/// Makes the outlet of every stroke that ends on another one a vertex of it.
void join_outlets(std::vector<DrawnRiver>& rivers, double near_m) {
    for (std::size_t r = 0; r < rivers.size(); ++r) {
        Vec2& end = rivers[r].line.back();
        auto const lies_apart = [&](Vec2 a, Vec2 b) {
            return std::max(a.x, b.x) < end.x - near_m || std::min(a.x, b.x) > end.x + near_m ||
                   std::max(a.y, b.y) < end.y - near_m || std::min(a.y, b.y) > end.y + near_m;
        };
        for (std::size_t other = 0; other < rivers.size(); ++other) {
            DrawnLine& line = rivers[other].line;
            for (std::size_t i = 0; other != r && i + 1 < line.size(); ++i) {
                if (lies_apart(line[i], line[i + 1])) {
                    continue;
                }
                geometry::Foot const foot = geometry::foot_on(line[i], line[i + 1], end);
                if (distance(foot.at, end) > near_m) {
                    continue;
                }
                if (distance(line[i], end) <= near_m || distance(line[i + 1], end) <= near_m) {
                    end = distance(line[i], end) <= near_m ? line[i] : line[i + 1];
                } else {
                    line.insert(line.begin() + static_cast<std::ptrdiff_t>(i) + 1, end);
                }
                other = rivers.size() - 1;
                break;
            }
        }
    }
}

void read_rivers_into(Drawing& drawing, Recipe const& recipe, Run const& run) {
    recipe::NetworkRecipe const& wanted = *recipe.network;
    drawing.has_side_streams = wanted.source == recipe::Source::tokunaga;
    std::string const& name = drawing.has_side_streams ? wanted.tokunaga.strokes : wanted.lines.path;
    io::ReadRiversParams params{.path = file_of(recipe, name), .crs = drawing.grid.crs};
    params.layer = drawing.has_side_streams ? wanted.tokunaga.layer : wanted.lines.layer;
    params.may_be_empty = std::filesystem::path(name).filename() == drawing_name; // a sheet
    RiverLines lines = io::read_rivers(params, run);
    for (RiverLine& read : lines.lines) {
        DrawnLine line = line_in(read.vertices);
        if (line.size() < 2) {
            continue;
        }
        if (is_coast(lines.attributes, read.feature)) {
            drawing.coasts.push_back(std::move(line));
            continue;
        }
        if (drawing.has_side_streams) { // drawn upstream
            std::ranges::reverse(line);
        }
        drawing.rivers.push_back({std::move(line), read.type, read.lambda, read.feature});
    }
    if (drawing.has_side_streams) {
        join_outlets(drawing.rivers, 1e-3 * drawing.grid.cell_m);
    }
    drawing.attributes = std::move(lines.attributes);
}

void read_pins_into(Drawing& drawing, Recipe const& recipe, Run const& run) {
    io::ReadPointsParams const params{.path = file_of(recipe, recipe.skeleton->points),
                                      .crs = drawing.grid.crs,
                                      .height_column = recipe.skeleton->height_column,
                                      .nodata = recipe.skeleton->nodata,
                                      .height_option = "skeleton.height_column = ",
                                      .nodata_option = "skeleton.nodata = "};
    for (Vec3 const& p : io::read_points(params, run).points) {
        drawing.pins.push_back({in_plan(p), p.z});
    }
}

/// Heights as the terrain has them: none in a file that fills Z with 0.
void read_ridges_into(Drawing& drawing, Recipe const& recipe, Run const& run) {
    io::ReadRiversParams const params{.path = file_of(recipe, recipe.skeleton->ridge_lines),
                                      .crs = drawing.grid.crs,
                                      .height_field = recipe.skeleton->ridge_height_column};
    std::vector<RiverLine> const lines = io::read_rivers(params, run).lines;
    bool const has_heights = std::ranges::any_of(lines, [](RiverLine const& line) {
        return std::ranges::any_of(line.vertices, [](Vec3 const& v) { return std::isfinite(v.z) && v.z != 0.0; });
    });
    for (RiverLine const& read : lines) {
        DrawnRidge ridge;
        for (Vec3 const& v : read.vertices) {
            if (ridge.line.empty() || ridge.line.back() != in_plan(v)) {
                ridge.line.push_back(in_plan(v));
                ridge.heights_m.push_back(has_heights && std::isfinite(v.z) ? std::optional(v.z) : std::nullopt);
            }
        }
        if (ridge.line.size() > 1) {
            drawing.ridges.push_back(std::move(ridge));
        }
    }
}

std::vector<Vec3> in_space(DrawnLine const& line) {
    std::vector<Vec3> places;
    for (Vec2 const p : line) {
        places.push_back({p.x, p.y, std::numeric_limits<double>::quiet_NaN()});
    }
    return places;
}

io::Column user_column(std::string name, io::Column::Kind kind, std::function<io::Column::Value(std::size_t row)> at) {
    io::Column column;
    column.name = std::move(name);
    column.kind = kind;
    column.at = std::move(at);
    column.is_users = true;
    return column;
}

io::Table table_of_rivers(Drawing const& drawing) {
    using Kind = io::Column::Kind;
    using Value = io::Column::Value;
    std::size_t const rivers = drawing.rivers.size();
    io::Table table;
    table.name = "rivers";
    table.shape = io::Table::Shape::plan_line;
    table.rows = rivers + drawing.coasts.size();
    auto const text_or_null = [](std::string const& text) { return text.empty() ? Value() : Value(text); };
    table.columns.push_back(user_column("rosgen", Kind::text, [&, text_or_null](std::size_t row) {
        return row < rivers ? text_or_null(drawing.rivers[row].type) : Value();
    }));
    table.columns.push_back(user_column("lambda", Kind::integer, [&](std::size_t row) {
        bool const has_one = row < rivers && drawing.rivers[row].lambda > 0;
        return has_one ? Value(std::int64_t{drawing.rivers[row].lambda}) : Value();
    }));
    table.columns.push_back(user_column("natural", Kind::text, [&](std::size_t row) {
        return row < rivers ? Value() : Value(std::string(coastline));
    }));
    for (std::size_t c = 0; c < drawing.attributes.columns.size(); ++c) {
        AttributeTable::Column const& column = drawing.attributes.columns[c];
        if (std::ranges::any_of(own_columns, [&](char const* own) { return is_same_name(own, column.name); })) {
            continue;
        }
        // Coasts are told by the filter, which must not judge rivers then.
        bool const is_renamed = !drawing.coasts.empty() && is_judged(column);
        // Both enumerations have one order.
        std::string const name = (is_renamed ? "u_" : "") + column.name;
        table.columns.push_back(user_column(name, static_cast<Kind>(column.type), [&, c](std::size_t row) {
            std::int64_t const record = row < rivers ? drawing.rivers[row].record : 0;
            return record > 0 ? drawing.attributes.rows[static_cast<std::size_t>(record - 1)][c] : Value();
        }));
    }
    table.shape_at = [&](std::size_t row) {
        if (row >= rivers) {
            return in_space(drawing.coasts[row - rivers]);
        }
        DrawnLine line = drawing.rivers[row].line;
        if (drawing.has_side_streams) { // strokes are drawn upstream
            std::ranges::reverse(line);
        }
        return in_space(line);
    };
    table.style = io::river_style("", 1, {});
    return table;
}

io::Table table_of_areas(std::string name, std::size_t rows,
                         std::function<std::vector<DrawnLine>(std::size_t row)> const& rings_at) {
    io::Table table;
    table.name = std::move(name);
    table.shape = io::Table::Shape::multi_polygon;
    table.rows = rows;
    table.parts_at = [rings_at](std::size_t row) {
        std::vector<Polygon> parts(1);
        for (DrawnLine ring : rings_at(row)) {
            if (ring.empty()) {
                continue;
            }
            ring.push_back(ring.front());
            parts.front().rings.push_back(std::move(ring));
        }
        return parts;
    };
    return table;
}

void write_lakes(Drawing const& drawing, std::string const& path) {
    io::Table table =
        table_of_areas("lakes", drawing.lakes.size(), [&](std::size_t row) { return drawing.lakes[row].rings; });
    table.columns.push_back(user_column("level", io::Column::Kind::real, [&](std::size_t row) {
        auto const& level_m = drawing.lakes[row].level_m;
        return level_m ? io::Column::Value(*level_m) : io::Column::Value();
    }));
    table.style = io::water_style();
    io::write_tables({table}, drawing.grid.crs, path);
}

void write_masks(Drawing const& drawing, std::string const& path) {
    io::Table table = table_of_areas("masks", drawing.masks.size(), [&](std::size_t row) {
        std::vector<DrawnLine> rings{drawing.masks[row]};
        if (row < drawing.mask_islands.size()) {
            rings.insert(rings.end(), drawing.mask_islands[row].begin(), drawing.mask_islands[row].end());
        }
        return rings;
    });
    table.style = io::polygon_style();
    io::write_tables({table}, drawing.grid.crs, path);
}

void write_pins(Drawing const& drawing, std::string const& path) {
    io::Table table;
    table.name = "points";
    table.shape = io::Table::Shape::point;
    table.rows = drawing.pins.size();
    table.shape_at = [&](std::size_t row) {
        DrawnPin const& pin = drawing.pins[row];
        return std::vector<Vec3>{{pin.at.x, pin.at.y, pin.height_m}};
    };
    io::write_tables({table}, drawing.grid.crs, path);
}

void write_ridges(Drawing const& drawing, std::string const& path) {
    bool const has_heights = std::ranges::any_of(drawing.ridges, [](DrawnRidge const& ridge) {
        return std::ranges::any_of(ridge.heights_m, [](auto const& height_m) { return height_m.has_value(); });
    });
    io::Table table;
    table.name = "ridges";
    table.shape = has_heights ? io::Table::Shape::partly_line : io::Table::Shape::plan_line;
    table.rows = drawing.ridges.size();
    table.shape_at = [&](std::size_t row) {
        DrawnRidge const& ridge = drawing.ridges[row];
        std::vector<Vec3> places = in_space(ridge.line);
        for (std::size_t i = 0; i < places.size(); ++i) {
            places[i].z = ridge.heights_m[i].value_or(places[i].z);
        }
        return places;
    };
    table.style = io::ridge_style();
    io::write_tables({table}, drawing.grid.crs, path);
}

/// Unsets those of some keys that a recipe has.
template <std::size_t Count>
void unset(std::vector<Step>& steps, Recipe const& recipe, std::array<char const*, Count> const& paths) {
    for (recipe::KeyValue const& key : recipe::key_values(recipe)) {
        if (key.text && std::ranges::find(paths, key.path) != paths.end()) {
            steps.emplace_back(UnsetKey{key.path});
        }
    }
}

/// Steps that let drawn lines be all that decides where rivers run.
void turn_into_lines(std::vector<Step>& steps, Recipe const& recipe) {
    static constexpr std::array<char const*, 7> passing{
        "network.prune",        "network.lines.snap",       "network.lines.dem",       "network.lines.divergences",
        "network.lines.filter", "network.lines.coastlines", "network.tokunaga.strokes"};
    static constexpr std::array of_files{"file", "soft", "fixed", "ends"};
    unset(steps, recipe, passing);
    for (recipe::KeyValue const& key : recipe::key_values(recipe)) {
        if (key.path == "network.heights" && key.text && std::ranges::find(of_files, *key.text) != of_files.end()) {
            steps.emplace_back(UnsetKey{key.path});
        }
    }
}

/// Steps that say whether rivers meander that become drawn lines. Those that were there, with the bends that they have,
/// stay where they are. Strokes of a hand on an empty sheet have few bends: there rivers meander unless the recipe says
/// how much.
void set_meander(std::vector<Step>& steps, Recipe const& recipe, bool is_empty) {
    if (!is_empty) {
        unset(steps, recipe, std::array<char const*, 1>{"network.meander"});
    } else if (recipe::in_equilibrium(recipe) && !recipe.network->meander) {
        steps.emplace_back(SetKey{"network.meander", "1"});
    }
}

/// Steps without what is said of the layer and the fields of another file.
void forget_layer(std::vector<Step>& steps, Recipe const& recipe) {
    static constexpr std::array<char const*, 11> passing{
        "network.lines.layer",      "network.lines.source_crs", "network.lines.type_field",
        "network.lines.rank_field", "network.lines.id_field",   "network.lines.down_field",
        "network.lines.from_field", "network.lines.to_field",   "network.lines.direction_field",
        "network.lines.where",      "network.tokunaga.layer"};
    unset(steps, recipe, passing);
}

/// All that is drawn is in the network, also a canal of a user's file.
void set_filter(std::vector<Step>& steps, Document const& document, Drawing const& drawing) {
    if (drawing.coasts.empty() && std::ranges::any_of(drawing.attributes.columns, is_judged)) {
        steps.emplace_back(SetKey{"network.lines.filter", "none"});
    } else if (is_drawn(document.recipe) && !drawing.coasts.empty()) { // the filter tells them
        unset(steps, document.recipe, std::array<char const*, 1>{"network.lines.filter"});
    }
}

void set_grid(std::vector<Step>& steps, Grid const& grid) {
    steps.emplace_back(SetKey{"grid.width", fmt::format("{}", grid.width)});
    steps.emplace_back(SetKey{"grid.height", fmt::format("{}", grid.height)});
    steps.emplace_back(SetKey{"grid.cell", fmt::format("{}", grid.cell_m)});
    steps.emplace_back(SetKey{"grid.origin", fmt::format("[{}, {}]", grid.west, grid.north)});
    steps.emplace_back(SetKey{"grid.crs", grid.crs});
}

/// was_empty: no rivers were there.
void set_rivers(std::vector<Step>& steps, Document const& document, bool was_empty, Drawing const& drawing,
                PutInput const& put) {
    if (!is_drawn(document.recipe)) {
        turn_into_lines(steps, document.recipe);
        set_meander(steps, document.recipe, was_empty);
    }
    forget_layer(steps, document.recipe);
    if (!grid_of(document.recipe)) {
        set_grid(steps, drawing.grid);
    }
    auto const write = [&](std::string const& path) { write_drawing(drawing, path); };
    steps.emplace_back(SetKey{"network.source", drawing.has_side_streams ? "tokunaga" : "lines"});
    steps.emplace_back(
        put(drawing.has_side_streams ? "network.tokunaga.strokes" : "network.lines.path", drawing_name, write));
    if (!drawing.has_side_streams) {
        steps.emplace_back(SetKey{"network.lines.orientation", "as_drawn"});
        set_filter(steps, document, drawing);
        if (document.recipe.surface && !document.recipe.surface->source.empty()) { // a DEM may have holes
            steps.emplace_back(SetKey{"grid.clip", "true"});
        }
    }
}

void drop_key(std::vector<Step>& steps, Document const& document, std::string const& key) {
    auto const keys = recipe::key_values(document.recipe);
    auto const now = std::ranges::find(keys, key, &recipe::KeyValue::path);
    if (now != keys.end() && now->text) {
        steps.emplace_back(UnsetKey{key});
    }
}

/// A key that names a file of what is drawn, or none where there is nothing in it.
void set_file(std::vector<Step>& steps, Document const& document, std::string const& key, std::size_t count,
              std::function<TakeInput()> const& put) {
    if (count > 0) {
        steps.emplace_back(put());
        return;
    }
    drop_key(steps, document, key);
}

void set_lakes(std::vector<Step>& steps, Document const& document, Drawing const& drawing, PutInput const& put) {
    auto const& surface = document.recipe.surface;
    if (!drawing.lakes.empty() && surface && surface->equilibrium.lake_share > 0.0) {
        steps.emplace_back(UnsetKey{"surface.lake_share"}); // lakes are random or given
    }
    set_file(steps, document, "surface.lakes", drawing.lakes.size(), [&] {
        return put("surface.lakes", "lakes.gpkg", [&](std::string const& path) { write_lakes(drawing, path); });
    });
}

void set_masks(std::vector<Step>& steps, Document const& document, Drawing const& drawing, PutInput const& put) {
    set_file(steps, document, "surface.mask", drawing.masks.size(), [&] {
        return put("surface.mask", "mask.gpkg", [&](std::string const& path) { write_masks(drawing, path); });
    });
}

void set_pins(std::vector<Step>& steps, Document const& document, Drawing const& drawing, PutInput const& put) {
    drop_key(steps, document, "skeleton.height_column"); // the file that is drawn has Z
    drop_key(steps, document, "skeleton.nodata");
    if (!drawing.pins.empty() && document.recipe.skeleton && document.recipe.skeleton->scatter > 0) {
        steps.emplace_back(UnsetKey{"skeleton.scatter"}); // points are random or given
    }
    set_file(steps, document, "skeleton.points", drawing.pins.size(), [&] {
        return put("skeleton.points", "points.gpkg", [&](std::string const& path) { write_pins(drawing, path); });
    });
}

void set_ridges(std::vector<Step>& steps, Document const& document, Drawing const& drawing, PutInput const& put) {
    drop_key(steps, document, "skeleton.ridge_height_column");
    set_file(steps, document, "skeleton.ridge_lines", drawing.ridges.size(), [&] {
        return put("skeleton.ridge_lines", "ridges.gpkg",
                   [&](std::string const& path) { write_ridges(drawing, path); });
    });
}

/// Takes [skeleton], which the first pin or ridge brought, out with the last one, where it says nothing else.
void drop_skeleton(std::vector<Step>& steps, Document const& document, Drawing const& drawing) {
    std::optional<recipe::SkeletonRecipe> const& now = document.recipe.skeleton;
    bool const has_files = now && (!now->points.empty() || !now->ridge_lines.empty());
    if (!has_files || !drawing.pins.empty() || !drawing.ridges.empty()) {
        return;
    }
    auto const without_files = [](Recipe recipe) {
        recipe.skeleton->points.clear();
        recipe.skeleton->ridge_lines.clear();
        return recipe::write_recipe(recipe);
    };
    Recipe usual = document.recipe;
    usual.skeleton = recipe::SkeletonRecipe{};
    if (without_files(document.recipe) == without_files(usual)) {
        steps.emplace_back(UnsetKey{"skeleton"});
    }
}

} // namespace

bool is_drawn(Recipe const& recipe) {
    if (!recipe.network) {
        return false;
    }
    recipe::NetworkRecipe const& wanted = *recipe.network;
    return (wanted.source == recipe::Source::tokunaga && !wanted.tokunaga.strokes.empty()) ||
           (wanted.source == recipe::Source::lines &&
            std::filesystem::path(wanted.lines.path).filename() == drawing_name);
}

std::optional<Grid> grid_of(Recipe const& recipe) {
    recipe::GridRecipe const& wanted = recipe.grid;
    if (wanted.width <= 0 || wanted.height <= 0 || !wanted.origin || !(wanted.cell_m > 0.0) || wanted.crs.empty()) {
        return std::nullopt;
    }
    return Grid{wanted.width,        wanted.height,       wanted.cell_m,
                (*wanted.origin)[0], (*wanted.origin)[1], io::projected_crs(wanted.crs)};
}

Drawing read_drawing(Recipe const& recipe, Grid const& grid, Run const& run) {
    Drawing drawing;
    drawing.grid = grid;
    if (is_drawn(recipe)) {
        read_rivers_into(drawing, recipe, run);
    }
    if (recipe.surface && !recipe.surface->equilibrium.lakes.empty()) {
        for (Polygon& polygon :
             io::read_polygons_valued(file_of(recipe, recipe.surface->equilibrium.lakes), grid.crs, "level", run)
                 .polygons) {
            std::optional<double> const level_m =
                std::isnan(polygon.value) ? std::nullopt : std::optional(polygon.value);
            std::ranges::transform(polygon.rings, polygon.rings.begin(), open_ring);
            if (has_shore(polygon)) {
                drawing.lakes.push_back({std::move(polygon.rings), level_m});
            }
        }
    }
    if (recipe.surface && !recipe.surface->mask.empty() && io::holds_polygons(file_of(recipe, recipe.surface->mask))) {
        for (Polygon& polygon : io::read_polygons(file_of(recipe, recipe.surface->mask), grid.crs, run).polygons) {
            std::ranges::transform(polygon.rings, polygon.rings.begin(), open_ring);
            if (has_shore(polygon)) {
                drawing.masks.push_back(std::move(polygon.rings.front()));
                polygon.rings.erase(polygon.rings.begin());
                drawing.mask_islands.push_back(std::move(polygon.rings));
            }
        }
    }
    if (recipe.skeleton && !recipe.skeleton->points.empty()) {
        read_pins_into(drawing, recipe, run);
    }
    if (recipe.skeleton && !recipe.skeleton->ridge_lines.empty()) {
        read_ridges_into(drawing, recipe, run);
    }
    return drawing;
}

Drawing drawing_of(Grid const& grid, StreamNetwork const& network, Mask const& land, AttributeTable const& attributes) {
    Drawing drawing;
    drawing.grid = grid;
    drawing.attributes = attributes;
    for (Arc const& arc : network.arcs()) {
        DrawnLine line;
        std::ranges::transform(arc.line, std::back_inserter(line), [](Vec2 p) { return rounded(p); });
        line.erase(std::unique(line.begin(), line.end()), line.end());
        bool const has_record = arc.feature > 0 && arc.feature <= static_cast<std::int64_t>(attributes.rows.size());
        if (line.size() > 1) {
            drawing.rivers.push_back({std::move(line), arc.type, 0, has_record ? arc.feature : 0});
        }
    }
    drawing.coasts = coasts_of(land);
    return drawing;
}

void write_drawing(Drawing const& drawing, std::string const& path, Run const& run) {
    io::write_tables({table_of_rivers(drawing)}, drawing.grid.crs, path, run);
}

Edit edit_between(Document const& document, Drawing const& before, DrawResult const& after, PutInput const& put) {
    Drawing const& now = after.drawing;
    Edit edit{after.name, {}};
    if (now.rivers != before.rivers || now.coasts != before.coasts || now.has_side_streams != before.has_side_streams) {
        set_rivers(edit.steps, document, before.rivers.empty(), now, put);
    }
    if (now.lakes != before.lakes) {
        set_lakes(edit.steps, document, now, put);
    }
    if (now.masks != before.masks) {
        set_masks(edit.steps, document, now, put);
    }
    if (now.pins != before.pins) {
        set_pins(edit.steps, document, now, put);
    }
    if (now.ridges != before.ridges) {
        set_ridges(edit.steps, document, now, put);
    }
    drop_skeleton(edit.steps, document, now);
    return edit;
}

Edit empty_sheet(Document const& document, Grid const& grid, PutInput const& put) {
    Edit edit{"an empty sheet", {}};
    Drawing empty;
    empty.grid = grid;
    set_rivers(edit.steps, document, true, empty, put);
    set_lakes(edit.steps, document, empty, put);
    set_masks(edit.steps, document, empty, put);
    set_pins(edit.steps, document, empty, put);
    set_ridges(edit.steps, document, empty, put);
    drop_skeleton(edit.steps, document, empty);
    return edit;
}

} // namespace thalweg::studio
