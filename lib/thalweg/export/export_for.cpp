// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <thalweg/core/lattice.hpp>
#include <thalweg/core/run/messages.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/export/internal/export_gaps.hpp>
#include <thalweg/export/internal/export_parts.hpp>
#include <thalweg/export/internal/glb.hpp>
#include <thalweg/export/internal/land_masks.hpp>
#include <thalweg/export/internal/print_export.hpp>
#include <thalweg/export/internal/river_splines.hpp>
#include <thalweg/export/internal/web_export.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/io/raster/dem_derivatives.hpp>
#include <thalweg/io/raster/heightmap.hpp>
#include <thalweg/report/read_scene.hpp>
#include <thalweg/report/report.hpp>
#include <thalweg/surface/gaps/close_gaps.hpp>

namespace thalweg::exports {
namespace {

namespace fs = std::filesystem;
using ForJson = nlohmann::ordered_json;

constexpr std::int64_t most_samples_for = 16385; // a side, of all tiles together
constexpr std::int64_t mesh_vertices_for = 1025; // a side
constexpr std::int64_t most_colours_for = 4096;  // a side
constexpr char const* description_for = "export.json";

/// How a program takes heights.
struct Program {
    ExportPreset preset;
    io::HeightmapFormat format;
    char const* ending;
    bool from_south; ///< rows of heights
    bool square;     ///< tiles
    bool tiles;
    bool mesh;
};

/// \return null: it takes no heightmap
Program const* program_of(ExportPreset preset) {
    using io::HeightmapFormat;
    static constexpr std::array programs{
        Program{ExportPreset::unreal, HeightmapFormat::png16, "png", false, false, true, false},
        Program{ExportPreset::unity, HeightmapFormat::r16, "raw", true, true, true, false},
        Program{ExportPreset::godot, HeightmapFormat::r16, "r16", false, true, true, true},
        Program{ExportPreset::blender, HeightmapFormat::png16, "png", false, false, false, true}};
    auto const* const found = std::ranges::find(programs, preset, &Program::preset);
    return found == programs.end() ? nullptr : found;
}

ExportPreset preset_of(std::string const& word) {
    std::vector<std::string> names;
    for (ExportPresetName const& known : export_presets()) {
        if (word == known.name) {
            return known.preset;
        }
        names.emplace_back(known.name);
    }
    throw BadParameter("export.run_export", fmt::format("no preset is called '{}'; the presets are {}.{}", word,
                                                        fmt::join(names, ", "), did_you_mean(word, names)));
}

std::vector<LandMask> masks_of(std::vector<std::string> const& words) {
    std::vector<LandMask> out;
    std::vector<std::string> names{"all", "none"};
    for (LandMaskName const& known : land_masks()) {
        names.emplace_back(known.name);
    }
    for (std::string const& word : words) {
        refuse_if<BadParameter>(std::ranges::find(names, word) == names.end(), "export.run_export",
                                "no mask is called '{}'; there are {}.{}", word, fmt::join(names, ", "),
                                did_you_mean(word, names));
        refuse_if<BadParameter>((word == "all" || word == "none") && words.size() > 1, "export.run_export",
                                "'{}' stands alone among masks", word);
    }
    for (LandMaskName const& known : land_masks()) {
        if (words.empty() || words.front() == "all" || std::ranges::find(words, known.name) != words.end()) {
            out.push_back(known.mask);
        }
    }
    return out;
}

/// Sides of a tile that a program takes.
struct Sides {
    std::string rule; ///< in words
    std::vector<std::int64_t> usual;
    std::function<bool(std::int64_t)> has;
};

/// Quads of a section that both sides of a landscape are whole numbers of; 0: there is none.
std::int64_t section_of(ExportSize size) {
    for (std::int64_t const quads : {63, 127}) {
        std::int64_t const most = quads == 63 ? 4032 : 8128;
        if ((size.width - 1) % quads == 0 && (size.height - 1) % quads == 0 &&
            std::max(size.width, size.height) - 1 <= most) {
            return quads;
        }
    }
    return 0;
}

Sides sides_of(ExportPreset preset) {
    auto const power = [](std::int64_t least, std::int64_t most) {
        Sides sides{fmt::format("a power of two and one, {} to {}", least, most), {}, {}};
        for (std::int64_t side = least; side <= most; side = 2 * (side - 1) + 1) {
            sides.usual.push_back(side);
        }
        sides.has = [usual = sides.usual](std::int64_t side) { return std::ranges::find(usual, side) != usual.end(); };
        return sides;
    };
    switch (preset) {
    case ExportPreset::unreal:
        return {"a multiple of 63 and one up to 4033, or of 127 and one up to 8129; usual are 127, 253, 505, 1009, "
                "2017, 4033 and 8129",
                {127, 253, 505, 1009, 2017, 4033, 8129},
                [](std::int64_t side) {
                    return side > 1 && section_of({side, side}) > 0;
                }};
    case ExportPreset::unity: return power(33, 4097);
    case ExportPreset::godot: return power(513, 4097);
    default: break;
    }
    return {"2 to 16385", {}, [](std::int64_t side) { return side >= 2 && side <= most_samples_for; }};
}

struct Tiles {
    std::int64_t across = 1;
    std::int64_t down = 1;
    ExportSize one; ///< of one tile

