// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/internal/toml_depth.hpp>

#include <algorithm>
#include <vector>

namespace thalweg::pipeline {

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

} // namespace thalweg::pipeline
