// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/export/export.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
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
#include <thalweg/io/mesh/lattice_files.hpp>
#include <thalweg/io/raster/heightmap.hpp>
#include <thalweg/report/read_scene.hpp>
#include <thalweg/report/report.hpp>

namespace thalweg::exports {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t most_samples = 16385;  // a side
constexpr std::int64_t most_vertices = 4097;  // a side of a mesh: a GLB of 0.9 GB
constexpr std::int64_t usual_vertices = 1025; // a side of a mesh

char const* export_name_of(ExportFormat format) {
    return export_formats()[static_cast<std::size_t>(format)].name;
}

ExportFormat export_format_of(ExportParams const& params) {
    std::vector<std::string> names;
    std::string ending = fs::path(params.output).extension().string();
    std::ranges::transform(ending, ending.begin(),
                           [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    for (ExportFormatName const& known : export_formats()) {
        if (params.format.empty() ? ending == known.ending : params.format == known.name) {
            return known.format;
        }
        names.emplace_back(known.name);
    }
    if (params.format.empty() && ending == ".raw") { // as Unity and Unreal name it
        return ExportFormat::r16;
    }
    throw BadParameter("export.run_export",
                       params.format.empty() ? fmt::format("the name of {} does not tell the format; name one of {}",
                                                           params.output, fmt::join(names, ", "))
                                             : fmt::format("unknown format '{}'; the formats are {}.{}", params.format,
                                                           fmt::join(names, ", "), did_you_mean(params.format, names)));
}

void require_options(ExportParams const& params, ExportFormat format) {
    refuse_if<BadParameter>(params.output.empty(), "export.run_export", "the name of the output is empty");
    refuse_if<BadParameter>(
        params.exaggeration && !is_mesh(format), "export.run_export",
        "--exaggeration applies to meshes (glb, obj, stl), not to {}: a program that reads it scales heights itself",
        export_name_of(format));
    refuse_if<BadParameter>(params.base && format != ExportFormat::stl, "export.run_export",
                            "--base applies to the solid of stl, not to {}", export_name_of(format));
    refuse_if<BadParameter>(
        params.tiles_across || params.tiles_down || !params.masks.empty() || params.mask_bits || params.runoff_mm ||
            params.tree_line_m || params.print_mm,
        "export.run_export",
        "tiles, masks, runoff, tree line and print size belong to --for PRESET, not to a single file");
    refuse_if<BadParameter>(params.width.has_value() != params.height.has_value(), "export.run_export",
                            "a size has a width and a height");
    require_gap_options(params);
    for (auto const& [name, value] : {std::pair{"exaggeration", params.exaggeration}, {"base", params.base}}) {
        if (value) {
            require_in("export.run_export", name, *value, Range::above(0.0));
        }
    }
    std::int64_t const most = is_mesh(format) ? most_vertices : most_samples;
    for (std::optional<std::int64_t> const side : {params.width, params.height}) {
        if (side) {
            require_in("export.run_export", "size", *side, Range::between(2.0, static_cast<double>(most)),
                       is_mesh(format) ? "vertices" : "samples");
        }
    }
}

ExportSize size_of(ExportParams const& params, ExportFormat format, Grid const& grid, std::vector<Finding>& findings) {
    refuse_if<BadInput>(grid.width < 2 || grid.height < 2, "export.run_export",
                        "{} has {} x {} cells: at least 2 x 2 are needed", params.source, grid.width, grid.height);
    if (params.width) {
        ExportSize const asked{*params.width, *params.height};
        double const across = static_cast<double>(grid.width - 1) / static_cast<double>(asked.width - 1);
        double const down = static_cast<double>(grid.height - 1) / static_cast<double>(asked.height - 1);
        if (std::fabs(across - down) > 0.01 * std::min(across, down)) {
            ExportSize const fit = fitting(grid, std::max(asked.width, asked.height));
            throw BadInput("export.run_export",
                           fmt::format("{} x {} would stretch a DEM of {} x {} cells by {:.0f} %: use --size {}x{}, or "
                                       "cut the DEM to that shape first (gdal_translate -srcwin)",
                                       asked.width, asked.height, grid.width, grid.height,
                                       100.0 * (std::max(across, down) / std::min(across, down) - 1.0), fit.width,
                                       fit.height));
        }
        return asked;
    }
    std::int64_t const most = is_mesh(format) ? usual_vertices : most_samples;
    if (std::max(grid.width, grid.height) <= most) {
        return {grid.width, grid.height};
    }
    ExportSize const fit = fitting(grid, most);
    findings.push_back(
        {.kind = "reduced",
         .amount = static_cast<double>(fit.width * fit.height),
         .text = fmt::format("{} x {} cells are reduced to {} x {} {} (--size sets another size)", grid.width,
                             grid.height, fit.width, fit.height, is_mesh(format) ? "vertices" : "samples")});
    return fit;
}

using ExportJson = nlohmann::ordered_json;

ExportJson json_of(ExportResult const& made, std::string const& source) {
    bool const mesh = is_mesh(made.format);
    std::string const name = fs::path(source).lexically_normal().filename().string();
    ExportJson json{{"thalweg", report::version()},
                    {"source", name.empty() || name == "." ? source : name},
                    {"format", export_name_of(made.format)},
                    {"width", made.width},
                    {"height", made.height},
                    {"min_m", made.min_m},
                    {"max_m", made.max_m}};
    bool const sixteen = made.format == ExportFormat::png16 || made.format == ExportFormat::r16;
    if (sixteen) {
        json["metres_per_step"] = made.metres_per_step;
    }
    json["step_m"] = {made.step_m.x, made.step_m.y};
    json["size_m"] = {static_cast<double>(made.width - 1) * made.step_m.x,
                      static_cast<double>(made.height - 1) * made.step_m.y};
    json["north_west"] = {made.north_west.x, made.north_west.y};
    json["crs"] = made.crs;
    if (mesh) {
        json["axes"] = made.format == ExportFormat::stl ? "x east, y north, z up; metres from origin"
                                                        : "x east, y up, z south; metres from origin";
        json["origin"] = {made.origin.x, made.origin.y, made.origin.z};
        json["exaggeration"] = made.exaggeration;
        if (made.format == ExportFormat::stl) {
            json["base_m"] = made.base_m;
        }
        json["vertices"] = made.vertices;
        json["triangles"] = made.triangles;
        if (made.format == ExportFormat::glb) {
            json["river_lines"] = made.river_lines;
        }
    } else {
        json["axes"] = "rows from north to south, samples of a row from west to east";
        json["samples"] =
            sixteen ? "16-bit unsigned: min_m + number x metres_per_step" : "32-bit floating point, metres";
        json["byte_order"] = made.format == ExportFormat::png16 ? "big-endian, as in every PNG" : "little-endian";
    }
    json.update(ExportJson::parse(description_of_gaps(made)));
    return json;
}

/// The files of an export, written together.
class ExportFiles {
public:
    ExportFiles(ExportParams const& params, ExportFormat format)
        : folder_(fs::path(params.output).has_parent_path() ? fs::path(params.output).parent_path() : fs::path(".")),
          names_(names_of(fs::path(params.output), format)),
          out_(folder_.string(), io::Existing::add, io::files_there(folder_.string(), names_, params.existing)) {}

    std::string path(std::size_t number) const { return out_.path(names_[number]); }
    std::string const& name(std::size_t number) const { return names_[number]; }
    std::size_t description() const { return names_.size() - 1; }
    std::vector<std::string> commit() {
        out_.commit();
        std::vector<std::string> files;
        for (std::string const& name : names_) {
            files.push_back(folder_ == "." ? name : (folder_ / name).string());
        }
        return files;
    }

private:
    static std::vector<std::string> names_of(fs::path const& path, ExportFormat format) {
        std::string const name = path.filename().string();
        refuse_if<BadParameter>(name.empty() || name == "." || name == ".." || fs::is_directory(path),
                                "export.run_export", "{} is a folder: name a file", path.string());
        std::vector<std::string> names{name};
        if (format == ExportFormat::obj) {
            names.push_back(path.stem().string() + ".mtl");
            names.push_back(path.stem().string() + "_texture.png");
        }
        names.push_back(name + ".json");
        return names;
    }
    fs::path folder_;
    std::vector<std::string> names_;
    io::OutputFolder out_;
};

void write_obj(LatticeMesh const& mesh, report::Scene const& scene, ExportFiles const& files, ExportResult const& made,
               Run const& run) {
    constexpr char const* material = "ground";
    io::write_textured_obj(mesh, files.path(0), {made.crs, files.name(1), material, made.exaggeration}, run);
    io::write_text(files.path(1),
                   fmt::format("# thalweg\nnewmtl {}\nKa 0 0 0\nKd 1 1 1\nKs 0 0 0\nillum 1\nmap_Kd {}\n", material,
                               files.name(2)));
    io::write_text(files.path(2), texture_of(scene, run));
}

void write_mesh(Lattice const& ground, report::Scene const& scene, ExportParams const& params, ExportFiles const& files,
                ExportResult& made, Run const& run) {
    made.exaggeration = params.exaggeration.value_or(1.0);
    if (made.format == ExportFormat::stl) {
        double const tenth = 0.1 * (made.max_m - made.min_m);
        made.base_m = params.base.value_or(std::max(tenth, scene.dem->grid().cell_m));
    }
    LatticeMesh const mesh = made.format == ExportFormat::stl ? solid_mesh(ground, made.base_m, made.exaggeration, run)
                                                              : surface_mesh(ground, made.exaggeration, run);
    made.vertices = static_cast<std::int64_t>(mesh.vertices.size());
    made.triangles = static_cast<std::int64_t>(mesh.triangles.size());
    made.origin = mesh.origin;
    if (made.format == ExportFormat::stl) {
        io::write_stl(mesh, files.path(0), run);
        return;
    }
    if (made.format == ExportFormat::obj) {
        write_obj(mesh, scene, files, made, run);
        return;
    }
    std::string const texture = texture_of(scene, run);
    GlbScene shown{mesh, texture, {}, "thalweg " + report::version(), {}};
    if (scene.network) {
        shown.rivers = rivers_on_mesh(*scene.network, ground, mesh, made.exaggeration);
    }
    made.river_lines = static_cast<std::int64_t>(shown.rivers.size());
    shown.facts = json_of(made, params.source).dump(-1, ' ', false, ExportJson::error_handler_t::replace);
    io::write_text(files.path(0), glb(shown, run));
}

} // namespace

std::vector<ExportFormatName> const& export_formats() {
    static std::vector<ExportFormatName> const formats{
        {ExportFormat::png16, "png16", ".png"}, {ExportFormat::r16, "r16", ".r16"}, {ExportFormat::r32, "r32", ".r32"},
        {ExportFormat::exr, "exr", ".exr"},     {ExportFormat::glb, "glb", ".glb"}, {ExportFormat::obj, "obj", ".obj"},
        {ExportFormat::stl, "stl", ".stl"}};
    return formats;
}

ExportResult run_export(ExportParams const& params, Run const& run) {
    if (!params.preset.empty()) {
        return run_export_for(params, run);
    }
    ExportResult made;
    made.format = export_format_of(params);
    require_options(params, made.format);
    ExportFiles files(params, made.format);
    constexpr std::int64_t longest_side = 30000;
    report::SceneRead read = report::read_scene(
        {.source = params.source, .network = {}, .reading = params.reading, .most_side = longest_side}, run);
    refuse_if<BadInput>(!read.scene.dem, "export.run_export", "{} holds no dem.tif", params.source);
    made.findings = std::move(read.findings);
    bool const keeps_gaps = made.format == ExportFormat::glb || made.format == ExportFormat::obj;
    if (!keeps_gaps || asks_for_gaps(params)) {
        close_gaps_of(read.scene, params, made, run);
    }
    ExportSize const size = size_of(params, made.format, read.scene.dem->grid(), made.findings);
    Lattice const ground = sampled(read.scene, size, made, run);
    made.width = ground.z.width();
    made.height = ground.z.height();
    made.step_m = {ground.z.grid().cell_m, ground.row_step_m};
    made.north_west = ground.north_west();
    made.crs = ground.z.grid().crs;
    auto const range = report::height_range(ground.z);
    refuse_if<BadInput>(!range, "export.run_export", "no vertex has a height");
    made.min_m = range->first;
    made.max_m = range->second;
    if (is_mesh(made.format)) {
        write_mesh(ground, read.scene, params, files, made, run);
    } else {
        constexpr io::HeightmapFormat heightmaps[] = {io::HeightmapFormat::png16, io::HeightmapFormat::r16,
                                                      io::HeightmapFormat::r32, io::HeightmapFormat::exr};
        io::HeightmapScale const scale =
            io::write_heightmap(ground.z, files.path(0), heightmaps[static_cast<std::size_t>(made.format)], run);
        made.metres_per_step = scale.step_m;
    }
    made.description = json_of(made, params.source).dump(2, ' ', false, ExportJson::error_handler_t::replace);
    io::write_text(files.path(files.description()), made.description + "\n");
    run.at(1.0, "write");
    made.files = files.commit();
    run.report(made.findings);
    return made;
}

} // namespace thalweg::exports
