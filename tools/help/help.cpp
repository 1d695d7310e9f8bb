// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "help/help.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <thalweg/core/run/messages.hpp>

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
        std::string const all = fmt::format("{}", fmt::join(option.words, "|"));
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

bool holds(std::vector<std::string> const& words, std::string const& word) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

OptionHelp const* find_option(CommandHelp const& command, std::string const& name) {
    auto const& options = command.options;
    auto const at =
        std::find_if(options.begin(), options.end(), [&](OptionHelp const& o) { return holds(o.names, name); });
    return at == options.end() ? nullptr : &*at;
}

/// The short option that a word of letters, "-qo", begins with: "-q".
std::string option_name(std::string const& word) {
    return word.rfind("--", 0) == 0 ? word.substr(0, word.find('=')) : word.substr(0, 2);
}

std::string unknown_command(CommandHelp const& program, std::string const& word) {
    std::vector<std::string> names;
    for (CommandHelp const& command : program.commands) {
        names.push_back(command.name);
    }
    std::string const meant = did_you_mean(word, names);
    return fmt::format("thalweg has no command '{}'.{}", word,
                       meant.empty() ? fmt::format(" Its commands are {}.", fmt::join(names, ", ")) : meant);
}

/// Short options are one letter off each other: only another case, or two dashes that became one, is a likely slip.
std::string meant_short(std::vector<std::string> const& names, std::string const& word) {
    if (word.size() == 2) {
        for (std::string const& name : names) {
            if (name.size() == 2 && std::tolower(name[1]) == std::tolower(word[1])) {
                return fmt::format(" Did you mean '{}'?", name);
            }
        }
        return "";
    }
    return did_you_mean(fmt::format("-{}", word.substr(0, word.find('='))), names);
}

std::string unknown_option(CommandHelp const& command, CommandHelp const& program, std::string const& word) {
    std::vector<std::string> names;
    for (OptionHelp const& option : command.options) {
        names.insert(names.end(), option.names.begin(), option.names.end());
    }
    bool const is_long = word.rfind("--", 0) == 0;
    std::string const name = is_long ? option_name(word) : word;
    std::string meant = is_long ? did_you_mean(name, names) : meant_short(names, word);
    bool const of_a_command = &command == &program && std::any_of(program.commands.begin(), program.commands.end(),
                                                                  [&](auto const& c) { return find_option(c, name); });
    if (of_a_command) {
        meant = " Options follow the command.";
    }
    return fmt::format("{} has no option '{}'.{}", &command == &program ? "thalweg" : "thalweg " + command.name, name,
                       meant);
}

/// What is wrong with the value of a choice, or "".
std::string wrong_choice(OptionHelp const& option, std::string const& value) {
    if (option.takes != Takes::word || holds(option.words, value)) {
        return "";
    }
    return fmt::format("{} is one of {}, not '{}'.{}", long_name(option), fmt::join(option.words, ", "), value,
                       did_you_mean(value, option.words));
}

/// Walks as the parser does: values of options are no commands.
std::string fault(CommandHelp const& program, std::vector<std::string> const& words, CommandHelp const*& at) {
    std::size_t place = 0;
    for (std::size_t i = 0; i < words.size(); ++i) {
        std::string const& word = words[i];
        if (word == "--") {
            return "";
        }
        if (word.size() > 1 && word.front() == '-' && std::isdigit(static_cast<unsigned char>(word[1])) == 0) {
            OptionHelp const* const option = find_option(*at, option_name(word));
            if (option == nullptr) {
                return unknown_option(*at, program, word);
            }
            bool const is_long = word.rfind("--", 0) == 0;
            bool const glued = is_long ? word.find('=') != std::string::npos : word.size() > 2;
            if (option->takes == Takes::nothing) {
                continue;
            }
            if (!glued && i + 1 == words.size()) {
                return fmt::format("thalweg {} {} is missing its {}.", at->name, option->names.back(),
                                   option->placeholder);
            }
            std::string const value = !glued ? words[++i] : is_long ? word.substr(word.find('=') + 1) : word.substr(2);
            if (std::string const wrong = wrong_choice(*option, value); !wrong.empty()) {
                return wrong;
            }
        } else if (at == &program) {
            auto const found = std::find_if(program.commands.begin(), program.commands.end(),
                                            [&](CommandHelp const& c) { return c.name == word; });
            if (found == program.commands.end()) {
                return unknown_command(program, word);
            }
            at = &*found;
        } else if (place < at->positionals.size()) {
            OptionHelp const& positional = at->positionals[place];
            place += positional.repeats ? 0 : 1;
            if (std::string const wrong = wrong_choice(positional, word); !wrong.empty()) {
                return wrong;
            }
        } else {
            return fmt::format("'{}' is one word too many for thalweg {}.", word, at->name);
        }
    }
    return "";
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

std::string complaint(CLI::App const& app, std::vector<std::string> const& words, std::string const& reason) {
    CommandHelp const program = describe(app);
    CommandHelp const* at = &program;
    std::string text = fault(program, words, at);
    if (text.empty()) {
        text = reason + ".";
    }
    return fmt::format("{} See thalweg {}--help.", text, at == &program ? "" : at->name + " ");
}

} // namespace thalweg::tools
