// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/studio/document.hpp>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/run/messages.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/recipe/recipe_files.hpp>
#include <thalweg/studio/internal/journal.hpp>

namespace thalweg::studio {

using recipe::Recipe;

bool lies_in_inputs(std::string const& name) {
    std::filesystem::path const path(name);
    bool const is_below = path.is_relative() && name.starts_with("inputs/") && path.has_filename();
    return is_below && std::ranges::none_of(path, [](auto const& part) { return part == ".." || part == "."; });
}

namespace {

constexpr char const* file_name = "recipe.toml";

void require_own_files(Recipe const& recipe) {
    for (std::string const& name : recipe::file_names(recipe)) {
        refuse_if<BadParameter>(!lies_in_inputs(name), "studio.apply",
                                "{}: the files of a document lie below inputs/: take it into the document", name);
    }
}

/// The recipe as a file says it, without keys that have no effect: those that others need to have one go first.
std::string settled(Recipe const& recipe) {
    constexpr int most_rounds = 16;
    std::string toml = recipe::write_recipe(recipe);
    for (int round = 0; round < most_rounds; ++round) {
        std::string again = recipe::write_recipe(recipe::read_recipe(toml, file_name));
        if (again == toml) {
            break;
        }
        toml = std::move(again);
    }
    return toml;
}

/// The line that begins at a byte, with its end.
std::string_view line_at(std::string_view text, std::size_t begin) {
    return text.substr(begin, std::min(text.find('\n', begin), text.size() - 1) + 1 - begin);
}

/// Where a line begins; npos: there are fewer.
std::size_t begin_of_line(std::string_view text, std::int64_t line) {
    std::size_t begin = 0;
    for (std::int64_t i = 0; i < line; ++i) {
        std::size_t const end = text.find('\n', begin);
        if (end == std::string_view::npos) {
            return end;
        }
        begin = end + 1;
    }
    return begin;
}

/// The fewest neighbouring lines that differ.
ReplaceLines lines_between(std::string_view from, std::string_view to) {
    ReplaceLines lines;
    std::size_t begin = 0;
    while (begin < from.size() && begin < to.size() && line_at(from, begin) == line_at(to, begin)) {
        begin += line_at(from, begin).size();
        ++lines.first;
    }
    std::size_t same = 0; // bytes of whole lines at the end
    std::size_t const most = std::min(from.size(), to.size()) - begin;
    for (std::size_t i = 0; i < most && from[from.size() - 1 - i] == to[to.size() - 1 - i]; ++i) {
        bool const begins_lines = (i + 1 == from.size() - begin || from[from.size() - 2 - i] == '\n') &&
                                  (i + 1 == to.size() - begin || to[to.size() - 2 - i] == '\n');
        same = begins_lines ? i + 1 : same;
    }
    lines.old_text = from.substr(begin, from.size() - same - begin);
    lines.new_text = to.substr(begin, to.size() - same - begin);
    return lines;
}

/// A recipe between the steps of an edit.
class Draft {
public:
    explicit Draft(Document const& document) : toml_(document.toml), recipe_(document.recipe) {
        recipe_.folder.clear(); // a file's name is set as it is
    }

    void operator()(SetKey const& step) {
        try {
            recipe::set_key(recipe_, step.key, step.value);
        } catch (BadParameter const& fault) {
            throw BadParameter("studio.apply", fmt::format("{}: {}", step.key, fault.what()));
        }
        set_.insert(step.key);
        is_settled_ = false;
    }
    void operator()(UnsetKey const& step) {
        recipe::unset_key(recipe_, step.key);
        std::string const section = step.key.substr(0, step.key.find('.') + 1);
        bool const renumbers = !section.empty() && recipe::is_array_section(section.substr(0, section.size() - 1));
        std::erase_if(set_, [&](std::string const& key) {
            return key == step.key || key.starts_with(step.key + ".") || (renumbers && key.starts_with(section));
        });
        is_settled_ = false;
    }
    void operator()(TakeInput const& step) {
        refuse_if<BadParameter>(!lies_in_inputs(step.file), "studio.apply", "{} = {}: an input lies below inputs/",
                                step.key, step.file);
        (*this)(SetKey{step.key, step.file});
    }
    void operator()(ReplaceRecipe const& step) {
        recipe_ = recipe::read_recipe(step.toml, file_name);
        recipe::check_recipe(recipe_);
        set_.clear();
        is_settled_ = false;
    }
    void operator()(ReplaceLines const& step) {
        toml_ = with_lines(toml(), step);
        recipe_ = recipe::read_recipe(toml_, file_name);
        set_.clear();
        is_settled_ = true;
    }

