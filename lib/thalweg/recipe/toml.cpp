// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <charconv>
#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <thalweg/core/run/messages.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/recipe/check_recipe.hpp>
#include <thalweg/recipe/condition.hpp>
#include <thalweg/recipe/recipe_files.hpp>
#include <thalweg/recipe/recipe_keys.hpp>

namespace thalweg::recipe {
namespace {

/// What follows a string that begins at a place: "basic", 'literal', or of several lines with three of either.
std::size_t end_of_string(std::string_view text, std::size_t begin) {
    char const quote = text[begin];
    bool const is_long = text.substr(begin, 3) == std::string_view(quote == '"' ? R"(""")" : "'''");
    std::size_t const quotes = is_long ? 3 : 1;
    for (std::size_t at = begin + quotes; at < text.size(); ++at) {
        if (text[at] == '\\' && quote == '"') {
            ++at;
        } else if (text[at] == '\n' && !is_long) {
            return at; // no TOML
        } else if (text[at] == quote && (!is_long || text.substr(at, 3) == text.substr(begin, 3))) {
            return at + quotes;
        }
    }
    return text.size();
}

/// How deep the scanner stands.
class Levels {
public:
    void dot() { ++dots_; }
    /// Another key or value beside the last.
    void next() { dots_ = 0; }
    void open() {
        open_.push_back(dots_);
        below_ += dots_ + 1;
        dots_ = 0;
    }
    void close() {
        if (!open_.empty()) {
            dots_ = open_.back();
            below_ -= dots_ + 1;
            open_.pop_back();
        }
    }
    /// What follows stands in a section of so many levels.
    void begin_section(std::size_t levels) { section_ = levels; }
    bool is_outermost() const { return open_.empty(); }
    std::size_t dots() const { return dots_; }
    std::size_t count() const { return section_ + below_ + dots_ + 1; }

private:
    std::vector<std::size_t> open_; // the dots before each bracket that is open
    std::size_t section_ = 0;
    std::size_t below_ = 0;
    std::size_t dots_ = 0;
};

std::optional<Value> value_of_array(toml::array const& array) {
    if (!array.empty() && array.is_homogeneous<std::string>()) {
        WordList words;
        for (toml::node const& one : array) {
            words.push_back(one.value_or(std::string()));
        }
        return words;
    }
    std::vector<double> list;
    for (toml::node const& one : array) {
        if (auto const x = one.value<double>()) {
            list.push_back(*x);
        }
    }
    if (list.size() != array.size()) {
        return std::nullopt;
    }
    switch (list.size()) {
    case 2: return Pair{list[0], list[1]};
    case 3: return Triple{list[0], list[1], list[2]};
    case 4: return Quad{list[0], list[1], list[2], list[3]};
    default: return std::nullopt;
    }
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
    auto const* a = node.as_array();
    return a == nullptr ? std::nullopt : value_of_array(*a);
}

constexpr char const* too_large = "an integer of a recipe is at most 9223372036854775807";

bool is_too_large(toml::parse_error const& fault) {
    return fault.description().find("decimal integer") != std::string_view::npos &&
           fault.description().find("not representable") != std::string_view::npos;
}

// toml++ 3.3 recurses once a dotted part and level, also when it gives the memory back: sizes and depth are measured
// before it sees the text.
void require_modest(std::string const& toml, std::string const& name) {
    constexpr std::size_t most_bytes = 1 << 20;
    constexpr std::size_t longest_line = 8192;
    refuse_if<BadParameter>(toml.size() > most_bytes, "recipe.read_recipe",
                            "{}: a recipe has at most {} bytes, this has {}", name, most_bytes, toml.size());
    for (std::size_t begin = 0, line = 1; begin < toml.size(); ++line) {
        std::size_t const end = std::min(toml.find('\n', begin), toml.size());
        refuse_if<BadParameter>(end - begin > longest_line, "recipe.read_recipe", "{}: line {} is longer than {} bytes",
                                name, line, longest_line);
        begin = end + 1;
    }
    constexpr std::size_t most_levels = 32;
    if (auto const line = line_deeper_than(toml, most_levels)) {
        throw BadParameter(
            "recipe.read_recipe",
            fmt::format(
                "{}: line {}: keys, tables and arrays are nested more than {} levels deep; no key of a recipe is", name,
                *line, most_levels));
    }
}

// A word of a file as a message shows it: its beginning, where it is long.
std::string cut(std::string_view s) {
    return s.size() <= 80 ? std::string(s) : std::string(s.substr(0, 77)) + "...";
}

// Throws BadParameter when the text is not TOML, or is larger or deeper than a recipe may be.
toml::table parse_modest(std::string const& toml, std::string const& name) {
    require_modest(toml, name);
    try {
        return toml::parse(toml, name);
    } catch (toml::parse_error const& fault) {
        throw BadParameter("recipe.read_recipe",
                           fmt::format("{}: line {}, column {}: {}", name, fault.source().begin.line,
                                       fault.source().begin.column,
                                       is_too_large(fault) ? too_large : cut(fault.description())));
    }
}

// What a text means as a value of TOML; the text itself where it is none. Throws BadParameter for an integer
// that TOML does not have.
Value value_in_toml(std::string const& text) {
    try {
        toml::table const table = toml::parse("v = " + text);
        return value_of(*table.get("v")).value_or(Value(text));
    } catch (toml::parse_error const& fault) {
        if (is_too_large(fault)) {
            throw BadParameter("recipe.set_key", too_large);
        }
        return text; // the key says what is wanted instead
    }
}

/// Leaves the size of cells to the DEM of surface.source where no key gives it.
void settle_cell(Recipe& recipe) {
    bool const of_lines = from_lines(recipe);
    if (recipe.set_at.contains("grid.cell")) {
        return;
    }
    if (on_raster(recipe)) {
        recipe.grid.cell_m = 0.0;
    } else if (recipe.grid.cell_m == 0.0 && !of_lines) {
        recipe.grid.cell_m = GridRecipe{}.cell_m;
    }
}

/// Lets what nobody asked for give way to a file: uplift by pattern to a raster of uplift, lakes by share to polygons.
void settle_built_in(Recipe& recipe) {
    if (!recipe.surface) {
        return;
    }
    EquilibriumRecipe& land = recipe.surface->equilibrium;
    if (!land.uplift.empty() && !recipe.set_at.contains("surface.uplift_pattern")) {
        land.uplift_pattern = EquilibriumRecipe{}.uplift_pattern;
    }
    if (!land.lakes.empty() && !recipe.set_at.contains("surface.lake_share")) {
        land.lake_share = EquilibriumRecipe{}.lake_share;
    }
}

constexpr std::size_t most_faults = 20;

/// Whether keys stand in brackets of this path or below it.
bool has_keys(std::string const& path) {
    return std::any_of(all_keys().begin(), all_keys().end(),
                       [&](Key const& key) { return (key.section() + ".").starts_with(path + "."); });
}

/// The section that brackets of this path belong to, or nullptr.
Section const* section_of(std::string const& path) {
    return has_keys(path) ? find_section(path.substr(0, path.find('.'))) : nullptr;
}

/// Puts what a file holds into a recipe and collects what is wrong with it.
class Reader {
public:
    explicit Reader(std::string name) : name_(std::move(name)) {}

    Recipe read(toml::table const& table) {
        read(table, "");
        if (!faults_.empty()) {
            throw BadParameter("recipe.read_recipe",
                               fmt::format("{}: {}", name_, fmt::join(faults_, fmt::format("\n{}: ", name_))));
        }
        settle_cell(recipe_);
        return recipe_;
    }

private:
    /// Its depth is bounded, see require_modest.
    void read(toml::table const& table, std::string const& prefix) {
        for (auto const& [word, node] : table) {
            std::string const path = prefix + std::string(word.str());
            Section const* const section = section_of(path);
            auto const* const list = node.as_array();
            bool const is_array = section != nullptr && section->is_array && section->name == path;
            if (faults_.size() >= most_faults) {
                return;
            }
            if (is_array && list != nullptr && list->is_homogeneous<toml::table>()) {
                for (toml::node const& one : *list) {
                    begin(*section, *one.as_table(), path);
                }
            } else if (auto const* const inner = node.as_table(); inner == nullptr) {
                put(path, node);
            } else if (section != nullptr) {
                begin(*section, *inner, path);
            } else {
                refuse(node, unknown_key(cut(path)));
            }
        }
    }

    void begin(Section const& section, toml::table const& table, std::string const& path) {
        section.begin(recipe_);
        read(table, path + ".");
    }

    void put(std::string const& path, toml::node const& node) {
        Key const* const key = find_key(path);
        if (key == nullptr) {
            refuse(node, unknown_key(cut(path)));
            return;
        }
        try {
            auto const value = value_of(node);
            refuse_if<BadParameter>(!value, "recipe.read_recipe", "its value has the wrong type; required: {}",
                                    key->help.type);
            key->put(recipe_, *value);
            recipe_.set_at[key->place(key->part->count(recipe_) - 1)] =
                fmt::format("{}, line {}", name_, line_of(node));
        } catch (BadParameter const& fault) {
            refuse(node, fmt::format("{}: {}", path, fault.what()));
        }
    }

    void refuse(toml::node const& node, std::string const& words) {
        faults_.push_back(fmt::format("line {}: {}", line_of(node), words));
    }

    static std::int64_t line_of(toml::node const& node) { return node.source().begin.line; }

    std::string name_;
    Recipe recipe_;
    std::vector<std::string> faults_;
};

/// What an assignment names: "patch.2.rotate" is patch.rotate of item 1.
struct Target {
    std::string path;
    std::optional<std::size_t> item;
};

Target target_of(std::string const& path) {
    constexpr std::size_t most_digits = 3;
    std::size_t const begin = path.find('.') + 1;
    std::size_t const dot = path.find('.', begin);
    Section const* const section = begin == 0 ? nullptr : find_section(path.substr(0, begin - 1));
    if (section == nullptr || !section->is_array || dot == std::string::npos || dot - begin > most_digits) {
        return {path, std::nullopt};
    }
    std::size_t number = 0;
    auto const [end, error] = std::from_chars(path.data() + begin, path.data() + dot, number);
    bool const is_number = error == std::errc() && end == path.data() + dot && number > 0;
    return is_number ? Target{path.substr(0, begin) + path.substr(dot + 1), number - 1} : Target{path, std::nullopt};
}

/// A file's name as seen from the working folder, for a recipe that may lie elsewhere.
std::string from_here(Recipe const& recipe, std::string const& name) {
    bool const stays = recipe.folder.empty() || name.empty() || is_address(name);
    return stays ? name : std::filesystem::absolute(name).lexically_normal().string();
}

/// What a text without quotes means to a key.
Value value_for(Key const& key, Recipe const& recipe, std::string const& text) {
    constexpr std::size_t longest = 200;
    refuse_if<BadParameter>(!is_utf8(text), "recipe.set_key", "the value is not UTF-8");
    if (key.help.type == "text") {
        return key.help.is_file ? from_here(recipe, text) : text;
    }
    refuse_if<BadParameter>(text.size() > longest, "recipe.set_key", "the value is too long");
    return value_in_toml(text);
}

void assign(Recipe& recipe, Key const& key, std::optional<std::size_t> item, std::string const& text) {
    Value const value = value_for(key, recipe, text);
    std::size_t const count = key.part->count(recipe);
    refuse_if<BadParameter>(item && *item > count, "recipe.set_key", "the recipe has {} [[{}]]", count, key.part->name);
    key.put(recipe, value, item);
    recipe.set_at[key.place(item.value_or(key.part->count(recipe) - 1))] = "--set";
}

Key const& key_at(Target const& target, char const* where) {
    Key const* const key = find_key(target.path);
    if (key == nullptr) {
        throw BadParameter(where, unknown_key(cut(target.path)));
    }
    return *key;
}

void remove_section(Recipe& recipe, Section const& section, std::optional<std::size_t> item) {
    std::size_t const count = section.count(recipe);
    refuse_if<BadParameter>(section.remove == nullptr, "recipe.unset_key", "[{}] is part of every recipe",
                            section.name);
    refuse_if<BadParameter>(count == 0 || item.value_or(0) >= count, "recipe.unset_key", "the recipe has no such [{}]",
                            section.name);
    section.remove(recipe, item.value_or(count - 1));
    std::erase_if(recipe.set_at,
                  [&](auto const& at) { return at.first.starts_with(fmt::format("{}.", section.name)); });
}

/// A section, or one item of an array: its keys that have an effect.
std::string toml_of(Section const& section, std::size_t item, Recipe const& recipe) {
    std::string out;
    std::string brackets;
    for (Key const& key : all_keys()) {
        auto const value = key.part == &section && key.use(recipe) ? key.take(recipe, item) : std::optional<Value>();
        if (!value) {
            continue;
        }
        if (key.section() != brackets) {
            brackets = key.section();
            out += section.is_array ? fmt::format("\n[[{}]]\n", brackets) : fmt::format("\n[{}]\n", brackets);
        }
        out += fmt::format("{} = {}\n", key.name(), toml_text(*value));
    }
    return out;
}

} // namespace

std::optional<std::size_t> line_deeper_than(std::string_view toml, std::size_t most_levels) {
    Levels levels;
    std::size_t line = 1;
    bool begins_line = true; // nothing but spaces so far
    bool is_header = false;
    std::size_t deepest_dots = 0;
    for (std::size_t at = 0; at < toml.size(); ++at) {
        char const c = toml[at];
        if (c == '\n') {
            if (is_header) {
                levels = Levels();
                levels.begin_section(deepest_dots + 1);
                is_header = false;
            }
            if (levels.is_outermost()) {
                levels.next();
            }
            ++line;
            begins_line = true;
            continue;
        }
        if (c == '#') {
            at = std::min(toml.find('\n', at), toml.size()) - 1;
            continue;
        }
        if (c == '"' || c == '\'') {
            std::size_t const end = end_of_string(toml, at);
            line += static_cast<std::size_t>(std::count(toml.begin() + static_cast<std::ptrdiff_t>(at),
                                                        toml.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
            at = end - 1;
        } else if (c == '[' || c == '{') {
            if (begins_line && c == '[' && levels.is_outermost()) {
                is_header = true;
                deepest_dots = 0;
                levels.begin_section(0);
            }
            levels.open();
        } else if (c == ']' || c == '}') {
            deepest_dots = std::max(deepest_dots, levels.dots());
            levels.close();
        } else if (c == '.') {
            levels.dot();
        } else if (c == ',') {
            levels.next();
        }
        begins_line = begins_line && (c == ' ' || c == '\t' || c == '\r');
        if (levels.count() > most_levels) {
            return line;
        }
    }
    return std::nullopt;
}

Recipe read_recipe(std::string const& toml, std::string const& name) {
    return Reader(name).read(parse_modest(toml, name));
}

void set_key(Recipe& recipe, std::string const& path, std::string const& text) {
    Target const target = target_of(path);
    assign(recipe, key_at(target, "recipe.set_key"), target.item, text);
    settle_cell(recipe);
    settle_built_in(recipe);
}

void set_key(Recipe& recipe, std::string const& assignment) {
    auto const equals = assignment.find('=');
    if (equals == std::string::npos || equals == 0) {
        throw BadParameter("recipe.set_key", fmt::format("--set {}: write section.key=value", cut(assignment)));
    }
    try {
        set_key(recipe, assignment.substr(0, equals), assignment.substr(equals + 1));
    } catch (BadParameter const& fault) {
        throw BadParameter(fault.where(), fmt::format("--set {}: {}", cut(assignment), fault.what()));
    }
}

void unset_key(Recipe& recipe, std::string const& path) {
    Target const whole = target_of(path + "."); // "patch.2." is "patch." of item 1
    if (Section const* const section = find_section(whole.path.substr(0, whole.path.size() - 1));
        section != nullptr && !section->name.empty()) {
        remove_section(recipe, *section, whole.item);
        settle_cell(recipe);
        return;
    }
    Target const of_key = target_of(path);
    Key const& key = key_at(of_key, "recipe.unset_key");
    std::size_t const count = key.part->count(recipe);
    std::size_t const item = of_key.item.value_or(count - 1);
    refuse_if<BadParameter>(count == 0 || item >= count, "recipe.unset_key", "{}: the recipe has no such section",
                            cut(path));
    key.reset(recipe, item);
    recipe.set_at.erase(key.place(item));
    settle_cell(recipe);
}

void require_effect(Recipe const& recipe, std::string const& path) {
    Target const target = target_of(path);
    Key const& key = key_at(target, "recipe.require_effect");
    refuse_if<BadParameter>(!key.use(recipe), "recipe.require_effect", "{} has no effect in this recipe: it needs {}",
                            cut(path), key.use.lacks(recipe));
}

std::vector<KeyValue> key_values(Recipe const& recipe) {
    std::vector<KeyValue> values;
    for (Section const& section : all_sections()) {
        for (std::size_t item = 0; item < section.count(recipe); ++item) {
            for (Key const& key : all_keys()) {
                if (key.part != &section || !key.use(recipe)) {
                    continue;
                }
                auto const value = key.take(recipe, item);
                auto const* const words = value ? std::get_if<std::string>(&*value) : nullptr;
                std::optional<std::string> text;
                if (value) {
                    text = words != nullptr ? *words : toml_text(*value);
                }
                values.push_back({key.place(item), std::move(text)});
            }
        }
    }
    return values;
}

std::string write_recipe(Recipe const& recipe) {
    std::string out;
    for (Section const& section : all_sections()) {
        std::size_t const count = section.count(recipe);
        for (std::size_t item = 0; item < count; ++item) {
            out += toml_of(section, item, recipe);
        }
    }
    return out;
}

} // namespace thalweg::recipe