    ExportSize all() const { return {across * (one.width - 1) + 1, down * (one.height - 1) + 1}; }
};

std::int64_t nearest_usual(Sides const& sides, double side) {
    return *std::ranges::min_element(sides.usual, {}, [&](std::int64_t usual) {
        double const share = static_cast<double>(usual) / side;
        return std::max(share, 1.0 / share);
    });
}

ExportSize usual_size(Program const& program, Sides const& sides, Grid const& grid, Tiles const& tiles) {
    if (sides.usual.empty()) {
        return {std::min(grid.width, most_samples_for), std::min(grid.height, most_samples_for)};
    }
    double const across = static_cast<double>(grid.width) / static_cast<double>(tiles.across);
    double const down = static_cast<double>(grid.height) / static_cast<double>(tiles.down);
    std::int64_t const longer = nearest_usual(sides, std::max(across, down));
    std::int64_t shorter = longer;
    if (!program.square) { // whole sections of the same number of quads
        std::int64_t const section = longer > 4033 ? 127 : 63;
        double const share = std::min(across, down) / std::max(across, down);
        shorter = 1 + section * std::max<std::int64_t>(1, std::llround(share * static_cast<double>(longer - 1) /
                                                                       static_cast<double>(section)));
    }
    return across >= down ? ExportSize{longer, shorter} : ExportSize{shorter, longer};
}

Tiles tiles_of(ExportParams const& params, Program const& program, Grid const& grid) {
    refuse_if<BadInput>(grid.width < 2 || grid.height < 2, "export.run_export",
                        "{} has {} x {} cells: at least 2 x 2 are needed", params.source, grid.width, grid.height);
    Tiles tiles{params.tiles_across.value_or(1), params.tiles_down.value_or(1), {}};
    Sides const sides = sides_of(program.preset);
    if (params.width) {
        for (std::int64_t const side : {*params.width, *params.height}) {
            if (!sides.has(side)) {
                std::string const advice =
                    sides.usual.empty() ? "" : fmt::format(": use {}", nearest_usual(sides, static_cast<double>(side)));
                throw BadParameter("export.run_export",
                                   fmt::format("{} samples a side are no size of {}, which takes {}{}", side,
                                               params.preset, sides.rule, advice));
            }
        }
        refuse_if<BadParameter>(program.square && *params.width != *params.height, "export.run_export",
                                "{} takes square tiles: --size {}", params.preset,
                                std::max(*params.width, *params.height));
        tiles.one = {*params.width, *params.height};
        refuse_if<BadParameter>(
            program.preset == ExportPreset::unreal && section_of(tiles.one) == 0, "export.run_export",
            "{} x {}: both sides of a landscape are multiples of 63 and one, or both of 127 and one", tiles.one.width,
            tiles.one.height);
    } else {
        tiles.one = usual_size(program, sides, grid, tiles);
    }
    ExportSize const all = tiles.all();
    refuse_if<BadParameter>(std::max(all.width, all.height) > most_samples_for, "export.run_export",
                            "{} x {} samples are more than {} a side: use fewer or smaller tiles", all.width,
                            all.height, most_samples_for);
    return tiles;
}

/// Refuses options that a preset does not have.
void require_options_for(ExportParams const& params, ExportPreset preset) {
    refuse_if<BadParameter>(params.output.empty(), "export.run_export", "the name of the output is empty");
    refuse_if<BadParameter>(!params.format.empty(), "export.run_export",
                            "--for chooses the formats: leave out --format {}", params.format);
    bool const prints = preset == ExportPreset::print3d;
    Program const* const program = program_of(preset);
    bool const has_tiles = program != nullptr && program->tiles;
    bool const has_mesh = prints || preset == ExportPreset::web || (program != nullptr && program->mesh);
    struct Option {
        bool is_set;
        bool applies;
        char const* name;
    };
    for (Option const& option : {Option{params.width.has_value(), program != nullptr, "--size"},
                                 Option{params.tiles_across || params.tiles_down, has_tiles, "--tiles"},
                                 Option{!params.masks.empty(), program != nullptr, "--masks"},
                                 Option{params.mask_bits.has_value(), program != nullptr, "--mask-bits"},
                                 Option{params.runoff_mm.has_value(), program != nullptr, "--runoff"},
                                 Option{params.tree_line_m.has_value(), program != nullptr, "--tree-line"},
                                 Option{params.exaggeration.has_value(), has_mesh, "--exaggeration"},
                                 Option{params.base.has_value(), prints, "--base"},
                                 Option{params.print_mm.has_value(), prints, "--print-size"}}) {
        refuse_if<BadParameter>(option.is_set && !option.applies, "export.run_export", "{} has no option {}",
                                params.preset, option.name);
    }
    if (params.exaggeration) {
        require_in("export.run_export", "exaggeration", *params.exaggeration, Range{0.0, 1000.0, false, true});
    }
    for (std::optional<std::int64_t> const count : {params.tiles_across, params.tiles_down}) {
        require_in("export.run_export", "tiles", count.value_or(1), Range::between(1.0, 64.0));
    }
    require_in("export.run_export", "runoff", params.runoff_mm.value_or(300.0), Range{0.0, 1e5, false, true}, "mm/a");
    require_gap_options(params);
    require_in("export.run_export", "tree-line", params.tree_line_m.value_or(0.0), Range::finite(), "m");
    std::int64_t const bits = params.mask_bits.value_or(8);
    refuse_if<BadParameter>(bits != 8 && bits != 16, "export.run_export", "masks have 8 or 16 bits, not {}", bits);
    masks_of(params.masks);
}

/// Where a program has places of the terrain.
struct Frame {
    char const* axes;
    bool y_up;
    std::function<Vec3(Vec3)> place; ///< of a place in the CRS [m]
};

Frame frame_of(ExportPreset preset, Lattice const& ground, ExportResult const& made) {
    double const lowest_m = made.min_m;
    double const factor = made.exaggeration;
    Vec2 const corner = ground.north_west();
    Vec2 const extent = ground.extent_m();
    Vec2 const middle{corner.x + 0.5 * extent.x, corner.y - 0.5 * extent.y};
    switch (preset) {
    case ExportPreset::unreal:
        return {"centimetres: x east, y south from the north-west corner, z height", false, [=](Vec3 p) {
                    return Vec3{100.0 * (p.x - corner.x), 100.0 * (corner.y - p.y), 100.0 * p.z};
                }};
    case ExportPreset::unity:
        return {"metres: x east, z north from the south-west corner, y height", true, [=](Vec3 p) {
                    return Vec3{p.x - corner.x, p.z, p.y - (corner.y - extent.y)};
                }};
    case ExportPreset::godot:
        return {"metres: x east, z south from the middle, y height above the lowest", true, [=](Vec3 p) {
                    return Vec3{p.x - middle.x, factor * (p.z - lowest_m), middle.y - p.y};
                }};
    default: break;
    }
    return {"metres: x east, y north from the middle, z height above the lowest", false, [=](Vec3 p) {
                return Vec3{p.x - middle.x, p.y - middle.y, factor * (p.z - lowest_m)};
            }};
}

double rounded(double value, double steps = 1000.0) {
    return std::floor(value * steps + 0.5) / steps;
}

/// A part of a raster.
template <class T>
Raster<T> part_of(Raster<T> const& all, std::int64_t col, std::int64_t row, ExportSize size, bool from_south) {
    Grid grid = all.grid();
    grid.width = size.width;
    grid.height = size.height;
    Raster<T> out = surface::window_of(all, {col, row}, grid);
    for (std::int64_t r = 0; from_south && r < size.height / 2; ++r) {
        std::ranges::swap_ranges(out.row(r), out.row(size.height - 1 - r));
    }
    return out;
}

/// Samples a mask at places of a lattice by the greatest of the cells nearest to each: thin lines keep their value.
Raster<float> greatest_of(Raster<float> const& shares, ExportSize size, Grid const& frame) {
    struct Span {
        std::int64_t begin = 0;
        std::int64_t end = 0;
    };
    auto const spans = [](std::int64_t cells, std::int64_t samples) {
        std::vector<Span> out;
        double const step = static_cast<double>(cells - 1) / static_cast<double>(samples - 1);
        double const reach = 0.5 * std::max(1.0, step);
        for (std::int64_t k = 0; k < samples; ++k) {
            double const at = step * static_cast<double>(k);
            out.push_back({std::max<std::int64_t>(0, static_cast<std::int64_t>(std::ceil(at - reach))),
                           std::min(cells, static_cast<std::int64_t>(std::floor(at + reach)) + 1)});
        }
        return out;
    };
    std::vector<Span> const columns = spans(shares.width(), size.width);
    std::vector<Span> const rows = spans(shares.height(), size.height);
    Raster<float> out(frame, 0.0F);
    for (std::int64_t i = 0; i < out.cells(); ++i) {
        Cell const c = frame.at(i);
        for (std::int64_t row = rows[static_cast<std::size_t>(c.row)].begin;
             row < rows[static_cast<std::size_t>(c.row)].end; ++row) {
            for (std::int64_t col = columns[static_cast<std::size_t>(c.col)].begin;
                 col < columns[static_cast<std::size_t>(c.col)].end; ++col) {
                out[i] = std::max(out[i], shares[Cell{col, row}]);
            }
        }
    }
    return out;
}

/// Writes a raster tile by tile.
template <class T, class Write>
std::vector<std::string> write_tiles(Raster<T> const& all, Tiles const& tiles, bool from_south, std::string const& name,
                                     std::string const& ending, Write write) {
    std::vector<std::string> files;
    for (std::int64_t y = 0; y < tiles.down; ++y) {
        for (std::int64_t x = 0; x < tiles.across; ++x) {
            files.push_back(tiles.across * tiles.down == 1 ? fmt::format("{}.{}", name, ending)
                                                           : fmt::format("{}_x{}_y{}.{}", name, x, y, ending));
            write(part_of(all, x * (tiles.one.width - 1), y * (tiles.one.height - 1), tiles.one, from_south),
                  files.back());
        }
    }
    return files;
}

/// Numbers of the import, as its windows name them.
ForJson import_of(Program const& program, ExportResult const& made, Tiles const& tiles) {
    double const across_m = static_cast<double>(tiles.one.width - 1) * made.step_m.x;
    double const down_m = static_cast<double>(tiles.one.height - 1) * made.step_m.y;
    double const range_m = 65535.0 * made.metres_per_step;
    switch (program.preset) {
    case ExportPreset::unreal: // 128 numbers a metre at a scale of 100
        return {{"scale", {100.0 * made.step_m.x, 100.0 * made.step_m.y, 12800.0 * made.metres_per_step}},
                {"location_cm", {0.0, 0.0, 100.0 * (made.min_m + 32768.0 * made.metres_per_step)}},
                {"tile_cm", {100.0 * across_m, 100.0 * down_m}},
                {"section_quads", section_of(tiles.one)}};
    case ExportPreset::unity:
        return {{"terrain_width", across_m},
                {"terrain_length", down_m},
                {"terrain_height", range_m},
                {"heightmap_resolution", tiles.one.width},
                {"position_of_south_west_tile", {0.0, made.min_m, 0.0}}};
    case ExportPreset::godot:
        return {{"map_scale", {made.step_m.x, 1.0, made.step_m.y}},
                {"lowest", 0.0},
                {"highest", range_m * made.exaggeration}};
    default: break;
    }
    return {{"plane_size_m", {across_m, down_m}},
            {"displacement_strength_m", range_m * made.exaggeration},
            {"midlevel", 0.0}};
}

/// Colours of the land as from above in summer, with a little light from the north-west.
void write_land_colours(report::Scene const& scene, LandMasks& masks, ExportSize size, std::string const& path,
                        Run const& run) {
    Raster<float> const& dem = *scene.dem;
    Raster<std::uint8_t> const& kind = masks.kinds(run);
    Raster<float> const wet = masks.made(LandMask::water, run).share;
    Raster<float> const moist = masks.made(LandMask::wetness, run).share;
    Raster<float> const bend = masks.made(LandMask::curvature, run).share;
    Raster<std::uint8_t> const light = io::hillshade(dem, 1.0, io::Light::multidirectional);
    std::array<Lattice, 3> channels;
    for (unsigned k = 0; k < 3; ++k) {
        run.at(static_cast<double>(k) / 3.0, "colour");
        auto const channel = [&](std::size_t number) {
            return static_cast<double>((land_kinds()[number].colour >> (16 - 8 * k)) & 0xFFU);
        };
        Raster<float> colour(dem.grid());
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            double land = channel(kind[i]);
            if (light[i] != 0 && kind[i] != 1) {
                constexpr double level = 180.0; // light of level ground
                land *= (0.72 + 0.28 * light[i] / level) * (1.12 - 0.24 * moist[i]) * (0.9 + 0.2 * bend[i]);
                land += wet[i] * (channel(1) - land);
            }
            colour[i] = static_cast<float>(std::clamp(land, 0.0, 255.0));
        }
        channels[k] = lattice(colour, size.width, size.height, run);
    }
    Raster<std::uint32_t> pixels(channels[0].z.grid());
    for (std::int64_t i = 0; i < pixels.cells(); ++i) {
        for (Lattice const& channel : channels) {
            pixels[i] = (pixels[i] << 8U) | static_cast<std::uint32_t>(std::lround(channel.z[i]));
        }
    }
    io::write_colour_png(pixels, path, run);
}

double runoff_of(ExportParams const& params) {
    return params.runoff_mm.value_or(300.0);
}

/// What a preset writes, step by step.
class ForProgram {
public:
    ForProgram(ExportParams const& params, Program const& program, report::Scene const& scene,
               std::vector<RiverSpline> const& rivers, io::OutputFolder const& out, Run const& run)
        : params_(params), program_(program), scene_(scene), out_(out), run_(run), rivers_(rivers),
          masks_(scene, rivers_, tree_line_m()), tiles_(tiles_of(params, program, scene.dem->grid())) {}