    std::string toml() const { return is_settled_ ? toml_ : settled(recipe_); }

    Document document() const {
        Document document{toml(), {}, 0};
        document.recipe = recipe::read_recipe(document.toml, file_name);
        for (std::string const& key : set_) {
            recipe::require_effect(document.recipe, key);
        }
        recipe::check_recipe(document.recipe);
        require_own_files(document.recipe);
        return document;
    }

private:
    std::string toml_; ///< where it is settled
    Recipe recipe_;
    bool is_settled_ = true;
    std::set<std::string> set_; ///< keys that must have an effect at the end
};

} // namespace

std::string with_lines(std::string toml, ReplaceLines const& lines) {
    for (std::string_view const text :
         {std::string_view(toml), std::string_view(lines.old_text), std::string_view(lines.new_text)}) {
        refuse_if<BadInput>(!text.empty() && text.back() != '\n', "studio.apply", "lines end in the middle of one");
    }
    std::size_t const begin = lines.first < 0 ? std::string::npos : begin_of_line(toml, lines.first);
    bool const is_there = begin != std::string::npos && toml.compare(begin, lines.old_text.size(), lines.old_text) == 0;
    refuse_if<BadInput>(!is_there, "studio.apply", "the recipe has other lines than those to replace");
    return toml.replace(begin, lines.old_text.size(), lines.new_text);
}

ReplaceLines reversed(ReplaceLines lines) {
    std::swap(lines.old_text, lines.new_text);
    return lines;
}

void move_last(std::vector<Change>& from, std::vector<Change>& to) {
    to.push_back(std::move(from.back()));
    from.pop_back();
}

std::string name_of(Edit const& edit) {
    struct Name {
        std::string operator()(SetKey const& step) const { return fmt::format("{} = {}", step.key, step.value); }
        std::string operator()(UnsetKey const& step) const { return fmt::format("without {}", step.key); }
        std::string operator()(TakeInput const& step) const { return fmt::format("{} = {}", step.key, step.file); }
        std::string operator()(ReplaceRecipe const&) const { return "another recipe"; }
        std::string operator()(ReplaceLines const&) const { return "other lines"; }
    };
    return edit.name.empty() && edit.steps.size() == 1 ? std::visit(Name(), edit.steps.front()) : edit.name;
}

Document document_of(std::string const& toml) {
    return apply({}, {"", {ReplaceRecipe{toml}}}).document;
}

AppliedEdit apply(Document const& document, Edit const& edit) {
    refuse_if<BadParameter>(!is_utf8(edit.name), "studio.apply", "the name of an edit is not UTF-8");
    Draft draft(document);
    for (Step const& step : edit.steps) {
        std::visit(draft, step);
    }
    Document after = draft.document();
    after.recipe.folder = document.recipe.folder;
    after.revision = document.revision + 1;
    ReplaceLines inverse = lines_between(after.toml, document.toml);
    return {std::move(after), std::move(inverse)};
}

Session edited(Session session, Edit const& edit) {
    AppliedEdit applied = apply(session.document, edit);
    if (applied.document.toml == session.document.toml) {
        return session;
    }
    session.document = std::move(applied.document);
    session.history.done.push_back({edit, std::move(applied.inverse)});
    session.history.undone.clear();
    return session;
}

Session undone(Session session) {
    std::vector<Change>& done = session.history.done;
    if (!done.empty()) {
        session.document = apply(session.document, {"", {done.back().inverse}}).document;
        move_last(done, session.history.undone);
    }
    return session;
}

Session redone(Session session) {
    std::vector<Change>& again = session.history.undone;
    if (!again.empty()) {
        session.document = apply(session.document, {"", {reversed(again.back().inverse)}}).document;
        move_last(again, session.history.done);
    }
    return session;
}

} // namespace thalweg::studio
