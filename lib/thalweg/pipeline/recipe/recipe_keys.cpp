// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <algorithm>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <thalweg/core/run/messages.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_keys.hpp>

namespace thalweg::pipeline {
namespace {

/// The shortest text that reads back as the same number, and as one with a fraction.
std::string text_of(double x) {
    std::string text = fmt::format("{}", x);
    return text.find_first_not_of("-0123456789") == std::string::npos ? text + ".0" : text;
}

std::string text_of(bool b) {
    return b ? "true" : "false";
}

std::string text_of(std::int64_t i) {
    return fmt::format("{}", i);
}

std::string text_of(std::string const& s) {
    std::ostringstream out;
    out << toml::value<std::string>(s);
    return out.str();
}

template <std::size_t N> std::string text_of(std::array<double, N> const& list) {
    std::string out;
    for (double const x : list) {
        out += (out.empty() ? "" : ", ") + text_of(x);
    }
    return "[ " + out + " ]";
}

} // namespace

std::string toml_text(Value const& value) {
    return std::visit([](auto const& v) { return text_of(v); }, value);
}

std::string Range::text() const {
    if (most >= endless) {
        return fmt::format("{} {}", open ? ">" : ">=", least);
    }
    return fmt::format("{}{}, {}]", open ? "(" : "[", least, most);
}

namespace {

/// Throws BadParameter: what is wanted, not the value.
[[noreturn]] void refuse_value(std::string const& wanted, Value const& v) {
    throw BadParameter(fmt::format("{} is required, not {}", wanted, toml_text(v)));
}

template <class T> T const& required(std::string const& wanted, Value const& v) {
    T const* const held = std::get_if<T>(&v);
    if (held == nullptr) {
        refuse_value(wanted, v);
    }
    return *held;
}

void require_in(Range const& range, double v) {
    refuse_if<BadParameter>(!range.holds(v), "{} is outside its range {}", v, range.text());
}

std::vector<std::string> choice_words(std::vector<Choice> const& choices) {
    std::vector<std::string> words;
    for (auto const& [word, number] : choices) {
        words.push_back(word);
    }
    return words;
}

/// The value that a word stands for in a recipe: of a key of integers or words "16" is an integer.
Value value_of_word(Key const& key, std::string const& word) {
    bool const is_integer =
        key.row->kind == KeyKind::integer_or_word && word.find_first_not_of("0123456789") == std::string::npos;
    return is_integer ? Value(std::int64_t{std::stoi(word)}) : Value(word);
}

Choice const& choice_of(Key const& key, Value const& v) {
    bool const is_text = std::holds_alternative<std::string>(v);
    if (key.row->kind == KeyKind::word && !is_text) {
        refuse_value("a text in quotes", v);
    }
    for (Choice const& one : key.choices) {
        if (value_of_word(key, one.first) == v) {
            return one;
        }
    }
    std::vector<std::string> const words = choice_words(key.choices);
    throw BadParameter(fmt::format("{} is not one of its values.{} ({})", toml_text(v),
                                   is_text ? did_you_mean(std::get<std::string>(v), words) : "",
                                   fmt::join(words, ", ")));
}

/// The value as a key of this kind holds it. Throws BadParameter for one that the key may not have.
Value checked(Key const& key, Value const& v) {
    Allowed const& allowed = key.row->allowed;
    switch (key.row->kind) {
    case KeyKind::yes_no: return required<bool>("true or false", v);
    case KeyKind::integer: {
        std::int64_t const x = required<std::int64_t>("an integer", v);
        require_in(allowed.range, static_cast<double>(x));
        return x;
    }
    case KeyKind::number: {
        auto const* const whole = std::get_if<std::int64_t>(&v);
        double const x = whole != nullptr ? static_cast<double>(*whole) : required<double>("a number", v);
        require_in(allowed.range, x);
        return x;
    }
    case KeyKind::text:
    case KeyKind::file: {
        std::string const& s = required<std::string>("a text in quotes", v);
        refuse_if<BadParameter>(s.size() > 4096 || s.find('\0') != std::string::npos,
                                "the text is too long or holds a null byte");
        break;
    }
    case KeyKind::word:
    case KeyKind::integer_or_word: choice_of(key, v); break;
    case KeyKind::pair:
    case KeyKind::triple:
    case KeyKind::quad: break;
    }
    if (allowed.fits != nullptr && !allowed.fits(v)) {
        refuse_value(allowed.form, v);
    }
    return v;
}

/// The type of Value that a field's values are.
template <class T> struct HeldAs {
    using Type = std::conditional_t<std::is_integral_v<T> && !std::is_same_v<T, bool>, std::int64_t, T>;
};
template <class T> struct HeldAs<std::optional<T>> {
    using Type = T;
};

/// Puts a checked value into the field of its key.
struct Store {
    Key const& key;
    Value const& value;

    template <class T> void operator()(T* field) const {
        *field = static_cast<T>(std::get<typename HeldAs<T>::Type>(value));
    }
    void operator()(Enumeration const& field) const { field.set(field.at, choice_of(key, value).second); }
};

/// Takes it out; nothing where it is left out.
struct Show {
    Key const& key;

