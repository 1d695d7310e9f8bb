// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/recipe.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/printable.hpp>
#include <thalweg/core/run/suggest.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_asks.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_files.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_keys.hpp>
#include <thalweg/pipeline/recipe/internal/toml_depth.hpp>
#include <thalweg/pipeline/recipe/internal/unused_keys.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <string_view>

namespace thalweg::pipeline {

namespace {

std::vector<std::string> key_paths() {
    std::vector<std::string> paths;
    for (Key const& key : all_keys()) {
        paths.push_back(key.help.path);
    }
    return paths;
}

std::string unknown_key(std::string const& path) {
    std::vector<std::string> const paths = key_paths();
    std::string near = closest(path, paths);
    if (near.empty()) { // the right word in the wrong section
        std::string const word = path.substr(path.rfind('.') + 1);
        for (std::string const& p : paths) {
            if (near.empty() && p.substr(p.rfind('.') + 1) == word) {
                near = p;
            }
        }
    }
    return fmt::format("unknown key '{}'.{} `thalweg recipe` lists every key.", path,
                       near.empty() ? "" : " Did you mean '" + near + "'?");
}

std::optional<Value> value_of(toml::node const& node) {
    if (auto const* b = node.as_boolean()) {
        return b->get();
    }
    if (auto const* i = node.as_integer()) {
        return i->get();
    }
    if (auto const* d = node.as_floating_point()) {
        return d->get();
    }
    if (auto const* s = node.as_string()) {
        return s->get();
    }
    if (auto const* a = node.as_array()) {
        std::vector<double> list;
        for (toml::node const& one : *a) {
            if (auto const x = one.value<double>()) {
                list.push_back(*x);
            }
        }
        if (list.size() == a->size() && list.size() == 2) {
            return Pair{list[0], list[1]};
        }
        if (list.size() == a->size() && list.size() == 3) {
            return Triple{list[0], list[1], list[2]};
        }
        if (list.size() == a->size() && list.size() == 4) {
            return Quad{list[0], list[1], list[2], list[3]};
        }
    }
    return std::nullopt;
}

bool is_section(std::string const& path) {
    return std::any_of(all_keys().begin(), all_keys().end(), [&](Key const& k) {
        std::string const s = k.section();
        return s == path || s.substr(0, path.size() + 1) == path + ".";
    });
}

/// A section that is named is a stage that runs, empty or not.
void begin_section(Recipe& recipe, std::string const& path) {
    std::string const section = path.substr(0, path.find('.'));
    auto const begin = [&](char const* name, auto& part) {
        if (section == name && !part) {
            part.emplace();
        }
    };
    begin("network", recipe.network);
    begin("skeleton", recipe.skeleton);
    begin("surface", recipe.surface);
    begin("statistics", recipe.statistics);
    begin("detail", recipe.detail);
    if (section == "patch") {
        recipe.patches.emplace_back();
    }
}

constexpr std::size_t most_faults = 20;

/// "patch.2.rotate" of the last of two patches; any other path as it is.
std::string with_number(std::string const& path, Recipe const& recipe) {
    constexpr std::string_view begin = "patch.";
    return path.compare(0, begin.size(), begin) == 0
               ? fmt::format("patch.{}.{}", recipe.patches.size(), path.substr(begin.size()))
               : path;
}

std::string cut(std::string_view s) {
    return s.size() <= 80 ? std::string(s) : std::string(s.substr(0, 77)) + "...";
}

void read_table(toml::table const& table, std::string const& prefix, std::string const& name, Recipe& recipe,
                std::vector<std::string>& faults) {
    for (auto const& [word, node] : table) {
        if (faults.size() >= most_faults) {
            return;
        }
        std::string const path = prefix + std::string(word.str());
        auto const line = node.source().begin.line;
        if (auto const* inner = node.as_table()) {
            if (!is_section(path)) {
                faults.push_back(fmt::format("line {}: {}", line, unknown_key(cut(path))));
                continue;
            }
            begin_section(recipe, path);
            read_table(*inner, path + ".", name, recipe, faults);
            continue;
        }
        if (auto const* list = node.as_array();
            path == "patch" && list != nullptr && list->is_homogeneous<toml::table>()) {
            for (toml::node const& one : *list) {
                begin_section(recipe, path);
                read_table(*one.as_table(), path + ".", name, recipe, faults);
            }
            continue;
        }
        Key const* const key = find_key(path);
        if (key == nullptr) {
            faults.push_back(fmt::format("line {}: {}", line, unknown_key(cut(path))));
            continue;
        }
        auto const value = value_of(node);
        try {
            if (!value) {
                throw BadParameter(fmt::format("its value has the wrong type; required: {}", key->help.type));
            }
            key->put(recipe, *value);
            recipe.set_at[with_number(path, recipe)] = fmt::format("{}, line {}", name, line);
        } catch (BadParameter const& fault) {
            faults.push_back(fmt::format("line {}: {}: {}", line, path, fault.what()));
        }
    }
}

constexpr char const* too_large = "an integer of a recipe is at most 9223372036854775807";

bool is_too_large(toml::parse_error const& fault) {
    return fault.description().find("decimal integer") != std::string_view::npos &&
           fault.description().find("not representable") != std::string_view::npos;
}

void require_integer_of_toml(toml::parse_error const& fault) {
    if (is_too_large(fault)) {
        throw BadParameter(too_large);
    }
}

} // namespace

Recipe default_recipe() {
    Recipe recipe;
    recipe.grid.width = 1024;
    recipe.grid.height = 1024;
    NetworkRecipe& network = recipe.network.emplace();
    network.prune_cells = 30.0;
    network.dla.particles = 100000;
    network.dla.sticking = 1.0;
    network.dla.visits = 1;
    network.branch = network::BranchChoice::south;
    recipe.surface.emplace().equilibrium.mean_slope_deg = 25.0;
    return recipe;
}

std::vector<KeyHelp> recipe_keys() {
    std::vector<KeyHelp> keys;
    for (Key const& key : all_keys()) {
        keys.push_back(key.help);
    }
    return keys;
}

Recipe read_recipe(std::string const& toml, std::string const& name) {
    // toml++ 3.3 recurses once a dotted part and level, also when it gives the memory back: sizes and depth are
    // measured before it sees the text.
    constexpr std::size_t most_bytes = 1 << 20;
    constexpr std::size_t longest_line = 8192;
    if (toml.size() > most_bytes) {
        throw BadParameter(fmt::format("pipeline.read_recipe: {}: a recipe has at most {} bytes, this has {}", name,
                                       most_bytes, toml.size()));
    }
    for (std::size_t begin = 0, line = 1; begin < toml.size(); ++line) {
        std::size_t const end = std::min(toml.find('\n', begin), toml.size());
        if (end - begin > longest_line) {
            throw BadParameter(
                fmt::format("pipeline.read_recipe: {}: line {} is longer than {} bytes", name, line, longest_line));
        }
        begin = end + 1;
    }
    constexpr std::size_t most_levels = 32;
    if (auto const line = line_deeper_than(toml, most_levels)) {
        throw BadParameter(
            fmt::format("pipeline.read_recipe: {}: line {}: keys, tables and arrays are nested more than {} "
                        "levels deep; no key of a recipe is",
                        name, *line, most_levels));
    }
    toml::table table;
    try {
        table = toml::parse(toml, name);
    } catch (toml::parse_error const& fault) {
        bool const is_large = is_too_large(fault);
        throw BadParameter(fmt::format("pipeline.read_recipe: {}: line {}, column {}: {}", name,
                                       fault.source().begin.line, fault.source().begin.column,
                                       is_large ? too_large : cut(fault.description())));
    }
    Recipe recipe;
    std::vector<std::string> faults;
    read_table(table, "", name, recipe, faults);
    if (!faults.empty()) {
        throw BadParameter(
            fmt::format("pipeline.read_recipe: {}: {}", name, fmt::join(faults, fmt::format("\n{}: ", name))));
    }
    return recipe;
}

namespace {

/// "patch.2.rotate" as "patch.rotate" and 2; anything else as it is, and 0.
std::pair<std::string, std::size_t> without_number(std::string const& path) {
    constexpr std::string_view begin = "patch.";
    std::size_t const dot = path.find('.', begin.size());
    std::size_t number = 0;
    if (dot != std::string::npos && dot < begin.size() + 4 && path.compare(0, begin.size(), begin) == 0) {
        auto const [end, error] = std::from_chars(path.data() + begin.size(), path.data() + dot, number);
        if (error == std::errc() && end == path.data() + dot && number > 0) {
            return {std::string(begin) + path.substr(dot + 1), number};
        }
    }
    return {path, 0};
}

/// A file's name as seen from the working folder, for a recipe that may lie elsewhere.
std::string from_here(Recipe const& recipe, std::string const& name) {
    bool const stays = recipe.folder.empty() || name.empty() || is_address(name);
    return stays ? name : std::filesystem::absolute(name).lexically_normal().string();
}

} // namespace

void set_key(Recipe& recipe, std::string const& assignment) {
    auto const equals = assignment.find('=');
    if (equals == std::string::npos || equals == 0) {
        throw BadParameter(fmt::format("--set {}: write section.key=value", cut(assignment)));
    }
    auto const [path, patch] = without_number(assignment.substr(0, equals));
    std::string const text = assignment.substr(equals + 1);
    Key const* const key = find_key(path);
    if (key == nullptr) {
        throw BadParameter(fmt::format("--set {}: {}", cut(assignment), unknown_key(cut(path))));
    }
    try {
        if (!is_utf8(text)) {
            throw BadParameter("the value is not UTF-8");
        }
        Value value = names_file(*key) ? from_here(recipe, text) : text;
        if (key->help.type != "text") {
            if (text.size() > 200) {
                throw BadParameter("the value is too long");
            }
            try {
                toml::table const table = toml::parse("v = " + text);
                value = value_of(*table.get("v")).value_or(Value(text));
            } catch (toml::parse_error const& fault) {
                require_integer_of_toml(fault);
                value = text; // not TOML: put says what is wanted instead
            }
        }
        if (patch == 0) {
            key->put(recipe, value);
        } else if (patch > recipe.patches.size() + 1) {
            throw BadParameter(fmt::format("the recipe has {} patches", recipe.patches.size()));
        } else {
            bool const is_new = patch > recipe.patches.size();
            Recipe one;
            one.patches.push_back(is_new ? PatchRecipe{} : recipe.patches[patch - 1]);
            key->put(one, value);
            recipe.patches.resize(std::max(recipe.patches.size(), patch));
            recipe.patches[patch - 1] = one.patches.front();
        }
        recipe.set_at[patch == 0 ? with_number(path, recipe) : assignment.substr(0, equals)] = "--set";
    } catch (BadParameter const& fault) {
        throw BadParameter(fmt::format("--set {}: {}", cut(assignment), fault.what()));
    }
}

namespace {

std::string keys_of_patch(PatchRecipe const& patch, Recipe const& recipe) {
    Recipe one;
    one.patches.push_back(patch);
    std::string out;
    for (Key const& key : all_keys()) {
        bool const is_written = key.section() == "patch" && key.use.holds(recipe);
        if (auto const value = is_written ? key.take(one) : std::nullopt) {
            out += fmt::format("{} = {}\n", key.name(), toml_text(*value));
        }
    }
    return out;
}

} // namespace

std::string write_recipe(Recipe const& recipe) {
    std::string out;
    std::string section;
    for (Key const& key : all_keys()) {
        auto const value = key.take(recipe);
        if (!value || !key.use.holds(recipe)) {
            continue;
        }
        bool const first = key.section() != section;
        section = key.section();
        if (section == "patch") {
            for (PatchRecipe const& patch : first ? recipe.patches : std::vector<PatchRecipe>{}) {
                out += "\n[[patch]]\n" + keys_of_patch(patch, recipe);
            }
            continue;
        }
        if (first) {
            out += fmt::format("{}[{}]\n", out.empty() ? "" : "\n", section);
        }
        out += fmt::format("{} = {}\n", key.name(), toml_text(*value));
    }
    return out;
}

std::string title_of(Recipe const& recipe) {
    return recipe.output.title.empty() ? fmt::format("thalweg, seed {}", recipe.seed) : recipe.output.title;
}

namespace {

/// What goes with a land in equilibrium only, and what does not.
void check_equilibrium(Recipe const& recipe, std::vector<std::string>& faults) {
    NetworkRecipe const& n = *recipe.network;
    bool const in_equilibrium = recipe.surface && recipe.surface->method == Method::equilibrium;
    if (!in_equilibrium) {
        char const* const needs = " needs surface.method = \"equilibrium\"";
        if (n.heights == Heights::soft || n.heights == Heights::fixed || n.heights == Heights::ends) {
            faults.push_back(fmt::format("network.heights = \"{}\"{}",
                                         n.heights == Heights::soft    ? "soft"
                                         : n.heights == Heights::fixed ? "fixed"
                                                                       : "ends",
                                         needs));
        }
        if (n.fill_space) {
            faults.push_back(fmt::format("network.fill_space{}: only equilibrium terrain grows side valleys", needs));
        }
        if (n.inland != InlandEnds::carry) {
            faults.push_back(
                fmt::format("network.inland = \"{}\"{}", n.inland == InlandEnds::sink ? "sink" : "coast", needs));
        }
        return;
    }
    if (n.inland == InlandEnds::coast && n.source != Source::lines) {
        faults.emplace_back(
            "network.inland = \"coast\" needs network.source = \"lines\"; rivers that grow from a coast "
            "are network.source = \"forest\"");
    }
    EquilibriumRecipe const& e = recipe.surface->equilibrium;
    double const usual_slope_deg = surface::EquilibriumParams{}.mean_slope_deg;
    if (n.concavity < 0.1 || n.concavity > 0.9) {
        faults.push_back(fmt::format("network.concavity = {}: equilibrium terrain needs 0.1 to 0.9", n.concavity));
    }
    if (e.mean_slope_deg.value_or(usual_slope_deg) != usual_slope_deg && recipe.surface->dilate.relief_m > 0.0) {
        faults.emplace_back("surface.relief and surface.mean_slope do not go together: one follows from the other");
    }
    if (!e.lakes.empty() && e.lake_share > 0.0) {
        faults.emplace_back(
            "surface.lakes and surface.lake_share do not go together: lakes come from a file or are chosen at random");
    }
    if (recipe.skeleton && (recipe.skeleton->ridges != Ridges::none || !recipe.skeleton->points.empty())) {
        faults.emplace_back("[skeleton] does not go with surface.method = \"equilibrium\": its ridges and heights "
                            "follow from the rivers");
    }
}

void check_forest(Recipe const& recipe, std::vector<std::string>& faults) {
    NetworkRecipe const& n = *recipe.network;
    ForestRecipe const& f = n.forest;
    if (n.source != Source::forest) {
        if (!(f.region.empty() && f.outlets.empty())) {
            faults.emplace_back("network.forest names a file but source is not \"forest\"");
        }
        return;
    }
    if (f.shape == LandShape::island && !f.region.empty()) {
        faults.emplace_back("network.forest.shape and region do not go together: the region is the land");
    }
    if (n.rotate_deg.value_or(0.0) != 0.0) {
        faults.emplace_back("network.rotate does not go with source = \"forest\": its rivers fill the land as it lies");
    }
}

void check_network(Recipe const& recipe, std::vector<std::string>& faults) {
    NetworkRecipe const& n = *recipe.network;
    if (n.source == Source::lines && n.lines.path.empty()) {
        faults.emplace_back("network.lines.path is missing: source = \"lines\" needs a file");
    }
    if (n.source != Source::lines && !n.lines.path.empty()) {
        faults.emplace_back("network.lines.path is given but source is not \"lines\"");
    }
    if (n.source != Source::tokunaga && !(n.tokunaga.strokes.empty() && n.tokunaga.region.empty())) {
        faults.emplace_back("network.tokunaga names a file but source is not \"tokunaga\"");
    }
    if (!n.tokunaga.strokes.empty() && !n.tokunaga.region.empty()) {
        faults.emplace_back("network.tokunaga.strokes and region do not go together: strokes fill the grid");
    }
    if ((n.source == Source::lines || n.source == Source::tokunaga) && n.rotate_deg.value_or(0.0) != 0.0) {
        faults.emplace_back("network.rotate turns a cluster: it needs source = \"dla\"");
    }
    if (n.source != Source::lines && n.heights == Heights::file) {
        faults.emplace_back("network.heights = \"file\" needs source = \"lines\"");
    }
    if (recipe.statistics) {
        faults.emplace_back("[statistics] and [network] do not go together: statistics would move the rivers");
    }
    if (recipe.detail && recipe.detail->method == DetailMethod::midpoint && !recipe.detail->midpoint.sigma) {
        faults.emplace_back("detail.sigma is missing: with rivers it cannot be estimated");
    }
    if (recipe.detail && !recipe.surface) {
        faults.emplace_back("[detail] needs [surface]");
    }
    if (recipe.surface && recipe.surface->method == Method::regress) {
        faults.emplace_back("surface.method = \"regress\" does not keep rivers: use tin or dilate");
    }
    check_forest(recipe, faults);
    check_equilibrium(recipe, faults);
}

void check_land(Recipe const& recipe, bool has_points, std::vector<std::string>& faults) {
    Method const method = recipe.surface ? recipe.surface->method : Method::tin;
    if (recipe.statistics && recipe.statistics->skeleton == Prior::points && !has_points) {
        faults.emplace_back("statistics.skeleton = \"points\" needs skeleton.points or skeleton.scatter");
    }
    if (recipe.statistics && recipe.statistics->skeleton != Prior::points && has_points) {
        faults.emplace_back("[skeleton] gives points: set statistics.skeleton = \"points\"");
    }
    if (!recipe.statistics && !has_points) {
        faults.emplace_back("the recipe describes no terrain: give [network], [statistics], skeleton.points or "
                            "skeleton.scatter");
    }
    bool const is_drawn =
        !recipe.statistics || recipe.statistics->skeleton == Prior::points || recipe.set_at.count("surface.method") > 0;
    if (is_drawn && (method == Method::dilate || method == Method::equilibrium) && recipe.surface) {
        faults.push_back(fmt::format("surface.method = \"{}\" needs [network]: use diffuse, tin or regress",
                                     method == Method::dilate ? "dilate" : "equilibrium"));
    }
    if (recipe.skeleton && recipe.skeleton->ridges != Ridges::none) {
        faults.emplace_back("skeleton.ridges lie between rivers: they need [network]");
    }
}

} // namespace

void check_recipe(Recipe const& recipe) {
    std::vector<std::string> faults;
    bool const has_points = recipe.skeleton && (!recipe.skeleton->points.empty() || recipe.skeleton->scatter > 0);
    if (recipe.network) {
        check_network(recipe, faults);
    } else {
        check_land(recipe, has_points, faults);
    }
    if (recipe.skeleton && !recipe.skeleton->points.empty() && recipe.skeleton->scatter > 0) {
        faults.emplace_back("skeleton.points and skeleton.scatter do not go together: points come from a file or are "
                            "drawn at random");
    }
    if (recipe.surface && recipe.surface->base == Base::tin && recipe.surface->method != Method::dilate) {
        faults.emplace_back("surface.base = \"tin\" goes with surface.method = \"dilate\"");
    }
    if (recipe.surface && recipe.surface->dilate.increment.function) {
        faults.emplace_back(
            "surface.increment is a function, which no recipe can hold: write it as an expression in x, "
            "or call surface::dilate with it");
    }
    for (std::size_t i = 0; i < recipe.patches.size(); ++i) {
        if (recipe.patches[i].source.empty()) {
            faults.push_back(fmt::format("patch {}: source is missing: name the relief to paste", i + 1));
        }
    }
    if (!recipe.patches.empty() && recipe.network && !recipe.surface) {
        faults.emplace_back("[[patch]] needs [surface]: there is no surface to paste into");
    }
    if ((recipe.grid.width > 0) != (recipe.grid.height > 0)) {
        faults.emplace_back("grid.width and grid.height go together: give both or neither");
    }
    bool const fills_a_frame =
        recipe.network && recipe.network->source == Source::forest && recipe.network->forest.region.empty();
    bool const framed =
        (recipe.network && !fills_a_frame) || (recipe.skeleton && !recipe.skeleton->points.empty() && !fills_a_frame);
    if (recipe.grid.width == 0 && !framed) {
        faults.emplace_back("grid.width and grid.height are missing: nothing else gives the size of the grid");
    }
    for (UnusedKey const& key : unused_keys(recipe)) {
        std::string const section = fmt::format("[{}]", key.path.substr(0, key.path.find('.')));
        bool const is_told = std::any_of(faults.begin(), faults.end(), [&](std::string const& fault) {
            return fault.find(key.path) != std::string::npos || fault.find(section) == 0;
        });
        if (!is_told) {
            faults.push_back(key.words);
        }
    }
    if (recipe.grid.width > 0 && recipe.grid.height > 0) {
        try {
            check_detail(recipe, recipe.grid.width, recipe.grid.height);
        } catch (BadParameter const& fault) {
            faults.emplace_back(fault.what());
        }
    }
    if (!faults.empty()) {
        throw BadParameter(fmt::format("pipeline.check_recipe: {}", fmt::join(faults, "\n")));
    }
}

} // namespace thalweg::pipeline
