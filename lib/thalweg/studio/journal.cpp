// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/studio/internal/journal.hpp>

#include <exception>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <thalweg/core/bounded_json.hpp>
#include <thalweg/core/run/refuse.hpp>

namespace thalweg::studio {

using nlohmann::json;

namespace {

constexpr std::int64_t format_of_journal = 1;

std::string line_of_json(json const& value) {
    return value.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
}

struct StepAsJson {
    json operator()(SetKey const& step) const { return {{"set", step.key}, {"to", step.value}}; }
    json operator()(UnsetKey const& step) const { return {{"unset", step.key}}; }
    json operator()(TakeInput const& step) const { return {{"take", step.file}, {"for", step.key}}; }
    json operator()(ReplaceRecipe const& step) const { return {{"recipe", step.toml}}; }
    json operator()(ReplaceLines const& step) const {
        return {{"line", step.first}, {"old", step.old_text}, {"new", step.new_text}};
    }
};

/// A text of an object. Throws BadInput.
std::string text_in(json const& object, char const* name) {
    auto const at = object.find(name);
    refuse_if<BadInput>(at == object.end() || !at->is_string(), "studio.DocumentFolder", "{} is missing or no text",
                        name);
    return at->get<std::string>();
}

ReplaceLines lines_in(json const& object) {
    auto const at = object.find("line");
    bool const is_number = at != object.end() && at->is_number_integer() &&
                           !(at->is_number_unsigned() && at->get<std::uint64_t>() > std::uint64_t{INT32_MAX});
    refuse_if<BadInput>(!is_number || at->get<std::int64_t>() < 0, "studio.DocumentFolder",
                        "line is missing or no number of a line");
    return {at->get<std::int64_t>(), text_in(object, "old"), text_in(object, "new")};
}

Step step_in(json const& object) {
    refuse_if<BadInput>(!object.is_object(), "studio.DocumentFolder", "a step is no object");
    if (object.contains("set")) {
        return SetKey{text_in(object, "set"), text_in(object, "to")};
    }
    if (object.contains("unset")) {
        return UnsetKey{text_in(object, "unset")};
    }
    if (object.contains("take")) {
        TakeInput step{text_in(object, "for"), text_in(object, "take")};
        refuse_if<BadInput>(!lies_in_inputs(step.file), "studio.DocumentFolder", "{} does not lie below inputs/",
                            step.file);
        return step;
    }
    if (object.contains("recipe")) {
        return ReplaceRecipe{text_in(object, "recipe")};
    }
    return lines_in(object);
}

Change change_in(json const& object) {
    Change change;
    change.edit.name = text_in(object, "edit");
    auto const steps = object.find("steps");
    refuse_if<BadInput>(steps == object.end() || !steps->is_array(), "studio.DocumentFolder", "steps are missing");
    for (json const& step : *steps) {
        change.edit.steps.push_back(step_in(step));
    }
    change.inverse = reversed(lines_in(object));
    return change;
}

/// Parses a line; one that is nested deeper than any of ours is refused.
json parsed(std::string_view line) {
    json value = bounded_json<json>(line, {.deepest = 4});
    refuse_if<BadInput>(!value.is_object(), "studio.DocumentFolder", "it is no JSON that thalweg writes");
    return value;
}

/// Does what a line says. Throws BadInput, and changes nothing then.
void follow(Journal& journal, json const& line) {
    History& history = journal.history;
    if (journal.lines == 0) {
        auto const format = line.find("thalweg_history");
        refuse_if<BadInput>(format == line.end() || *format != format_of_journal, "studio.DocumentFolder",
                            "it does not begin as the journal of a document, or is one of a later version");
        journal.first_toml = text_in(line, "recipe");
        journal.toml = journal.first_toml;
    } else if (line.contains("edit")) {
        Change change = change_in(line);
        journal.toml = with_lines(journal.toml, reversed(change.inverse));
        history.done.push_back(std::move(change));
        history.undone.clear();
    } else if (line.contains("undo") && !history.done.empty()) {
        journal.toml = with_lines(journal.toml, history.done.back().inverse);
        move_last(history.done, history.undone);
    } else {
        refuse_if<BadInput>(!line.contains("redo") || history.undone.empty(), "studio.DocumentFolder",
                            "it is no edit, and there is nothing to undo or redo");
        journal.toml = with_lines(journal.toml, reversed(history.undone.back().inverse));
        move_last(history.undone, history.done);
    }
}

} // namespace

std::string line_of_beginning(std::string const& toml) {
    return line_of_json({{"thalweg_history", format_of_journal}, {"recipe", toml}});
}

std::string line_of(Change const& change) {
    json line = StepAsJson()(reversed(change.inverse));
    line["edit"] = change.edit.name;
    json& steps = line["steps"] = json::array();
    for (Step const& step : change.edit.steps) {
        steps.push_back(std::visit(StepAsJson(), step));
    }
    return line_of_json(line);
}

std::string line_of_undo() {
    return line_of_json({{"undo", 1}});
}

std::string line_of_redo() {
    return line_of_json({{"redo", 1}});
}

std::string journal_of(std::string const& first_toml, History const& history) {
    std::string text = line_of_beginning(first_toml);
    for (Change const& change : history.done) {
        text += line_of(change);
    }
    for (auto change = history.undone.rbegin(); change != history.undone.rend(); ++change) {
        text += line_of(*change);
    }
    for (std::size_t i = 0; i < history.undone.size(); ++i) {
        text += line_of_undo();
    }
    return text;
}

Journal read_journal(std::string_view text, std::string const& looked_for) {
    Journal journal;
    while (true) {
        std::size_t const end = text.find('\n', journal.bytes);
        if (end == std::string_view::npos) {
            return journal;
        }
        try {
            bool const was_there = journal.lines > 0 && journal.toml == looked_for;
            follow(journal, parsed(text.substr(journal.bytes, end - journal.bytes)));
            journal.passed = journal.passed || was_there;
        } catch (std::exception const& fault) {
            journal.fault = fault.what();
            return journal;
        }
        journal.bytes = end + 1;
        ++journal.lines;
    }
}

} // namespace thalweg::studio
