// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <thalweg/core/run/messages.hpp>
#include <thalweg/pipeline/recipe/internal/key_rows.hpp>

namespace thalweg::pipeline {
namespace {

std::optional<Value> value_in(Recipe const& recipe, std::string const& path) {
    Key const* const key = find_key(path);
    return key == nullptr ? std::nullopt : key->take(recipe);
}

/// A value without the quotes of TOML.
std::string bare_text(Value const& value) {
    auto const* const word = std::get_if<std::string>(&value);
    return word != nullptr ? *word : toml_text(value);
}

std::string in_quotes(std::string const& word) {
    return word == "true" || word == "false" ? word : '"' + word + '"';
}

bool has_section(Recipe const& recipe, std::string const& name) {
    Section const* const section = find_section(name);
    return section != nullptr && section->count(recipe) > 0;
}

bool is_given(Recipe const& recipe, std::string const& path) {
    auto const value = value_in(recipe, path);
    return value && !bare_text(*value).empty();
}

/// A simple condition: what holds, and what the recipe has where it does not.
Use simple(std::string text, std::function<bool(Recipe const&)> holds,
           std::function<std::string(Recipe const&)> const& here) {
    Use use;
    use.lacks = [text, holds, here](Recipe const& recipe) {
        return holds(recipe) ? std::string() : text + here(recipe);
    };
    use.text = std::move(text);
    use.holds = std::move(holds);
    return use;
}

std::string nothing(Recipe const&) {
    return "";
}

std::string bracketed(Use const& use, Use::Kind kind) {
    return use.kind == kind ? "(" + use.text + ")" : use.text;
}

} // namespace

Use always() {
    return simple(
        "", [](Recipe const&) { return true; }, nothing);
}

Use with(std::string const& section) {
    return simple(
        fmt::format("[{}]", section), [section](Recipe const& r) { return has_section(r, section); }, nothing);
}

Use without(std::string const& section) {
    return simple(
        fmt::format("no [{}]", section), [section](Recipe const& r) { return !has_section(r, section); }, nothing);
}

Use is(std::string const& path, std::vector<std::string> const& words) {
    std::vector<std::string> listed;
    std::transform(words.begin(), words.end(), std::back_inserter(listed), in_quotes);
    return simple(
        fmt::format("{} = {}", path, fmt::join(listed, " or ")),
        [path, words](Recipe const& r) {
            auto const value = value_in(r, path);
            return value && std::find(words.begin(), words.end(), bare_text(*value)) != words.end();
        },
        [path](Recipe const& r) {
            auto const value = value_in(r, path);
            return value ? fmt::format(" (here it is {})", in_quotes(bare_text(*value))) : std::string();
        });
}

Use above(std::string const& path, double limit) {
    return simple(
        fmt::format("{} > {}", path, limit),
        [path, limit](Recipe const& r) {
            auto const value = value_in(r, path);
            if (auto const* const n = value ? std::get_if<std::int64_t>(&*value) : nullptr) {
                return static_cast<double>(*n) > limit;
            }
            auto const* const x = value ? std::get_if<double>(&*value) : nullptr;
            return x != nullptr && *x > limit;
        },
        nothing);
}

Use given(std::string const& path) {
    return simple(
        path, [path](Recipe const& r) { return is_given(r, path); }, nothing);
}

Use not_given(std::string const& path) {
    return simple(
        "no " + path, [path](Recipe const& r) { return !is_given(r, path); }, nothing);
}

Use when(std::string text, std::function<bool(Recipe const&)> holds) {
    return simple(std::move(text), std::move(holds), nothing);
}

Use operator&&(Use const& a, Use const& b) {
    if (a.text.empty() || b.text.empty()) {
        return a.text.empty() ? b : a;
    }
    Use use;
    use.kind = Use::Kind::both;
    use.text = bracketed(a, Use::Kind::either) + " and " + bracketed(b, Use::Kind::either);
    use.holds = [a, b](Recipe const& r) { return a.holds(r) && b.holds(r); };
    use.lacks = [a, b](Recipe const& r) {
        std::string const first = a.lacks(r);
        std::string const second = b.lacks(r);
        return first + (first.empty() || second.empty() ? "" : " and ") + second;
    };
    return use;
}

Use operator||(Use const& a, Use const& b) {
    Use use;
    use.kind = Use::Kind::either;
    use.text = bracketed(a, Use::Kind::both) + " or " + bracketed(b, Use::Kind::both);
    use.holds = [a, b](Recipe const& r) { return a.holds(r) || b.holds(r); };
    use.lacks = [a, b](Recipe const& r) {
        return a.holds(r) || b.holds(r) ? std::string() : a.lacks(r) + ", or " + b.lacks(r);
    };
    return use;
}

namespace {

/// Where a recipe holds the struct of a section.
template <class S> struct Holder {
    std::function<std::size_t(Recipe const&)> count;
    std::function<void(Recipe&)> begin;
    std::function<S&(Recipe&, std::size_t)> in;
    std::function<S const&(Recipe const&, std::size_t)> of;
    bool is_array = false;
};

void nothing_to_begin(Recipe&) {}

std::size_t always_one(Recipe const&) {
    return 1;
}

Holder<Recipe> the_recipe() {
    return {always_one, nothing_to_begin, [](Recipe& r, std::size_t) -> Recipe& { return r; },
            [](Recipe const& r, std::size_t) -> Recipe const& { return r; }};
}

template <class S> Holder<S> member(S Recipe::*part) {
    return {always_one, nothing_to_begin, [part](Recipe& r, std::size_t) -> S& { return r.*part; },
            [part](Recipe const& r, std::size_t) -> S const& { return r.*part; }};
}

/// A section that is named is a stage that runs, empty or not.
template <class S> Holder<S> member(std::optional<S> Recipe::*part) {
    return {[part](Recipe const& r) -> std::size_t { return (r.*part).has_value() ? 1 : 0; },
            [part](Recipe& r) {
                if (!(r.*part)) {
                    (r.*part).emplace();
                }
            },
            [part](Recipe& r, std::size_t) -> S& { return *(r.*part); },
            [part](Recipe const& r, std::size_t) -> S const& { return *(r.*part); }};
}

template <class S> Holder<S> member(std::vector<S> Recipe::*part) {
    return {[part](Recipe const& r) { return (r.*part).size(); }, [part](Recipe& r) { (r.*part).emplace_back(); },
            [part](Recipe& r, std::size_t item) -> S& { return (r.*part)[item]; },
            [part](Recipe const& r, std::size_t item) -> S const& { return (r.*part)[item]; }, true};
}

/// A section with its keys, before they know where it lies.
struct Chapter {
    Section section;
    std::vector<Key> keys;
};

template <class S> Chapter chapter(char const* name, Holder<S> const& holder, Rows<S> const& rows) {
    Chapter made{{name, holder.is_array, holder.count, holder.begin}, {}};
    for (KeyOf<S> const& row : rows) {
        Key& key = made.keys.emplace_back();
        key.help = row.help;
        key.help.path = fmt::format("{}{}{}", name, *name == '\0' ? "" : ".", row.help.path);
        key.help.used_by = row.use.text;
        key.use = row.use;
        key.earlier = row.earlier;
        key.folder = row.folder;
        key.range = row.range;
        key.check = row.check;
        key.store = [in = holder.in, store = row.store](Recipe& r, std::size_t item, Value const& v) {
            store(&in(r, item), v);
        };
        key.show = [of = holder.of, show = row.show](Recipe const& r, std::size_t item) { return show(&of(r, item)); };
        key.layer = [of = holder.of, layer = row.layer](Recipe const& r, std::size_t item) {
            return layer ? layer(&of(r, item)) : std::string();
        };
    }
    return made;
}

std::vector<Chapter> make_chapters() {
    return {chapter("", the_recipe(), seed_keys()),
            chapter("grid", member(&Recipe::grid), grid_keys()),
            chapter("network", member(&Recipe::network), network_keys()),
            chapter("skeleton", member(&Recipe::skeleton), skeleton_keys()),
            chapter("surface", member(&Recipe::surface), surface_keys()),
            chapter("statistics", member(&Recipe::statistics), statistics_keys()),
            chapter("detail", member(&Recipe::detail), detail_keys()),
            chapter("patch", member(&Recipe::patches), patch_keys()),
            chapter("output", member(&Recipe::output), output_keys())};
}

std::string standard_text(Value const& value) {
    auto const* const number = std::get_if<double>(&value); // for a reader: 0.087, not its 17 digits
    return number != nullptr ? fmt::format("{}", *number) : toml_text(value);
}

struct Table {
    std::vector<Section> sections;
    std::vector<Key> keys;
};

Table make_table() {
    Table table;
    std::vector<Chapter> const chapters = make_chapters();
    Recipe standard;
    for (Chapter const& one : chapters) {
        table.sections.push_back(one.section);
        one.section.begin(standard);
    }
    for (std::size_t i = 0; i < chapters.size(); ++i) {
        for (Key key : chapters[i].keys) {
            key.part = &table.sections[i];
            auto const value = key.take(standard);
            if (key.help.standard.empty() && value) {
                key.help.standard = standard_text(*value);
            }
            table.keys.push_back(std::move(key));
        }
    }
    return table;
}

Table const& the_table() {
    static Table const table = make_table();
    return table;
}

} // namespace

void Key::put(Recipe& recipe, Value const& value, std::optional<std::size_t> item) const {
    check(value);
    std::size_t const count = part->count(recipe);
    if (count == 0 || item == count) {
        part->begin(recipe);
    }
    store(recipe, item.value_or(part->count(recipe) - 1), value);
}

std::optional<Value> Key::take(Recipe const& recipe, std::optional<std::size_t> item) const {
    std::size_t const count = part->count(recipe);
    return count == 0 ? std::nullopt : show(recipe, item.value_or(count - 1));
}

std::string Key::place(std::size_t item) const {
    return part->is_array ? fmt::format("{}.{}.{}", part->name, item + 1, name()) : help.path;
}

std::string Key::section() const {
    auto const dot = help.path.rfind('.');
    return dot == std::string::npos ? "" : help.path.substr(0, dot);
}

std::string Key::name() const {
    return help.path.substr(help.path.rfind('.') + 1);
}

Recipe with_all_sections() {
    Recipe recipe;
    for (Section const& section : all_sections()) {
        section.begin(recipe);
    }
    return recipe;
}

std::vector<Section> const& all_sections() {
    return the_table().sections;
}

std::vector<Key> const& all_keys() {
    return the_table().keys;
}

Section const* find_section(std::string const& name) {
    auto const& sections = all_sections();
    auto const at = std::find_if(sections.begin(), sections.end(), [&](Section const& s) { return s.name == name; });
    return at == sections.end() ? nullptr : &*at;
}

Key const* find_key(std::string const& path) {
    auto const& keys = all_keys();
    auto const at = std::find_if(keys.begin(), keys.end(), [&](Key const& k) { return k.help.path == path; });
    return at == keys.end() ? nullptr : &*at;
}

std::string unknown_key(std::string const& path) {
    std::vector<std::string> paths;
    for (Key const& key : all_keys()) {
        paths.push_back(key.help.path);
    }
    std::string near = closest(path, paths);
    if (near.empty()) { // the right word in the wrong section
        std::string const word = path.substr(path.rfind('.') + 1);
        auto const at =
            std::find_if(all_keys().begin(), all_keys().end(), [&](Key const& k) { return k.name() == word; });
        near = at == all_keys().end() ? "" : at->help.path;
    }
    return fmt::format("unknown key '{}'.{} `thalweg recipe` lists every key.", path,
                       near.empty() ? "" : " Did you mean '" + near + "'?");
}

std::vector<KeyHelp> recipe_keys() {
    std::vector<KeyHelp> keys;
    for (Key const& key : all_keys()) {
        keys.push_back(key.help);
    }
    return keys;
}

} // namespace thalweg::pipeline
