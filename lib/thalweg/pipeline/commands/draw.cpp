// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/commands/draw.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <thalweg/core/run/messages.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/draw/sections.hpp>
#include <thalweg/io/network/read_network.hpp>
#include <thalweg/io/network/read_rivers.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/io/raster/read_drawable.hpp>
#include <thalweg/network/import/import_lines.hpp>
#include <thalweg/network/import/prepare_lines.hpp>
#include <thalweg/network/order/order.hpp>
#include <thalweg/pipeline/recipe/recipe.hpp>
#include <thalweg/pipeline/report/internal/page.hpp>
#include <thalweg/surface/dilation/increment.hpp>

namespace thalweg::pipeline {
namespace {

struct SceneRead {
    Scene scene;
    std::vector<std::string> notes; // changes and choices for the pictures, as sentences
};

namespace fs = std::filesystem;

constexpr std::int64_t largest_text = 1 << 30;

/// Builds the network of thalweg's own file.
ElevatedNetwork network_of(NetworkFile const& file, std::string const& name) {
    ElevatedNetwork out;
    NetworkDraft plan;
    std::unordered_map<std::int64_t, NodeId> nodes;
    for (NetworkFile::FileNode const& node : file.nodes) {
        NodeId const id = plan.add_node({node.at.x, node.at.y});
        refuse_if<BadInput>(!nodes.emplace(node.id, id).second,
                            "pipeline.run_draw: {}: node {} is there twice; check the network (thalweg check)", name,
                            node.id);
        out.node_z.push_back(node.at.z);
    }
    for (NetworkFile::FileArc const& arc : file.arcs) {
        auto const from = nodes.find(arc.from_node);
        auto const to = nodes.find(arc.to_node);
        refuse_if<BadInput>(from == nodes.end() || to == nodes.end() || arc.line.size() < 2,
                            "pipeline.run_draw: {}: arc {} lacks a node or a line; check the network (thalweg check)",
                            name, arc.id);
        Arc drawn;
        std::vector<double> z;
        for (Vec3 const v : arc.line) {
            drawn.line.push_back({v.x, v.y});
            z.push_back(v.z);
        }
        plan.add_arc(from->second, to->second, std::move(drawn));
        out.arc_z.push_back(std::move(z));
    }
    out.planform = std::move(plan);
    return out;
}

/// Heights of a DEM along an arc; interpolated across holes.
std::vector<double> draped(std::vector<Vec2> const& line, Raster<float> const& dem, double where_none) {
    std::vector<double> z(line.size());
    std::transform(line.begin(), line.end(), z.begin(), [&](Vec2 p) { return draw::height_at(dem, p); });
    std::size_t known = line.size(); // the last vertex with a height
    for (std::size_t i = 0; i < z.size(); ++i) {
        if (!std::isfinite(z[i])) {
            continue;
        }
        for (std::size_t k = known == line.size() ? 0 : known + 1; k < i; ++k) {
            double const share =
                known == line.size() ? 1.0 : static_cast<double>(k - known) / static_cast<double>(i - known);
            z[k] = known == line.size() ? z[i] : z[known] + (z[i] - z[known]) * share;
        }
        known = i;
    }
    for (std::size_t k = known == line.size() ? 0 : known + 1; k < z.size(); ++k) {
        z[k] = known == line.size() ? where_none : z[known];
    }
    return z;
}

double lowest_of(Raster<float> const& dem) {
    double low = 0.0;
    bool first = true;
    for (float const z : dem.values()) {
        if (std::isfinite(z)) {
            low = first ? static_cast<double>(z) : std::min(low, static_cast<double>(z));
            first = false;
        }
    }
    return low;
}

ElevatedNetwork drape(StreamNetwork plan, Raster<float> const& dem) {
    ElevatedNetwork out{std::move(plan), {}, {}};
    double const lowest = lowest_of(dem);
    out.node_z.assign(out.planform.node_count(), lowest);
    for (ArcId arc = 0; arc < out.planform.arc_count(); ++arc) {
        out.arc_z.push_back(draped(out.planform.arc(arc).line, dem, lowest));
        out.node_z[out.planform.from(arc)] = out.arc_z.back().front();
        out.node_z[out.planform.to(arc)] = out.arc_z.back().back();
    }
    return out;
}

/// Rivers from any line file on a DEM; nothing: none lies on it.
std::optional<ElevatedNetwork> rivers_on(Raster<float> const& dem, std::string const& file,
                                         std::vector<std::string>& notes, Run const& run) {
    io::ReadRiversParams params;
    params.path = file;
    params.crs = dem.grid().crs;
    RiverLines const lines = network::clip_lines(io::read_rivers(params, run), dem.grid());
    for (Finding const& finding : lines.findings) {
        if (finding.kind == "not_a_line") {
            notes.push_back(fmt::format("{}: {}", lines.name, finding.text));
        }
    }
    if (lines.lines.empty()) {
        notes.push_back(fmt::format("no river of {} runs on the DEM", lines.name));
        return std::nullopt;
    }
    network::Imported imported = network::import_lines(lines, {}, run);
    if (!imported.arc_z.empty()) {
        try {
            return network::take_file_heights(imported, lines);
        } catch (BadInput const&) { // they run uphill somewhere, or were clipped
            notes.push_back(
                fmt::format("heights of {} do not fall all the way: the rivers take those of the DEM", lines.name));
        }
    }
    return drape(std::move(imported.network), dem);
}

/// Reads the increments of the surface: the recipe names them, the report has their number and scale.
void read_increments(Scene& scene, Recipe const& recipe, std::string const& report) {
    auto const json = nlohmann::json::parse(report, nullptr, false);
    auto const dem = json.is_object() && json.contains("dem") ? json["dem"] : nlohmann::json();
    if (!recipe.surface || !dem.is_object() || !dem.contains("levels") || !dem["levels"].is_number_integer() ||
        !dem.contains("metres_per_unit") || !dem["metres_per_unit"].is_number()) {
        return;
    }
    constexpr std::int64_t most = 1 << 24;
    std::int64_t const levels = dem["levels"].get<std::int64_t>();
    if (levels < 1 || levels > most) {
        return;
    }
    surface::IncrementParams const& wanted = recipe.surface->dilate.increment;
    scene.increments = surface::increments(levels, wanted);
    scene.increment = wanted.increment;
    for (double& increment : scene.increments) {
        increment *= dem["metres_per_unit"].get<double>();
    }
}

SceneRead read_folder(DrawParams const& params, Run const& run) {
    fs::path const folder = params.source;
    SceneRead out;
    Scene& scene = out.scene;
    std::string const dem = (folder / "dem.tif").string();
    std::string const rivers = (folder / "network.gpkg").string();
    std::string const recipe = (folder / "recipe.toml").string();
    std::string const report = (folder / "report.json").string();
    if (!fs::exists(dem) && !fs::exists(rivers)) {
        throw BadInput(fmt::format("pipeline.run_draw: {} holds neither dem.tif nor network.gpkg: name a folder "
                                   "written by make, or a raster",
                                   folder.string()));
    }
    if (fs::exists(dem)) {
        io::Drawable read = io::read_drawable(dem, {.metres = io::MetresOf::any_crs, .nodata = params.nodata},
                                              run); // the choice of its maker
        scene.dem = std::move(read.dem);
        out.notes = std::move(read.notes);
    }
    if (params.network.empty() && fs::exists(rivers)) {
        NetworkFile const file = io::read_network(rivers, run);
        scene.network = network_of(file, rivers);
        for (NetworkFile::FileArc const& arc : file.arcs) {
            scene.ds_area_m2.push_back(arc.ds_area_m2);
        }
    }
    if (std::string const lakes = (folder / "lakes.tif").string(); fs::exists(lakes) && scene.dem) {
        scene.lakes = io::read_mask({lakes}, scene.dem->grid(), run);
    }
    if (fs::exists(recipe)) {
        Recipe const made = read_recipe(io::read_text(recipe, 2 << 20), recipe);
        scene.title = title_of(made);
        scene.sea = sea_of(made);
        bool const in_metres = made.output.units == HeightUnit::metre; // pictures are always in metres
        scene.contour_interval_m = in_metres ? made.output.contour_interval : 0.0;
        if (fs::exists(report)) {
            read_increments(scene, made, io::read_text(report, largest_text));
        }
    }
    return out;
}

// Reads everything that can be drawn. source: a folder written by make (dem.tif, network.gpkg, recipe.toml,
// report.json, if present) or a raster of heights (io::read_drawable). network: "" or a file of river lines, clipped to
// the DEM, imported and ordered, with the file's heights if these fall everywhere, else the DEM's. The title is from
// the recipe or the raster's name. Throws BadInput when the folder contains nothing to draw; as the readers and
// network::import_lines.
SceneRead read_scene(DrawParams const& params, Run const& run) {
    std::string const& source = params.source;
    std::string const& network = params.network;
    SceneRead out;
    std::error_code ignored;
    if (fs::is_directory(source, ignored) &&
        (fs::exists(fs::path(source) / "dem.tif") || fs::exists(fs::path(source) / "report.json") ||
         fs::exists(fs::path(source) / "network.gpkg") || fs::path(source).extension().empty())) {
        out = read_folder(params, run);
    } else {
        io::Drawable read = io::read_drawable(source, {.nodata = params.nodata}, run);
        out.scene.dem = std::move(read.dem);
        out.notes = std::move(read.notes);
        out.scene.title = fs::path(source).stem().string();
    }
    if (!network.empty()) {
        if (!out.scene.dem) {
            throw BadInput(fmt::format("pipeline.run_draw: there is no DEM to lay the rivers of {} on", network));
        }
        out.scene.network = rivers_on(*out.scene.dem, network, out.notes, run);
    }
    if (out.scene.network) {
        out.scene.orders = network::order(out.scene.network->planform);
    }
    return out;
}

struct NamedFormat {
    char const* name;
    draw::Format format;
};
constexpr NamedFormat formats[] = {{"png", draw::Format::png}, {"svg", draw::Format::svg}, {"pdf", draw::Format::pdf}};

constexpr char const* page_word = "page";
constexpr char const* page_ending = ".html";

[[noreturn]] void unknown(char const* what, std::string const& word, std::vector<std::string> const& known) {
    throw BadParameter(fmt::format("pipeline.run_draw: unknown {1} '{0}'; there are {2}.{3}", word, what,
                                   fmt::join(known, ", "), did_you_mean(word, known)));
}

PictureKind kind_of(std::string const& word) {
    std::vector<std::string> known;
    for (PictureKind const kind : picture_kinds()) {
        if (word == name_of(kind)) {
            return kind;
        }
        known.emplace_back(name_of(kind));
    }
    known.emplace_back(page_word);
    unknown("picture", word, known);
}

NamedFormat format_of(std::string const& word) {
    std::vector<std::string> known;
    for (NamedFormat const& format : formats) {
        if (word == format.name) {
            return format;
        }
        known.emplace_back(format.name);
    }
    unknown("format", word, known);
}

/// An output file: a picture, or without a kind the report page.
struct Task {
    std::optional<PictureKind> kind;
    draw::Format format = draw::Format::png;
    std::string name;
};

/// The requested output, determined before anything is read.
struct Order {
    std::string folder;
    std::string single; ///< name of the single picture; "": a folder
    std::vector<PictureKind> kinds;
    std::vector<NamedFormat> formats;
    bool page = false;
    bool everything() const { return kinds.empty() && !page; }
};

template <class T, class Same> void add_once(std::vector<T>& list, T const& item, Same const& same) {
    if (std::none_of(list.begin(), list.end(), [&](T const& other) { return same(other, item); })) {
        list.push_back(item);
    }
}

Order order_of(DrawParams const& params) {
    std::string const& output = params.output;
    Order order;
    for (std::string const& word : params.what) {
        if (word == page_word) {
            order.page = true;
            continue;
        }
        add_once(order.kinds, kind_of(word), [](PictureKind a, PictureKind b) { return a == b; });
    }
    for (std::string const& word : params.formats) {
        add_once(order.formats, format_of(word),
                 [](NamedFormat const& a, NamedFormat const& b) { return a.format == b.format; });
    }
    refuse_if<BadParameter>(output.empty(), "pipeline.run_draw: the name of the output is empty");
    fs::path const path(output);
    std::string const ending = path.extension().string();
    bool const is_folder = fs::is_directory(path);
    bool const is_page = !is_folder && ending == page_ending;
    bool const is_picture = !is_folder && std::any_of(std::begin(formats), std::end(formats), [&](auto const& f) {
        return ending == std::string(".") + f.name;
    });
    order.folder = output;
    if (is_page || is_picture) {
        order.single = path.filename().string();
        order.folder = path.has_parent_path() ? path.parent_path().string() : ".";
    }
    if (is_page) {
        refuse_if<BadParameter>(!order.kinds.empty() || !order.formats.empty(),
                                "pipeline.run_draw: {} is the name of a page: name a folder for pictures", output);
        order.page = true;
    } else if (is_picture) {
        NamedFormat const own = format_of(ending.substr(1));
        bool const other = std::any_of(order.formats.begin(), order.formats.end(),
                                       [&](NamedFormat const& f) { return f.format != own.format; });
        refuse_if<BadParameter>(
            order.kinds.size() > 1 || other || order.page,
            "pipeline.run_draw: {} is the name of one picture in one format: name a folder for several", output);
        if (order.kinds.empty()) {
            order.kinds = {PictureKind::map};
        }
        order.formats = {own};
    } else if (order.formats.empty()) {
        order.formats = {formats[0]};
    }
    return order;
}

std::vector<Task> tasks_of(Order const& order, Scene const& scene) {
    std::vector<Task> tasks;
    if (order.page) {
        tasks.push_back({{}, {}, order.single.empty() ? std::string(page_word) + page_ending : order.single});
    }
    for (PictureKind const kind : order.everything() ? picture_kinds() : order.kinds) {
        std::string const missing = missing_for(kind, scene);
        if (!missing.empty() && order.everything()) {
            continue;
        }
        if (!missing.empty()) {
            throw BadInput(fmt::format("pipeline.run_draw: no {} can be drawn: {}", name_of(kind), missing));
        }
        for (NamedFormat const& format : order.formats) {
            tasks.push_back({kind, format.format,
                             order.single.empty() ? fmt::format("{}.{}", name_of(kind), format.name) : order.single});
        }
    }
    return tasks;
}

std::string command_of(DrawParams const& params) {
    std::string command =
        fmt::format("thalweg draw {} -o {} --what page", for_shell(params.source), for_shell(params.output));
    if (!params.network.empty()) {
        command += " --network " + for_shell(params.network);
    }
    if (!params.title.empty()) {
        command += " --title " + for_shell(params.title);
    }
    return command;
}

} // namespace

DrawResult run_draw(DrawParams const& params, Run const& run) {
    Order const order = order_of(params);
    SceneRead read = read_scene(params, run);
    if (!params.title.empty()) {
        read.scene.title = params.title;
    }
    std::vector<Task> const tasks = tasks_of(order, read.scene);
    std::vector<std::string> there;
    for (Task const& task : tasks) {
        if (fs::exists(fs::symlink_status(fs::path(order.folder) / task.name))) {
            there.push_back(task.name);
        }
    }
    if (!there.empty() && params.existing == io::Existing::refuse) {
        throw BadInput(fmt::format("pipeline.run_draw: {} already exists: name another or use --overwrite",
                                   (fs::path(order.folder) / there.front()).string()));
    }
    io::OutputFolder out(order.folder, io::Existing::add, there);
    DrawResult drawn{{}, std::move(read.notes)};
    for (std::size_t i = 0; i < tasks.size(); ++i) {
        run.at(static_cast<double>(i) / static_cast<double>(tasks.size()),
               tasks[i].kind ? name_of(*tasks[i].kind) : page_word);
        Look look = params.look;
        look.format = tasks[i].format;
        io::write_text(out.path(tasks[i].name), tasks[i].kind
                                                    ? draw_picture(*tasks[i].kind, read.scene, look, run).bytes
                                                    : scene_page(read.scene, drawn.notes, command_of(params), run));
        drawn.files.push_back(order.folder == "." && !order.single.empty()
                                  ? tasks[i].name
                                  : (fs::path(order.folder) / tasks[i].name).string());
    }
    run.at(1.0, "draw");
    out.commit();
    return drawn;
}

} // namespace thalweg::pipeline
