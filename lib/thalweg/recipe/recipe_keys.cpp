// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <algorithm>
#include <set>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <thalweg/core/run/messages.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/recipe/recipe_keys.hpp>

namespace thalweg::recipe {
namespace {

/// The shortest text that reads back as the same number, and as one with a fraction.
std::string text_of(double x) {
    std::string text = fmt::format("{}", x);
    return text.find_first_not_of("-0123456789") == std::string::npos ? text + ".0" : text;
}

std::string text_of(std::string const& s) {
    std::ostringstream out;
    out << toml::value<std::string>(s);
    return out.str();
}

template <std::size_t n> std::string text_of(std::array<double, n> const& list) {
    std::string out;
    for (double const x : list) {
        out += (out.empty() ? "" : ", ") + text_of(x);
    }
    return "[ " + out + " ]";
}

std::string text_of(WordList const& words) {
    std::string out;
    for (std::string const& word : words) {
        out += (out.empty() ? "" : ", ") + text_of(word);
    }
    return "[ " + out + " ]";
}

template <class T> std::string text_of(T whole_or_yes_no) {
    return fmt::format("{}", whole_or_yes_no);
}

/// Throws BadParameter: what is wanted, not the value.
[[noreturn]] void refuse_value(std::string const& wanted, Value const& v) {
    throw BadParameter("recipe.set_key", fmt::format("{} is required, not {}", wanted, toml_text(v)));
}

template <class T> T const& required(char const* wanted, Value const& v) {
    T const* const held = std::get_if<T>(&v);
    if (held == nullptr) {
        refuse_value(wanted, v);
    }
    return *held;
}

/// What a word is in a recipe: of a key of integers or words "16" is an integer.
Value value_of_word(Key const& key, std::string const& word) {
    bool const is_integer =
        key.row->kind == KeyKind::integer_or_word && word.find_first_not_of("0123456789") == std::string::npos;
    return is_integer ? Value(std::int64_t{std::stoi(word)}) : Value(word);
}

/// The enumerator that a value stands for, as a number.
int number_for(Key const& key, Value const& v) {
    bool const is_text = std::holds_alternative<std::string>(v);
    if (key.row->kind == KeyKind::word && !is_text) {
        refuse_value("a text in quotes", v);
    }
    std::vector<std::string> const& words = key.help.choices;
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (value_of_word(key, words[i]) == v) {
            return key.numbers[i];
        }
    }
    throw BadParameter("recipe.set_key", fmt::format("{} is not one of its values.{} ({})", toml_text(v),
                                                     is_text ? did_you_mean(std::get<std::string>(v), words) : "",
                                                     fmt::join(words, ", ")));
}

/// The words of a list: one of TOML, or a text with commas between them.
WordList words_in(Value const& value) {
    if (auto const* const list = std::get_if<WordList>(&value)) {
        return *list;
    }
    std::istringstream text(required<std::string>("a list of words", value));
    WordList words;
    for (std::string word; std::getline(text >> std::ws, word, ',');) {
        words.push_back(word.substr(0, word.find_last_not_of(' ') + 1));
    }
    refuse_if<BadParameter>(words.empty(), "recipe.set_key", "a list of words is required, not an empty one");
    return words;
}

/// Puts a value into the field of its key. Throws BadParameter for one that the key may not have.
struct Store {
    Key const& key;
    Value const& value;

    void operator()(bool* field) const { *field = required<bool>("true or false", value); }
    void operator()(double* field) const { *field = number(); }
    void operator()(std::optional<double>* field) const { *field = number(); }
    void operator()(Enumeration const& field) const { field.set(field.at, number_for(key, value)); }
    void operator()(std::optional<std::vector<OutputFiles>>* field) const {
        std::set<OutputFiles> files;
        for (std::string const& word : words_in(value)) {
            files.insert(static_cast<OutputFiles>(number_for(key, word)));
        }
        field->emplace(files.begin(), files.end());
    }
    void operator()(std::string* field) const {
        std::string const& s = required<std::string>("a text in quotes", value);
        refuse_if<BadParameter>(s.size() > 4096 || s.find('\0') != std::string::npos, "recipe.set_key",
                                "the text is too long or holds a null byte");
        require_fit();
        *field = s;
    }
    template <class Integer> void operator()(Integer* field) const {
        std::int64_t const x = required<std::int64_t>("an integer", value);
        require_in_range(static_cast<double>(x));
        *field = static_cast<Integer>(x);
    }
    template <class List> void operator()(std::optional<List>* field) const {
        require_fit();
        *field = std::get<List>(value);
    }

private:
    double number() const {
        auto const* const whole = std::get_if<std::int64_t>(&value);
        double const x = whole != nullptr ? static_cast<double>(*whole) : required<double>("a number", value);
        require_in_range(x);
        return x;
    }
    void require_in_range(double x) const {
        KeyRange const& range = key.row->allowed.range;
        refuse_if<BadParameter>(!range.holds(x), "recipe.set_key", "{} is outside its range {}", x, range.text());
    }
    void require_fit() const {
        AllowedValues const& allowed = key.row->allowed;
        if (allowed.fits != nullptr && !allowed.fits(value)) {
            refuse_value(allowed.form, value);
        }
    }
};

/// Takes it out; nothing where it is left out.
struct Show {
    Key const& key;