    template <class T> std::optional<Value> operator()(T const* field) const {
        return static_cast<typename HeldAs<T>::Type>(*field);
    }
    template <class T> std::optional<Value> operator()(std::optional<T> const* field) const {
        return *field ? std::optional<Value>(**field) : std::nullopt;
    }
    std::optional<Value> operator()(Enumeration const& field) const {
        int const number = field.get(field.at);
        auto const at = std::find_if(key.choices.begin(), key.choices.end(),
                                     [&](Choice const& one) { return one.second == number; });
        return at == key.choices.end() ? std::nullopt : std::optional<Value>(value_of_word(key, at->first));
    }
};

std::size_t always_one(Recipe const&) {
    return 1;
}

void nothing_to_begin(Recipe&) {}

template <auto part> std::size_t count_of(Recipe const& recipe) {
    return (recipe.*part).has_value() ? 1 : 0;
}

/// A section that is named is a stage that runs, empty or not.
template <auto part> void begin_one(Recipe& recipe) {
    if (!(recipe.*part)) {
        (recipe.*part).emplace();
    }
}

constexpr std::array<Section, 9> sections = {
    {{"", always_one, nothing_to_begin},
     {"grid", always_one, nothing_to_begin},
     {"network", count_of<&Recipe::network>, begin_one<&Recipe::network>},
     {"skeleton", count_of<&Recipe::skeleton>, begin_one<&Recipe::skeleton>},
     {"surface", count_of<&Recipe::surface>, begin_one<&Recipe::surface>},
     {"statistics", count_of<&Recipe::statistics>, begin_one<&Recipe::statistics>},
     {"detail", count_of<&Recipe::detail>, begin_one<&Recipe::detail>},
     {"patch", [](Recipe const& r) { return r.patches.size(); }, [](Recipe& r) { r.patches.emplace_back(); }, true},
     {"output", always_one, nothing_to_begin}}};

char const* type_of(KeyKind kind) {
    switch (kind) {
    case KeyKind::yes_no: return "yes/no";
    case KeyKind::integer: return "integer";
    case KeyKind::number: return "number";
    case KeyKind::pair: return "two numbers";
    case KeyKind::triple: return "three numbers";
    case KeyKind::quad: return "four numbers";
    case KeyKind::integer_or_word: return "integer or text";
    case KeyKind::text:
    case KeyKind::file:
    case KeyKind::word: break;
    }
    return "text";
}

std::vector<Choice> choices_of(Row const& row) {
    if (row.kind == KeyKind::yes_no) {
        return {{"true", 1}, {"false", 0}};
    }
    std::vector<Choice> choices = row.allowed.listed == nullptr ? std::vector<Choice>() : row.allowed.listed();
    for (Word const& word : row.allowed.words) {
        if (word.text != nullptr) {
            choices.emplace_back(word.text, word.number);
        }
    }
    return choices;
}

/// What is allowed, for people.
std::string range_text(Key const& key) {
    if (key.range) {
        return key.range->text();
    }
    if (key.help.is_file) {
        return "file name";
    }
    std::vector<std::string> ways = key.help.choices;
    if (*key.row->allowed.form != '\0') {
        ways.emplace_back(key.row->allowed.form);
    }
    return fmt::format("{}", fmt::join(ways, " | "));
}

std::string standard_text(Value const& value) {
    auto const* const number = std::get_if<double>(&value); // for a reader: 0.087, not its 17 digits
    return number != nullptr ? fmt::format("{}", *number) : toml_text(value);
}

Key make_key(Row const& row, Recipe const& standard) {
    std::string_view const path = row.path;
    auto const dot = path.find('.');
    Key key;
    key.row = &row;
    key.part = find_section(dot == std::string_view::npos ? "" : path.substr(0, dot));
    key.choices = choices_of(row);
    key.use = read_use(row.used);
    key.use.test = row.extra.holds;
    if (row.kind == KeyKind::integer || row.kind == KeyKind::number) {
        key.range = row.allowed.range;
    }
    key.help = {row.path,
                type_of(row.kind),
                "",
                row.unit,
                row.extra.standard,
                row.meaning,
                choice_words(key.choices),
                key.use.text,
                row.kind == KeyKind::file};
    key.help.range = range_text(key);
    key.folder = row.extra.folder != nullptr ? row.extra.folder : key.name() + "/";
    auto const value = key.take(standard);
    if (key.help.standard.empty() && value) {
        key.help.standard = standard_text(*value);
    }
    return key;
}

std::vector<Key> make_keys() {
    Recipe const standard = with_all_sections();
    std::vector<Key> keys;
    for (Row const& row : recipe_rows()) {
        keys.push_back(make_key(row, standard));
    }
    return keys;
}

} // namespace

void Key::put(Recipe& recipe, Value const& value, std::optional<Item> item) const {
    Value const held = checked(*this, value);
    std::size_t const count = part->count(recipe);
    if (count == 0 || item == count) {
        part->begin(recipe);
    }
    std::visit(Store{*this, held}, row->field(recipe, item.value_or(part->count(recipe) - 1)));
}

std::optional<Value> Key::take(Recipe const& recipe, std::optional<Item> item) const {
    std::size_t const count = part->count(recipe);
    if (count == 0) {
        return std::nullopt;
    }
    auto const value = std::visit(Show{*this}, row->field(const_cast<Recipe&>(recipe), item.value_or(count - 1)));
    return row->extra.left_out_at_zero && value == Value(std::int64_t{0}) ? std::nullopt : value;
}

std::string Key::place(Item item) const {
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
    for (Section const& section : sections) {
        section.begin(recipe);
    }
    return recipe;
}

std::span<Section const> all_sections() {
    return sections;
}

std::vector<Key> const& all_keys() {
    static std::vector<Key> const keys = make_keys();
    return keys;
}

Section const* find_section(std::string_view name) {
    auto const* const at =
        std::find_if(sections.begin(), sections.end(), [&](Section const& s) { return s.name == name; });
    return at == sections.end() ? nullptr : at;
}

Key const* find_key(std::string_view path) {
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