    ForJson write(ExportResult& made) {
        made.format = ExportFormat::png16; // heights without holes
        ground_ = sampled(scene_, tiles_.all(), made, run_);
        made.width = ground_.z.width();
        made.height = ground_.z.height();
        made.step_m = {ground_.z.grid().cell_m, ground_.row_step_m};
        made.north_west = ground_.north_west();
        made.crs = ground_.z.grid().crs;
        io::HeightmapScale scale = io::heightmap_scale(ground_.z);
        if (scale.step_m == 0.0) {
            scale.step_m = 1.0 / 65535.0; // programs refuse a range of 0
            made.findings.push_back({.kind = "flat", .text = "the terrain is flat: 16 bits are a metre"});
        }
        made.exaggeration = params_.exaggeration.value_or(1.0);
        made.min_m = scale.min_m;
        made.max_m = scale.max_m;
        made.metres_per_step = scale.step_m;
        tell_changes(made);
        ForJson json = head(made);
        json["heights"] = heights(scale);
        json["colour"] = colours();
        json["masks"] = all_masks(made);
        if (!rivers_.empty()) {
            json["rivers"] = river_file(made);
        }
        if (program_.mesh) {
            json["mesh"] = mesh_file(made);
        }
        json["import"] = import_of(program_, made, tiles_);
        return json;
    }

private:
    double tree_line_m() const { return params_.tree_line_m.value_or(1800.0); }

