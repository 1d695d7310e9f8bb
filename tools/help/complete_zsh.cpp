// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <thalweg/pipeline/recipe/recipe.hpp>
#include <thalweg/pipeline/report/report.hpp>

#include "help/complete.hpp"

namespace thalweg::tools {

namespace {

/// With a backslash before each of some characters.
std::string escaped(std::string const& text, std::string_view characters) {
    std::string out;
    for (char const c : text) {
        if (characters.find(c) != std::string_view::npos) {
            out += '\\';
        }
        out += c;
    }
    return out;
}

/// An action of _arguments.
std::string action(OptionHelp const& option) {
    switch (option.takes) {
    case Takes::word: return fmt::format("({})", fmt::join(option.words, " "));
    case Takes::file:
        // *.(toml) would be read as qualifiers of the pattern.
        return option.words.empty()       ? "_files"
               : option.words.size() == 1 ? fmt::format("_files -g \"*.{}\"", option.words.front())
                                          : fmt::format("_files -g \"*.({})\"", fmt::join(option.words, "|"));
    case Takes::folder: return "_files -/";
    case Takes::setting: return "_thalweg_settings";
    case Takes::nothing:
    case Takes::text: return " ";
    }
    return "";
}

/// One spec of _arguments an option: its names exclude one another unless it repeats.
std::string spec(OptionHelp const& option) {
    bool const flag = option.takes == Takes::nothing;
    std::string const tail =
        fmt::format("[{}]{}", escaped(option.meaning, "[]:\\"),
                    flag ? "" : fmt::format(":{}:{}", escaped(option.placeholder, ":\\"), action(option)));
    std::string const others = option.repeats ? "*" : fmt::format("({})", fmt::join(option.names, " "));
    std::string out;
    for (std::string const& name : option.names) {
        std::string const joint = flag ? "" : name.rfind("--", 0) == 0 ? "=" : "+";
        out += fmt::format(" \\\n        {}", quoted(fmt::format("{}{}{}{}", others, name, joint, tail)));
    }
    return out;
}

std::string function_of(CommandHelp const& command) {
    std::string out = fmt::format("_thalweg_{}() {{\n    _arguments -s -S", command.name);
    for (OptionHelp const& option : command.options) {
        out += spec(option);
    }
    for (std::size_t i = 0; i < command.positionals.size(); ++i) {
        OptionHelp const& p = command.positionals[i];
        std::string const place = p.repeats ? "*" : fmt::format("{}{}", i + 1, p.required ? "" : ":");
        out += fmt::format(" \\\n        {}",
                           quoted(fmt::format("{}:{}:{}", place, escaped(long_name(p), ":\\"), action(p))));
    }
    return out + "\n}\n\n";
}

constexpr char const* zsh_machine = R"sh(
_thalweg_settings() {
    if compset -P '*='; then
        local key=${${IPREFIX%=}##*=}
        _thalweg_values $key
    else
        _describe -t keys 'key of a recipe' thalweg_keys -S =
    fi
}

_thalweg() {
    local curcontext=$curcontext state line
    local -A opt_args
    _arguments -C $thalweg_options '(-)1:command:->command' '(-)*::argument:->argument'
    case $state in
    command) _describe -t commands command thalweg_commands ;;
    argument)
        curcontext=${curcontext%:*:*}:thalweg-$words[1]:
        (( $+functions[_thalweg_$words[1]] )) && _thalweg_$words[1]
        ;;
    esac
}

# Found in $fpath the file is the function's body; sourced, it registers the function.
if [[ $funcstack[1] == _thalweg ]]; then
    _thalweg "$@"
else
    compdef _thalweg thalweg
fi
)sh";

} // namespace

std::string zsh_completion(CommandHelp const& program) {
    std::string commands;
    std::string functions;
    for (CommandHelp const& command : program.commands) {
        commands += "    " + quoted(escaped(command.name, ":\\") + ":" + command.summary) + "\n";
        functions += function_of(command);
    }
    std::string options;
    for (OptionHelp const& option : program.options) {
        for (std::string const& name : option.names) {
            options += "    " + quoted(fmt::format("(- *){}[{}]", name, escaped(option.meaning, "[]:\\"))) + "\n";
        }
    }
    std::string keys;
    std::string values;
    for (pipeline::KeyHelp const& key : pipeline::recipe_keys()) {
        keys += "    " + quoted(key.path + ":" + key.meaning) + "\n";
        if (!key.choices.empty()) {
            values += fmt::format("    {}) compadd -- {} ;;\n", key.path, fmt::join(key.choices, " "));
        } else if (key.is_file) {
            values += fmt::format("    {}) _files ;;\n", key.path);
        }
    }
    return fmt::format("#compdef thalweg\n# zsh completion of thalweg {}, written by: thalweg completion zsh\n\n"
                       "typeset -ga thalweg_commands thalweg_options thalweg_keys\n"
                       "thalweg_commands=(\n{})\nthalweg_options=(\n{})\nthalweg_keys=(\n{})\n\n"
                       "_thalweg_values() {{ # what a key of a recipe may be\n    case $1 in\n{}    esac\n}}\n\n{}{}",
                       pipeline::version(), commands, options, keys, values, functions,
                       std::string(zsh_machine).substr(1));
}

} // namespace thalweg::tools
