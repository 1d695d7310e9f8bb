// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/recipe/condition.hpp>

#include <algorithm>

#include <fmt/format.h>

#include <thalweg/recipe/recipe_keys.hpp>

namespace thalweg::recipe {

namespace {

struct NumberOfField {
    std::optional<double> operator()(Enumeration const& e) const { return e.get(e.at); }
    std::optional<double> operator()(std::optional<double> const* number) const { return *number; }
    std::optional<double> operator()(std::string const*) const { return std::nullopt; }
    template <class T> std::optional<double> operator()(std::optional<T> const*) const { return std::nullopt; }
    template <class T> std::optional<double> operator()(T const* number) const { return static_cast<double>(*number); }
};

struct FieldIsGiven {
    bool operator()(std::string const* text) const { return !text->empty(); }
    template <class T> bool operator()(std::optional<T> const* value) const { return value->has_value(); }
    template <class T> bool operator()(T const*) const { return true; }
    bool operator()(Enumeration const&) const { return true; }
};

bool lists_files(Field const& field, OutputFiles files) {
    auto const* const list = std::get<std::optional<std::vector<OutputFiles>>*>(field);
    return !*list || std::ranges::count(**list, files) > 0;
}

bool is_word(Field const& field) {
    return std::holds_alternative<Enumeration>(field) || std::holds_alternative<bool*>(field);
}

std::string section_name(std::function<bool(Recipe const&)> const& has_section) {
    for (Section const& section : all_sections()) {
        Recipe alone;
        section.begin(alone);
        if (has_section(alone)) {
            return fmt::format("[{}]", section.name);
        }
    }
    return {};
}

template <class T> T* held(std::optional<T>& section) {
    return section ? &*section : nullptr;
}

template <class Section, class Part> Part* within(std::optional<Section>& section, Part Section::*part) {
    return section ? &((*section).*part) : nullptr;
}

} // namespace

std::optional<double> number_in(Field const& field) {
    return std::visit(NumberOfField{}, field);
}

/// A question to a section or key, or conditions that are joined.
struct Condition::Node {
    enum class Kind : std::uint8_t { all, any, question, told };
    Kind kind = Kind::question;
    std::vector<Condition> parts = {};
    std::string words = {}; ///< of told
    bool is_negated = false;
    Question question = Question::section;
    std::function<bool(Recipe const&)> has_section = {};
    FieldOf field = {};
    std::vector<double> numbers = {}; ///< one of which a key is, or the limit

    bool holds(Recipe const& recipe) const;
    bool answers(Recipe& recipe) const;
    std::string text() const;
    std::string lacks(Recipe const& recipe) const;
    std::string text_of_question() const;
    std::string number_text(FoundRow const& key, double number) const;
    std::string listed(FoundRow const& key) const;
};

bool Condition::Node::answers(Recipe& recipe) const {
    if (question == Question::section) {
        return has_section(recipe);
    }
    std::optional<Field> const held = field(recipe);
    if (!held) {
        return false;
    }
    std::optional<double> const number = number_in(*held);
    switch (question) {
    case Question::given: return std::visit(FieldIsGiven{}, *held);
    case Question::one_of: return number && std::ranges::count(numbers, *number) > 0;
    case Question::above: return number && *number > numbers.front();
    case Question::below: return number && *number < numbers.front();
    default: return lists_files(*held, static_cast<OutputFiles>(numbers.front()));
    }
}

bool Condition::Node::holds(Recipe const& recipe) const {
    auto const part_holds = [&](Condition const& part) { return part(recipe); };
    switch (kind) {
    case Kind::all:
    case Kind::told: return std::ranges::all_of(parts, part_holds);
    case Kind::any: return std::ranges::any_of(parts, part_holds);
    default: return answers(const_cast<Recipe&>(recipe)) != is_negated; // which it only reads
    }
}

/// A number, or the word of the table that it stands for.
std::string Condition::Node::number_text(FoundRow const& key, double number) const {
    if (std::holds_alternative<bool*>(key.field)) {
        return number != 0.0 ? "true" : "false";
    }
    if (!std::holds_alternative<Enumeration>(key.field)) {
        return fmt::format("{}", number);
    }
    for (auto const& [word, of] : words_of(key.row, key.field)) {
        if (of == static_cast<int>(number)) {
            bool const is_integer = word.find_first_not_of("0123456789") == std::string::npos;
            return is_integer ? word : '"' + word + '"';
        }
    }
    return {};
}

/// `"tin" or "diffuse"`, `4, 12 or 16`.
std::string Condition::Node::listed(FoundRow const& key) const {
    std::string text;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        std::string const word = number_text(key, numbers[i]);
        bool const with_comma = !word.starts_with('"') && i + 1 < numbers.size();
        text += (i == 0 ? "" : with_comma ? ", " : " or ") + word;
    }
    return text;
}

std::string Condition::Node::text_of_question() const {
    if (question == Question::section) {
        return (is_negated ? "no " : "") + section_name(has_section);
    }
    FoundRow const key = row_of(field);
    std::string const path = key.row.path;
    switch (question) {
    case Question::given: return (is_negated ? "no " : "") + path;
    case Question::one_of: return path + (is_negated ? " other than " : " = ") + listed(key);
    case Question::above: return fmt::format("{} {} {}", path, is_negated ? "<=" : ">", numbers.front());
    case Question::below: return fmt::format("{} {} {}", path, is_negated ? ">=" : "<", numbers.front());
    default: break;
    }
    std::string const files = words_of(key.row, key.field).at(static_cast<std::size_t>(numbers.front())).first;
    return fmt::format("{} {} \"{}\"", path, is_negated ? "without" : "with", files);
}