    void tell_changes(ExportResult& made) const {
        Grid const& grid = scene_.dem->grid();
        ExportSize const all = tiles_.all();
        if (all.width != grid.width || all.height != grid.height) {
            made.findings.push_back(
                {.kind = "resampled",
                 .text = fmt::format("{} x {} cells are resampled to {} x {} samples, {:.6g} m apart to the east and "
                                     "{:.6g} m to the south",
                                     grid.width, grid.height, all.width, all.height, made.step_m.x, made.step_m.y)});
        }
    }
    ForJson head(ExportResult const& made) const {
        ForJson json{{"width", made.width},
                     {"height", made.height},
                     {"tiles",
                      {{"across", tiles_.across},
                       {"down", tiles_.down},
                       {"width", tiles_.one.width},
                       {"height", tiles_.one.height},
                       {"names", "_x0_y0 is the north-west; neighbours share their edge"}}},
                     {"min_m", made.min_m},
                     {"max_m", made.max_m},
                     {"metres_per_step", made.metres_per_step},
                     {"step_m", {made.step_m.x, made.step_m.y}},
                     {"size_m", {ground_.extent_m().x, ground_.extent_m().y}},
                     {"north_west", {made.north_west.x, made.north_west.y}},
                     {"crs", made.crs}};
        json.update(ForJson::parse(description_of_gaps(made)));
        return json;
    }
    ForJson heights(io::HeightmapScale const& scale) const {
        auto const files = write_tiles(ground_.z, tiles_, program_.from_south, "height", program_.ending,
                                       [&](Raster<float> const& tile, std::string const& name) {
                                           io::write_heightmap(tile, out_.path(name), program_.format, scale, run_);
                                       });
        return {{"files", files},
                {"samples", "16-bit unsigned: min_m + number x metres_per_step"},
                {"byte_order",
                 program_.format == io::HeightmapFormat::png16 ? "big-endian, as in every PNG" : "little-endian"},
                {"axes", program_.from_south ? "rows from south to north, samples of a row from west to east"
                                             : "rows from north to south, samples of a row from west to east"}};
    }
    ForJson colours() {
        ExportSize const all = tiles_.all();
        double const share =
            std::min(1.0, static_cast<double>(most_colours_for) / static_cast<double>(std::max(all.width, all.height)));
        auto const side = [&](std::int64_t samples) {
            return std::max<std::int64_t>(2, std::llround(share * static_cast<double>(samples)));
        };
        ExportSize const size{side(all.width), side(all.height)};
        write_land_colours(scene_, masks_, size, out_.path(colour_), run_);
        return {{"file", colour_}, {"width", size.width}, {"height", size.height}, {"of", "all tiles"}};
    }
    ForJson all_masks(ExportResult& made) {
        ForJson list = ForJson::array();
        std::vector<LandMask> const wanted = masks_of(params_.masks);
        for (LandMask const mask : wanted) {
            run_.at(static_cast<double>(list.size()) / static_cast<double>(wanted.size()), "masks");
            bool const of_rivers = mask == LandMask::river_distance || mask == LandMask::river_width;
            if (of_rivers && rivers_.empty() && (params_.masks.empty() || params_.masks.front() == "all")) {
                made.findings.push_back({.kind = "no_rivers",
                                         .text = fmt::format("there are no rivers: no mask {}",
                                                             land_masks()[static_cast<std::size_t>(mask)].name)});
                continue;
            }
            list.push_back(mask == LandMask::land_cover ? land_cover() : one_mask(mask));
        }
        return list;
    }
    std::vector<std::string> write_mask(Raster<float> const& shares, std::string const& name, int bits) const {
        return write_tiles(shares, tiles_, false, "masks/" + name, "png",
                           [&](Raster<float> const& tile, std::string const& file) {
                               io::write_grey_png(tile, out_.path(file), bits, run_);
                           });
    }
    ForJson one_mask(LandMask mask) {
        LandMaskMade const made = masks_.made(mask, run_);
        ExportSize const all = tiles_.all();
        int const bits = static_cast<int>(params_.mask_bits.value_or(8));
        char const* const name = land_masks()[static_cast<std::size_t>(mask)].name;
        bool const has_lines = mask == LandMask::flow || mask == LandMask::ridge || mask == LandMask::river_width;
        Raster<float> const shares = has_lines ? greatest_of(made.share, all, ground_.z.grid())
                                               : lattice(made.share, all.width, all.height, run_).z;
        return {{"name", name},           {"files", write_mask(shares, name, bits)},
                {"bits", bits},           {"black", made.low},
                {"white", made.high},     {"unit", made.unit},
                {"meaning", made.meaning}};
    }
    /// The share of a kind by sample, before all are made one.
    Raster<float> share_of_kind(std::size_t number) {
        Raster<std::uint8_t> const& kinds = masks_.kinds(run_);
        Raster<float> is_kind(kinds.grid(), 0.0F);
        for (std::int64_t i = 0; i < kinds.cells(); ++i) {
            is_kind[i] = kinds[i] == number ? 1.0F : 0.0F;
        }
        ExportSize const all = tiles_.all();
        return lattice(is_kind, all.width, all.height, run_).z;
    }
    /// A number by sample, and a weight by sample of each kind.
    ForJson land_cover() {
        std::vector<std::int64_t> cells(land_kinds().size(), 0);
        for (std::uint8_t const kind : masks_.kinds(run_).values()) {
            ++cells[kind];
        }
        Raster<float> numbers(ground_.z.grid(), 0.0F);
        Raster<float> most(ground_.z.grid(), 0.0F);
        Raster<float> sum(ground_.z.grid(), 0.0F);
        auto const each = [&](auto const& visit) {
            for (std::size_t k = 0; k < cells.size(); ++k) {
                if (cells[k] > 0) {
                    visit(k, share_of_kind(k));
                }
            }
        };
        each([&](std::size_t k, Raster<float> const& share) {
            for (std::int64_t i = 0; i < share.cells(); ++i) {
                sum[i] += share[i];
                if (share[i] > most[i]) {
                    most[i] = share[i];
                    numbers[i] = static_cast<float>(k) / 255.0F;
                }
            }
        });
        ForJson legend = ForJson::array();
        each([&](std::size_t k, Raster<float> share) {
            for (std::int64_t i = 0; i < share.cells(); ++i) {
                share[i] = sum[i] > 0.0F ? share[i] / sum[i] : 0.0F;
            }
            LandKind const& kind = land_kinds()[k];
            double const land = static_cast<double>(cells[k]) / static_cast<double>(scene_.dem->cells());
            legend.push_back(ForJson{{"number", k},
                                     {"name", kind.name},
                                     {"share", rounded(land)},
                                     {"where", kind.where_it_is},
                                     {"colour", fmt::format("#{:06x}", kind.colour)},
                                     {"weights", write_mask(share, fmt::format("land_cover_{}", kind.name), 8)}});
        });
        return {{"name", "land_cover"},
                {"files", write_mask(numbers, "land_cover", 8)},
                {"bits", 8},
                {"meaning", "a guess of what grows or lies there: the number of a kind; weights are the kinds' shares"},
                {"tree_line_m", tree_line_m()},
                {"kinds", legend}};
    }
    ForJson river_file(ExportResult& made) const {
        Frame const frame = frame_of(program_.preset, ground_, made);
        std::int64_t outside = 0;
        std::int64_t all = 0;
        ForJson rivers = ForJson::array();
        for (RiverSpline const& river : rivers_) {
            ForJson points = ForJson::array();
            for (std::size_t i = 0; i < river.line.size(); ++i) {
                Vec3 const p = frame.place(river.line[i]);
                Vec2 const at = in_plan(river.line[i]);
                double const z = height_on_mesh(ground_, at);
                Vec3 const ground = std::isnan(z) ? p : frame.place({at.x, at.y, z});
                points.push_back({rounded(p.x), rounded(p.y), rounded(p.z), rounded(river.width_m[i]),
                                  rounded(river.discharge_m3s[i], 1e6), rounded(frame.y_up ? ground.y : ground.z)});
                Grid const& grid = scene_.dem->grid();
                ++all;
                outside += at.x < grid.west || at.x > grid.east() || at.y < grid.south() || at.y > grid.north ? 1 : 0;
            }
            rivers.push_back(ForJson{{"id", river.arc},
                                     {"downstream", river.ds_arc},
                                     {"strahler", river.strahler},
                                     {"points", std::move(points)}});
        }
        ForJson facts{{"file", "rivers.json"},
                      {"rivers", rivers.size()},
                      {"axes", frame.axes},
                      {"runoff_mm", runoff_of(params_)},
                      {"point", {"x", "y", "z", "width_m", "discharge_m3s", "ground"}},
                      {"ground", "height of the heightmap there, in the unit and direction of heights"}};
        if (outside > 0) {
            made.findings.push_back(
                {.kind = "off_dem",
                 .amount = static_cast<double>(outside),
                 .text = fmt::format("{} of {} points of rivers lie outside the DEM", outside, all)});
        }
        ForJson file = facts;
        file.erase("file");
        file["rivers"] = std::move(rivers);
        io::write_text(out_.path("rivers.json"), file.dump() + "\n");
        return facts;
    }
    ForJson mesh_file(ExportResult& made) {
        Grid const& grid = scene_.dem->grid();
        std::int64_t const longer = std::min(std::max(grid.width, grid.height), mesh_vertices_for);
        ExportResult of_mesh;
        of_mesh.format = ExportFormat::glb;
        Lattice const ground = sampled(scene_, fitting(grid, longer), of_mesh, run_);
        LatticeMesh mesh = surface_mesh(ground, made.exaggeration, run_);
        for (Vec3& v : mesh.vertices) { // heights above the lowest of the heightmap
            v.z += made.exaggeration * (mesh.origin.z - made.min_m);
        }
        mesh.origin.z = made.min_m;
        constexpr std::int64_t most_bytes = 1 << 30;
        std::string const texture = io::read_text(out_.path(colour_), most_bytes);
        ForJson const facts{{"thalweg", report::version()},
                            {"crs", ground.z.grid().crs},
                            {"origin", {mesh.origin.x, mesh.origin.y, mesh.origin.z}},
                            {"exaggeration", made.exaggeration}};
        GlbScene shown{mesh, texture, {}, "thalweg " + report::version(), facts.dump()};
        if (scene_.network) {
            shown.rivers = rivers_on_mesh(*scene_.network, ground, mesh, made.exaggeration);
        }
        made.vertices = static_cast<std::int64_t>(mesh.vertices.size());
        made.triangles = static_cast<std::int64_t>(mesh.triangles.size());
        made.river_lines = static_cast<std::int64_t>(shown.rivers.size());
        made.origin = mesh.origin;
        io::write_text(out_.path("terrain.glb"), glb(shown, run_));
        return {{"file", "terrain.glb"},
                {"axes", "x east, y up, z south; metres from origin"},
                {"origin", {mesh.origin.x, mesh.origin.y, mesh.origin.z}},
                {"exaggeration", made.exaggeration},
                {"vertices", made.vertices},
                {"triangles", made.triangles},
                {"river_lines", made.river_lines}};
    }

