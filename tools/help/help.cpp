// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "help/describe.hpp"

namespace thalweg::tools {

namespace {

constexpr std::size_t line_width = 80;
constexpr std::size_t column = 26;

/// A name, and beside it, or below where it is long, what it means.
std::string entry(std::string const& name, std::string const& meaning) {
    std::string const gap =
        name.size() + 2 > column ? "\n" + std::string(column, ' ') : std::string(column - name.size(), ' ');
    return name + gap + wrapped(meaning, line_width - column, column) + "\n";
}

std::string meaning_of(OptionHelp const& option) {
    std::string text = option.meaning;
    if (option.takes == Takes::word && option.placeholder == "WORD") {
        text += fmt::format(" One of {}.", fmt::join(option.words, ", "));
    }
    if (!option.standard.empty()) {
        text += fmt::format(" Default: {}.", option.standard);
    }
    return text;
}

std::string entry(OptionHelp const& option) {
    bool const only_long = option.names.front().rfind("--", 0) == 0;
    return entry(fmt::format("  {}{}{}{}", only_long ? "    " : "", fmt::join(option.names, ", "),
                             option.placeholder.empty() ? "" : " ", option.placeholder),
                 meaning_of(option));
}

} // namespace

std::string wrapped(std::string const& text, std::size_t width, std::size_t indent) {
    std::string out;
    std::size_t used = 0;
    for (std::size_t begin = 0; begin < text.size();) {
        std::size_t const end = std::min(text.find(' ', begin), text.size());
        std::string const word = text.substr(begin, end - begin);
        begin = end + 1;
        if (used > 0 && used + 1 + word.size() > width) {
            out += "\n" + std::string(indent, ' ');
            used = 0;
        } else if (used > 0) {
            out += " ";
            ++used;
        }
        out += word;
        used += word.size();
    }
    return out;
}

std::string help_text(CLI::App const& app) {
    CommandHelp const help = describe(app);
    std::string out = wrapped(help.summary, line_width, 0) + "\n\nUsage: thalweg ";
    out += app.get_parent() == nullptr ? "COMMAND" : help.name;
    out += " [OPTIONS]";
    for (OptionHelp const& p : help.positionals) {
        std::string const word = long_name(p) + (p.repeats ? "..." : "");
        out += p.required ? " " + word : fmt::format(" [{}]", word);
    }
    out += "\n";
    if (!help.text.empty()) {
        out += "\n";
        for (std::size_t begin = 0; begin < help.text.size();) {
            std::size_t const end = std::min(help.text.find('\n', begin), help.text.size());
            out += wrapped(help.text.substr(begin, end - begin), line_width, 0) + "\n";
            begin = end + 1;
        }
    }
    if (!help.commands.empty()) {
        out += "\nCommands:\n";
        for (CommandHelp const& command : help.commands) {
            out += entry("  " + command.name, command.summary);
        }
    }
    if (!help.positionals.empty()) {
        out += "\nArguments:\n";
        for (OptionHelp const& p : help.positionals) {
            out += entry("  " + long_name(p), meaning_of(p));
        }
    }
    out += "\nOptions:\n";
    for (OptionHelp const& option : help.options) {
        out += entry(option);
    }
    if (!help.examples.empty()) {
        out += "\nExamples:\n";
        for (std::string const& example : help.examples) {
            out += example + "\n";
        }
    }
    return out;
}

} // namespace thalweg::tools
