// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "help/complaint.hpp"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <thalweg/core/run/messages.hpp>

#include "help/describe.hpp"

namespace thalweg::tools {

namespace {

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