    ExportParams const& params_;
    Program const& program_;
    report::Scene const& scene_;
    io::OutputFolder const& out_;
    Run const& run_;
    std::vector<RiverSpline> const& rivers_;
    LandMasks masks_;
    Tiles tiles_;
    Lattice ground_;
    std::string colour_ = "colour.png";
};

/// Writes what a printer takes.
ForJson print_for(ExportParams const& params, report::Scene const& scene, io::OutputFolder const& out,
                  ExportResult& made, Run const& run) {
    PrintParams print;
    print.longest_mm = params.print_mm.value_or(print.longest_mm);
    print.base_mm = params.base.value_or(print.base_mm);
    print.exaggeration = params.exaggeration.value_or(1.0);
    PrintExport const printed = write_print(scene, print, out, run);
    std::ranges::copy(printed.findings, std::back_inserter(made.findings));
    auto const range = report::height_range(*scene.dem);
    made.format = ExportFormat::stl;
    made.width = printed.width;
    made.height = printed.height;
    made.min_m = range ? range->first : 0.0;
    made.max_m = range ? range->second : 0.0;
    made.exaggeration = print.exaggeration;
    made.vertices = printed.vertices;
    made.triangles = printed.triangles;
    ForJson json{{"width", made.width},
                 {"height", made.height},
                 {"min_m", made.min_m},
                 {"max_m", made.max_m},
                 {"file", "terrain.stl"},
                 {"axes", "millimetres: x east, y north, z up from the corner of the plate"},
                 {"size_mm", {printed.size_mm.x, printed.size_mm.y, printed.size_mm.z}},
                 {"scale", printed.scale},
                 {"relief_mm", printed.relief_mm},
                 {"base_mm", print.base_mm},
                 {"exaggeration", print.exaggeration},
                 {"vertices", printed.vertices},
                 {"triangles", printed.triangles},
                 {"crs", scene.dem->grid().crs}};
    json.update(ForJson::parse(description_of_gaps(made)));
    return json;
}

/// Writes what a web server takes.
ForJson web_for(ExportParams const& params, report::Scene const& scene, io::OutputFolder const& out, ExportResult& made,
                Run const& run) {
    WebExportParams web;
    web.exaggeration = params.exaggeration.value_or(1.0);
    WebExport const written = write_web(scene, web, out, run);
    std::ranges::copy(written.findings, std::back_inserter(made.findings));
    made.width = scene.dem->width();
    made.height = scene.dem->height();
    made.min_m = written.min_m;
    made.max_m = written.max_m;
    made.exaggeration = web.exaggeration;
    made.holes = std::max(made.holes, written.holes);
    io::DegreeBox const& box = written.bounds;
    ForJson json{{"width", made.width},
                 {"height", made.height},
                 {"min_m", made.min_m},
                 {"max_m", made.max_m},
                 {"metres_per_step", 0.1},
                 {"heights", "heights/{z}/{x}/{y}.png: -10000 m + (65536 red + 256 green + blue) x 0.1 m"},
                 {"colour", "colour/{z}/{x}/{y}.png"},
                 {"axes", "tiles in EPSG:3857, y from the north; heights 256 x 256, colours 512 x 512 pixels"},
                 {"min_zoom", written.min_zoom},
                 {"max_zoom", written.max_zoom},
                 {"max_zoom_of_terrain_html", written.page_max_zoom},
                 {"bounds_degrees", {box.west, box.south, box.east, box.north}},
                 {"tiles", written.tiles},
                 {"exaggeration", made.exaggeration},
                 {"crs", scene.dem->grid().crs}};
    json.update(ForJson::parse(description_of_gaps(made)));
    return json;
}

/// Files of an earlier export in a folder.
std::vector<std::string> exported_before(std::string const& folder) {
    fs::path const path = fs::path(folder) / description_for;
    constexpr std::int64_t largest = 64 << 20;
    return fs::exists(path) ? report::files_of_report(io::read_text(path.string(), largest))
                            : std::vector<std::string>{};
}

} // namespace