std::string Condition::Node::text() const {
    if (kind == Kind::told) {
        return words;
    }
    if (kind == Kind::question) {
        return text_of_question();
    }
    std::string joined;
    for (Condition const& part : parts) {
        bool const in_brackets = part.node_->kind == (kind == Kind::all ? Kind::any : Kind::all);
        joined += joined.empty() ? "" : kind == Kind::all ? " and " : " or ";
        joined += in_brackets ? '(' + part.text() + ')' : part.text();
    }
    return joined;
}

std::string Condition::Node::lacks(Recipe const& recipe) const {
    if (holds(recipe)) {
        return {};
    }
    if (kind == Kind::told) {
        return words;
    }
    if (kind == Kind::question) {
        std::string instead;
        std::optional<Field> const held = field ? field(const_cast<Recipe&>(recipe)) : std::nullopt;
        if (question == Question::one_of && held && is_word(*held)) {
            std::string const here = number_text(row_of(field), *number_in(*held));
            instead = here.starts_with('"') || std::holds_alternative<bool*>(*held)
                          ? fmt::format(" (here it is {})", here)
                          : "";
        }
        return text_of_question() + instead;
    }
    std::string lacking;
    for (Condition const& part : parts) {
        std::string const of_part = part.lacks(recipe);
        bool const is_first = lacking.empty() || of_part.empty();
        lacking += (is_first ? "" : kind == Kind::any ? ", or " : " and ") + of_part;
    }
    return lacking;
}

Condition::Condition(std::shared_ptr<Node const> node) : node_(std::move(node)) {}

bool Condition::operator()(Recipe const& recipe) const {
    return node_ == nullptr || node_->holds(recipe);
}

std::string Condition::text() const {
    return node_ == nullptr ? "" : node_->text();
}

std::string Condition::lacks(Recipe const& recipe) const {
    return node_ == nullptr ? "" : node_->lacks(recipe);
}

Condition Condition::told_as(std::string words) const {
    return Condition(
        std::make_shared<Node>(Node{.kind = Node::Kind::told, .parts = {*this}, .words = std::move(words)}));
}

Condition Condition::ask(Question question, FieldOf field, std::vector<double> numbers) {
    return Condition(
        std::make_shared<Node>(Node{.question = question, .field = std::move(field), .numbers = std::move(numbers)}));
}

Condition Condition::ask_section(std::function<bool(Recipe const&)> has_section) {
    return Condition(std::make_shared<Node>(Node{.has_section = std::move(has_section)}));
}

Condition Condition::join(bool all, Condition const& a, Condition const& b) {
    if (a.node_ == nullptr || b.node_ == nullptr) { // one holds for every recipe
        return !all ? Condition() : a.node_ == nullptr ? b : a;
    }
    Node joined{.kind = all ? Node::Kind::all : Node::Kind::any};
    for (Condition const& part : {a, b}) {
        if (part.node_->kind == joined.kind) {
            joined.parts.insert(joined.parts.end(), part.node_->parts.begin(), part.node_->parts.end());
        } else {
            joined.parts.push_back(part);
        }
    }
    return Condition(std::make_shared<Node>(std::move(joined)));
}

Condition operator&&(Condition const& a, Condition const& b) {
    return Condition::join(true, a, b);
}

Condition operator||(Condition const& a, Condition const& b) {
    return Condition::join(false, a, b);
}

Condition operator!(Condition const& a) {
    using Kind = Condition::Node::Kind;
    Condition::Node negated = *a.node_;
    negated.is_negated = !negated.is_negated;
    negated.kind = negated.kind == Kind::all ? Kind::any : negated.kind == Kind::any ? Kind::all : negated.kind;
    for (Condition& part : negated.parts) {
        part = !part;
    }
    return Condition(std::make_shared<Condition::Node>(std::move(negated)));
}

Condition ask::writes(OutputFiles files) {
    return Condition::ask(Condition::Question::lists, field_of(&OutputRecipe::files), {static_cast<double>(files)});
}

// Parts of a recipe.

template <> NetworkRecipe* part_of(Recipe& recipe) {
    return held(recipe.network);
}
template <> growth::DlaParams* part_of(Recipe& recipe) {
    return within(recipe.network, &NetworkRecipe::dla);
}
template <> LinesRecipe* part_of(Recipe& recipe) {
    return within(recipe.network, &NetworkRecipe::lines);
}
template <> TokunagaRecipe* part_of(Recipe& recipe) {
    return within(recipe.network, &NetworkRecipe::tokunaga);
}
template <> ForestRecipe* part_of(Recipe& recipe) {
    return within(recipe.network, &NetworkRecipe::forest);
}
template <> SkeletonRecipe* part_of(Recipe& recipe) {
    return held(recipe.skeleton);
}
template <> SurfaceRecipe* part_of(Recipe& recipe) {
    return held(recipe.surface);
}
template <> EquilibriumRecipe* part_of(Recipe& recipe) {
    return within(recipe.surface, &SurfaceRecipe::equilibrium);
}
template <> surface::DilateParams* part_of(Recipe& recipe) {
    return within(recipe.surface, &SurfaceRecipe::dilate);
}
template <> surface::DiffuseParams* part_of(Recipe& recipe) {
    return within(recipe.surface, &SurfaceRecipe::diffuse);
}
template <> StrataRecipe* part_of(Recipe& recipe) {
    return held(recipe.strata);
}
template <> StatisticsRecipe* part_of(Recipe& recipe) {
    return held(recipe.statistics);
}
template <> DetailRecipe* part_of(Recipe& recipe) {
    return held(recipe.detail);
}
template <> fractal::MidpointParams* part_of(Recipe& recipe) {
    return within(recipe.detail, &DetailRecipe::midpoint);
}
template <> OutputRecipe* part_of(Recipe& recipe) {
    return &recipe.output;
}

} // namespace thalweg::recipe