    template <class T> std::optional<Value> operator()(T const* field) const {
        if constexpr (std::is_integral_v<T> && !std::is_same_v<T, bool>) {
            return static_cast<std::int64_t>(*field);
        } else {
            return *field;
        }
    }
    template <class T> std::optional<Value> operator()(std::optional<T> const* field) const {
        return *field ? std::optional<Value>(**field) : std::nullopt;
    }
    std::optional<Value> operator()(std::optional<std::vector<OutputFiles>> const* field) const {
        if (!*field) {
            return std::nullopt;
        }
        WordList words;
        for (OutputFiles const files : **field) {
            words.push_back(key.help.choices.at(static_cast<std::size_t>(files)));
        }
        return words;
    }
    std::optional<Value> operator()(Enumeration const& field) const {
        auto const at = std::find(key.numbers.begin(), key.numbers.end(), field.get(field.at)) - key.numbers.begin();
        auto const& words = key.help.choices;
        auto const place = static_cast<std::size_t>(at);
        return place == words.size() ? std::nullopt : std::optional<Value>(value_of_word(key, words[place]));
    }
};

std::size_t always_one(Recipe const&) {
    return 1;
}

void nothing_to_begin(Recipe&) {}

template <auto part> std::size_t count_of(Recipe const& recipe) {
    return (recipe.*part).has_value() ? 1 : 0;
}

template <auto part> void begin_one(Recipe& recipe) {
    if (!(recipe.*part)) {
        (recipe.*part).emplace();
    }
}

template <auto part> void remove_one(Recipe& recipe, Item) {
    (recipe.*part).reset();
}

/// A section that is named is a stage that runs, empty or not.
template <auto part> constexpr Section stage(char const* name) {
    return {name, count_of<part>, begin_one<part>, remove_one<part>};
}

/// Tables of which each mention is one more.
template <auto part> constexpr Section array_of(char const* name) {
    return {name, [](Recipe const& r) { return (r.*part).size(); }, [](Recipe& r) { (r.*part).emplace_back(); },
            [](Recipe& r, Item item) { (r.*part).erase((r.*part).begin() + static_cast<std::ptrdiff_t>(item)); }, true};
}

constexpr std::array<Section, 11> sections = {{{"", always_one, nothing_to_begin},
                                               {"grid", always_one, nothing_to_begin},
                                               stage<&Recipe::network>("network"),
                                               stage<&Recipe::skeleton>("skeleton"),
                                               stage<&Recipe::surface>("surface"),
                                               stage<&Recipe::strata>("strata"),
                                               array_of<&Recipe::layers>("layer"),
                                               stage<&Recipe::statistics>("statistics"),
                                               stage<&Recipe::detail>("detail"),
                                               array_of<&Recipe::patches>("patch"),
                                               {"output", always_one, nothing_to_begin}}};

/// By KeyKind.
constexpr std::array<char const*, 11> type_names{"yes/no",        "integer",         "number",       "two numbers",
                                                 "three numbers", "four numbers",    "text",         "text",
                                                 "text",          "integer or text", "list of words"};

/// Where a field lies.
struct PlaceOfField {
    void const* operator()(Enumeration const& e) const { return e.at; }
    void const* operator()(void const* at) const { return at; }
};

void const* place_of(Field const& field) {
    return std::visit(PlaceOfField{}, field);
}

/// Lists the words of a key and what they stand for.
void list_words(Key& key, Field const& field) {
    for (auto& [word, number] : words_of(*key.row, field)) {
        key.help.choices.push_back(std::move(word));
        key.numbers.push_back(number);
    }
}

/// What is allowed, for people.
std::string range_text(Key const& key) {
    if (key.range) {
        return key.range->text();
    }
    if (key.row->kind == KeyKind::words) {
        return fmt::format("list of {}", fmt::join(key.help.choices, " | "));
    }
    std::vector<std::string> ways = key.help.choices;
    std::string const form = key.help.is_file ? "file name" : key.row->allowed.form;
    if (!form.empty()) {
        ways.push_back(form);
    }
    return fmt::format("{}", fmt::join(ways, " | "));
}

std::string standard_text(Value const& value) {
    auto const* const number = std::get_if<double>(&value); // for a reader: 0.087, not its 17 digits
    return number != nullptr ? fmt::format("{}", *number) : toml_text(value);
}

Key make_key(Row const& row, Recipe& standard) {
    std::string_view const path = row.path;
    Key key;
    key.row = &row;
    key.part = find_section(path.substr(0, path.find('.') == std::string_view::npos ? 0 : path.find('.')));
    key.use = row.used;
    key.help.path = path;
    key.help.type = type_names.at(static_cast<std::size_t>(row.kind));
    key.help.unit = row.unit;
    key.help.meaning = row.meaning;
    key.help.used_by = key.use.text();
    key.help.is_file = row.kind == KeyKind::file;
    key.folder = row.extra.folder != nullptr ? row.extra.folder : key.name() + "/";
    if (row.kind == KeyKind::integer || row.kind == KeyKind::number) {
        KeyRange const& range = row.allowed.range;
        key.range = range;
        key.help.least = range.least;
        key.help.most = range.most < endless ? std::optional(range.most) : std::nullopt;
    }
    list_words(key, row.field(standard, 0));
    key.help.range = range_text(key);
    auto const value = key.take(standard);
    key.help.standard = *row.extra.standard == '\0' && value ? standard_text(*value) : row.extra.standard;
    return key;
}

std::vector<Key> make_keys() {
    Recipe standard = with_all_sections();
    std::vector<Key> keys;
    for (Row const& row : recipe_rows()) {
        keys.push_back(make_key(row, standard));
    }
    return keys;
}

} // namespace