std::vector<ExportPresetName> const& export_presets() {
    static std::vector<ExportPresetName> const presets{
        {ExportPreset::unreal, "unreal"},   {ExportPreset::unity, "unity"}, {ExportPreset::godot, "godot"},
        {ExportPreset::blender, "blender"}, {ExportPreset::web, "web"},     {ExportPreset::print3d, "print3d"}};
    return presets;
}

ExportResult run_export_for(ExportParams const& params, Run const& run) {
    ExportPreset const preset = preset_of(params.preset);
    require_options_for(params, preset);
    std::vector<std::string> const before =
        params.existing == io::Existing::replace ? exported_before(params.output) : std::vector<std::string>();
    io::OutputFolder out(params.output, params.existing, before);
    constexpr std::int64_t longest_side = 30000;
    report::SceneRead read = report::read_scene(
        {.source = params.source, .network = {}, .reading = params.reading, .most_side = longest_side}, run);
    refuse_if<BadInput>(!read.scene.dem, "export.run_export", "{} holds no dem.tif", params.source);
    ExportResult made;
    made.findings = std::move(read.findings);
    std::string const name = fs::path(params.source).lexically_normal().filename().string();
    ForJson json{{"thalweg", report::version()},
                 {"source", name.empty() || name == "." ? params.source : name},
                 {"for", params.preset}};
    Program const* const program = program_of(preset);
    std::vector<RiverSpline> rivers;
    if (program != nullptr && read.scene.network) {
        rivers = river_splines(read.scene, runoff_of(params), run);
    }
    if (preset != ExportPreset::web || asks_for_gaps(params)) {
        close_gaps_of(read.scene, params, made, run);
    }
    if (made.gaps.is_cut) {
        rivers = rivers_inside(rivers, read.scene.dem->grid(), made);
    }
    json.update(program != nullptr            ? ForProgram(params, *program, read.scene, rivers, out, run).write(made)
                : preset == ExportPreset::web ? web_for(params, read.scene, out, made, run)
                                              : print_for(params, read.scene, out, made, run));
    std::vector<std::string> files = out.files();
    files.emplace_back(description_for);
    json["files"] = files;
    made.description = json.dump(2, ' ', false, ForJson::error_handler_t::replace);
    io::write_text(out.path(description_for), made.description + "\n");
    run.at(1.0, "write");
    out.commit();
    for (std::string const& file : files) {
        made.files.push_back((fs::path(params.output) / file).string());
    }
    run.report(made.findings);
    return made;
}

} // namespace thalweg::exports
