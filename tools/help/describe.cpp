// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "help/describe.hpp"

#include <algorithm>
#include <string_view>

#include <CLI/CLI.hpp>

namespace thalweg::tools {

namespace {

std::vector<std::string> split(std::string_view text, char at) {
    std::vector<std::string> parts;
    while (!text.empty()) {
        std::size_t const end = std::min(text.find(at), text.size());
        if (end > 0) {
            parts.emplace_back(text.substr(0, end));
        }
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return parts;
}

/// What stands between two marks of a text, or "".
std::string between(std::string const& text, char begin, char end) {
    auto const from = text.find(begin);
    auto const to = text.find(end, from == std::string::npos ? 0 : from);
    return from == std::string::npos || to == std::string::npos ? "" : text.substr(from + 1, to - from - 1);
}

std::string joined(std::vector<std::string> const& words, char with) {
    std::string all;
    for (std::string const& word : words) {
        all += (all.empty() ? "" : std::string(1, with)) + word;
    }
    return all;
}

/// From CLI11's type name: "UINT", "TEXT:{a,b}", "INT:INT in [0 - 9]", "FILE(toml)".
void read_type(std::string const& type, OptionHelp& option) {
    std::string const head = type.substr(0, type.find_first_of(":({"));
    option.takes = Takes::text;
    option.placeholder = head;
    if (auto const choices = type.find(":{"); choices != std::string::npos) {
        option.takes = Takes::word;
        for (std::string const& choice : split(between(type.substr(choices), '{', '}'), ',')) {
            option.words.push_back(choice.substr(0, choice.find("->"))); // of a map: the key
        }
        constexpr std::size_t longest = 40;
        std::string const all = joined(option.words, '|');
        option.placeholder = all.size() <= longest ? all : "WORD";
    } else if (head == "FILE") {
        option.takes = Takes::file;
        option.words = split(between(type, '(', ')'), ',');
    } else if (head == "DIR") {
        option.takes = Takes::folder;
    } else if (head == "KEY=VALUE") {
        option.takes = Takes::setting;
    } else if (head == "INT" || head == "UINT") {
        option.placeholder = "N";
    } else if (head == "FLOAT") {
        option.placeholder = "X";
    }
}

OptionHelp describe(CLI::Option const& option) {
    OptionHelp help;
    help.meaning = option.get_description();
    help.standard = option.get_default_str();
    help.required = option.get_required();
    help.repeats = option.get_multi_option_policy() == CLI::MultiOptionPolicy::TakeAll || option.get_expected_max() > 1;
    if (option.get_items_expected_max() > 0) {
        read_type(option.get_type_name(), help);
    }
    if (option.get_positional()) {
        help.names = {option.get_name(true)};
        return help;
    }
    for (std::string const& name : option.get_snames()) {
        help.names.push_back("-" + name);
    }
    for (std::string const& name : option.get_lnames()) {
        help.names.push_back("--" + name);
    }
    return help;
}

} // namespace

CommandHelp describe(CLI::App const& app) {
    CommandHelp help;
    help.name = app.get_name();
    help.summary = app.get_description();
    std::string const footer = app.get_footer();
    constexpr std::string_view examples = "Examples:\n";
    auto const at = footer.find(examples);
    help.text = footer.substr(0, std::min(at, footer.size()));
    while (!help.text.empty() && help.text.back() == '\n') {
        help.text.pop_back();
    }
    if (at != std::string::npos) {
        help.examples = split(std::string_view(footer).substr(at + examples.size()), '\n');
    }
    for (CLI::Option const* option : app.get_options()) {
        (option->get_positional() ? help.positionals : help.options).push_back(describe(*option));
    }
    for (CLI::App const* command : app.get_subcommands(nullptr)) {
        help.commands.push_back(describe(*command));
    }
    return help;
}

std::string const& long_name(OptionHelp const& option) {
    return option.names.back();
}

} // namespace thalweg::tools