std::string toml_text(Value const& value) {
    return std::visit([](auto const& v) { return text_of(v); }, value);
}

std::string KeyRange::text() const {
    if (most >= endless) {
        return fmt::format("{} {}", open ? ">" : ">=", least);
    }
    return fmt::format("{}{}, {}]", open ? "(" : "[", least, most);
}

std::vector<std::pair<std::string, int>> words_of(Row const& row, Field const& field) {
    auto const* const enumeration = std::get_if<Enumeration>(&field);
    int const least = enumeration == nullptr ? 0 : enumeration->least;
    std::vector<std::pair<std::string, int>> words;
    auto const add = [&](std::string const& word, std::optional<int> number) {
        words.emplace_back(word, number.value_or(least + static_cast<int>(words.size())));
    };
    if (row.allowed.more_words != nullptr) {
        for (std::string const& word : row.allowed.more_words()) {
            add(word, std::nullopt);
        }
    }
    for (Word const& word : row.allowed.words) {
        if (word.text != nullptr) {
            add(word.text, word.number);
        }
    }
    return words;
}

FoundRow row_of(Condition::FieldOf const& field) {
    static Recipe sample = with_all_sections();
    void const* const place = place_of(*field(sample));
    for (Row const& row : recipe_rows()) {
        Field const of_row = row.field(sample, 0);
        if (place_of(of_row) == place) {
            return {row, of_row};
        }
    }
    throw std::logic_error("recipe: a condition asks for a field that no key has");
}

void Key::put(Recipe& recipe, Value const& value, std::optional<Item> item) const {
    Recipe trial = with_all_sections();
    std::visit(Store{*this, value}, row->field(trial, 0));
    std::size_t const count = part->count(recipe);
    if (count == 0 || item == count) {
        part->begin(recipe);
    }
    std::visit(Store{*this, value}, row->field(recipe, item.value_or(part->count(recipe) - 1)));
}

void Key::reset(Recipe& recipe, Item item) const {
    Recipe standard = with_all_sections();
    Field const field = row->field(recipe, item);
    Field const usual = row->field(standard, 0);
    if (auto const* const word = std::get_if<Enumeration>(&field)) {
        word->set(word->at, word->get(std::get<Enumeration>(usual).at));
        return;
    }
    std::visit(
        [](auto const& to, auto const& from) {
            if constexpr (std::is_same_v<decltype(to), decltype(from)> &&
                          std::is_pointer_v<std::decay_t<decltype(to)>>) {
                *to = *from;
            }
        },
        field, usual);
}

std::optional<Value> Key::take(Recipe const& recipe, std::optional<Item> item) const {
    std::size_t const count = part->count(recipe);
    if (count == 0) {
        return std::nullopt;
    }
    auto const value = std::visit(Show{*this}, row->field(const_cast<Recipe&>(recipe), item.value_or(count - 1)));
    bool const is_zero = value == Value(std::int64_t{0}) || value == Value(0.0);
    return row->extra.left_out_at_zero && is_zero ? std::nullopt : value;
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

bool is_array_section(std::string const& section) {
    Section const* const found = find_section(section);
    return found != nullptr && found->is_array;
}

std::vector<KeyHelp> recipe_keys() {
    std::vector<KeyHelp> keys;
    for (Key const& key : all_keys()) {
        keys.push_back(key.help);
    }
    return keys;
}

} // namespace thalweg::recipe
