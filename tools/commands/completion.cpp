// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>
#include <string>
#include <string_view>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <thalweg/recipe/recipe.hpp>
#include <thalweg/report/report.hpp>

#include "commands/commands.hpp"
#include "help/help.hpp"

namespace thalweg::tools {

namespace {

/// Puts a backslash before each of some characters.
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

std::string kind(OptionHelp const& option) {
    switch (option.takes) {
    case Takes::nothing: return "nothing";
    case Takes::text: return "text";
    case Takes::word: return fmt::format("words {}", fmt::join(option.words, " "));
    case Takes::file: return option.words.empty() ? "files" : fmt::format("files {}", fmt::join(option.words, " "));
    case Takes::folder: return "folders";
    case Takes::setting: return "settings";
    }
    return "";
}

/// Lines of a case: the completions after "COMMAND OPTION" or "COMMAND 1", its first positional.
std::string takes_of(CommandHelp const& command) {
    std::string out;
    for (OptionHelp const& option : command.options) {
        if (option.takes == Takes::nothing) {
            continue;
        }
        std::string names;
        for (std::string const& name : option.names) {
            names += fmt::format("{}'{} {}'", names.empty() ? "" : " | ", command.name, name);
        }
        out += fmt::format("    {}) takes={} ;;\n", names, in_single_quotes(kind(option)));
    }
    for (std::size_t i = 0; i < command.positionals.size(); ++i) {
        std::string const place = command.positionals[i].repeats ? "*" : "";
        out += fmt::format("    '{} '{}) takes={} ;;\n", command.name,
                           place.empty() ? std::to_string(i + 1) : place + "[0-9]",
                           in_single_quotes(kind(command.positionals[i])));
    }
    return out;
}

std::string offers_of(CommandHelp const& command) {
    std::string names;
    for (OptionHelp const& option : command.options) {
        names += fmt::format("{}{}", names.empty() ? "" : " ", fmt::join(option.names, " "));
    }
    return fmt::format("    {}) offers='{}' ;;\n", command.name, names);
}

constexpr char const* bash_machine = R"sh(
_thalweg_reply() { # the words given that begin with $current
    local answer
    while IFS= read -r answer; do
        COMPREPLY+=("$answer")
    done < <(compgen -W "$*" -- "$current")
}

_thalweg_files() { # folders, and files with one of the suffixes given, or all
    local answer suffix
    compopt -o filenames 2>/dev/null
    while IFS= read -r answer; do
        COMPREPLY+=("$answer")
    done < <(
        compgen -d -- "$current"
        [[ $# -gt 0 ]] || compgen -f -- "$current" | while IFS= read -r answer; do
            [[ -d $answer ]] || printf '%s\n' "$answer"
        done
        for suffix; do
            compgen -f -X "!*.$suffix" -- "$current"
        done
    )
}

_thalweg_settings() { # KEY=VALUE of a recipe
    if [[ $current != *=* ]]; then
        compopt -o nospace 2>/dev/null
        _thalweg_reply "$thalweg_keys"
        return
    fi
    local key=${current%%=*}
    current=${current#*=}
    [[ $COMP_WORDBREAKS == *=* ]] || before=$key=
    _thalweg_values "$key"
}

_thalweg() {
    local IFS=$' \t\n' rest=$COMP_LINE command=thalweg option= current= before= takes= offers= place=0 joins= word i
    local words=()
    # Bash takes words apart at = and : and those with no blank between are put together again.
    for ((i = 0; i <= COMP_CWORD; ++i)); do
        word=${COMP_WORDS[i]}
        [[ $rest != [[:space:]]* ]] || joins=
        rest=${rest#"${rest%%[![:space:]]*}"}
        rest=${rest#"$word"}
        if [[ $joins && ($joins == sign || $word =~ ^[=:]+$) ]]; then
            words[${#words[@]}-1]+=$word
        else
            words+=("$word")
        fi
        joins=word
        [[ ! $word =~ ^[=:]+$ ]] || joins=sign
    done
    current=${words[${#words[@]}-1]}
    unset "words[${#words[@]}-1]"
    for word in "${words[@]:1}"; do
        if [[ $option ]]; then
            option=
        elif [[ $word == --*=* ]]; then
            continue
        elif [[ $word == -* ]]; then
            _thalweg_takes "$command $word"
            [[ $takes == nothing ]] || option=$word
        elif [[ $command == thalweg ]]; then
            command=$word
        else
            ((++place))
        fi
    done
    COMPREPLY=()
    if [[ ! $option && $current == --*=* ]]; then
        option=${current%%=*}
        current=${current#*=}
        [[ $COMP_WORDBREAKS == *=* ]] || before=$option=
    fi
    if [[ $option ]]; then
        _thalweg_takes "$command $option"
    else
        _thalweg_takes "$command $((place + 1))"
        [[ $current != -* && ($takes != nothing || $current) ]] || takes=options
    fi
    case $takes in
    options)
        _thalweg_offers "$command"
        _thalweg_reply "$offers"
        ;;
    words\ *) _thalweg_reply "${takes#words }" ;;
    files*) _thalweg_files ${takes#files} ;;
    folders) _thalweg_files / ;; # a suffix that no file has
    settings) _thalweg_settings ;;
    esac
    if [[ $before ]]; then
        COMPREPLY=("${COMPREPLY[@]/#/$before}")
    fi
}

complete -F _thalweg thalweg
)sh";

std::string bash_completion(CommandHelp const& program) {
    std::string names;
    std::string offers = offers_of(program);
    std::string takes = takes_of(program);
    for (CommandHelp const& command : program.commands) {
        names += (names.empty() ? "" : " ") + command.name;
        offers += offers_of(command);
        takes += takes_of(command);
    }
    std::string keys;
    std::string values;
    for (recipe::KeyHelp const& key : recipe::recipe_keys()) {
        keys += fmt::format("{}{}=", keys.empty() ? "" : " ", key.path);
        if (!key.choices.empty()) {
            values += fmt::format("    {}) _thalweg_reply '{}' ;;\n", key.path, fmt::join(key.choices, " "));
        } else if (key.is_file) {
            values += fmt::format("    {}) _thalweg_files ;;\n", key.path);
        }
    }
    return fmt::format("# bash completion of thalweg {}, written by: thalweg completion bash\n\n"
                       "thalweg_keys='{}'\n\n"
                       "_thalweg_values() {{ # what a key of a recipe may be\n    case $1 in\n{}    esac\n}}\n\n"
                       "_thalweg_offers() {{ # the options of a command\n    case $1 in\n{}    esac\n}}\n\n"
                       "_thalweg_takes() {{ # what stands behind an option, or at a place, of a command\n"
                       "    takes=nothing\n    case $1 in\n    'thalweg 1') takes='words {}' ;;\n{}    esac\n}}\n{}",
                       report::version(), keys, values, offers, names, takes, bash_machine);
}

/// Text in single quotes for fish.
std::string fish_in_single_quotes(std::string const& text) {
    return "'" + escaped(text, "'\\") + "'";
}

/// Switches of `complete` for an option's argument: none, words, files or folders.
std::string switches(OptionHelp const& option) {
    switch (option.takes) {
    case Takes::nothing: return "";
    case Takes::text: return " -x";
    case Takes::word:
        return fmt::format(" -x -a {}", fish_in_single_quotes(fmt::format("{}", fmt::join(option.words, " "))));
    case Takes::file:
        return option.words.empty()
                   ? " -r -F"
                   : fmt::format(" -x -k -a '(__fish_complete_suffix .{})'", fmt::join(option.words, " ."));
    case Takes::folder: return " -x -a '(__fish_complete_directories)'";
    case Takes::setting: return " -x -a '(__thalweg_settings)'";
    }
    return "";
}

std::string lines_of(std::string const& when, CommandHelp const& command) {
    std::string out;
    for (OptionHelp const& option : command.options) {
        out += "complete -c thalweg -n " + when;
        for (std::string const& name : option.names) {
            out += name.rfind("--", 0) == 0 ? " -l " + name.substr(2) : " -s " + name.substr(1);
        }
        out += fmt::format("{} -d {}\n", switches(option), fish_in_single_quotes(option.meaning));
    }
    for (OptionHelp const& p : command.positionals) {
        if (p.takes != Takes::text) { // an -x without -a would be an option without a name
            std::string how = switches(p);
            how = how.rfind(" -x", 0) == 0 ? how.substr(3) : " -F";
            out += fmt::format("complete -c thalweg -n {}{}\n", when, how);
        }
    }
    return out;
}

constexpr char const* fish_machine = R"sh(
function __thalweg_command -d 'Whether the command is the one given, or none is'
    set -l words (commandline -opc)
    test "$words[2]" = "$argv[1]"
end

complete -c thalweg -f
)sh";

std::string fish_completion(CommandHelp const& program) {
    std::string keys;
    std::string values;
    for (recipe::KeyHelp const& key : recipe::recipe_keys()) {
        keys += fmt::format("            printf '%s\\t%s\\n' {}= {}\n", key.path, fish_in_single_quotes(key.meaning));
        if (!key.choices.empty()) {
            values += fmt::format("        case '{}=*'\n            printf '%s\\n' {}={}\n", key.path, key.path,
                                  fmt::join(key.choices, fmt::format(" {}=", key.path)));
        } else if (key.is_file) {
            values += fmt::format("        case '{}=*'\n            __fish_complete_path "
                                  "(string replace -r '^[^=]*=' '' -- $setting) | string replace -r '^' '{}='\n",
                                  key.path, key.path);
        }
    }
    std::string lines = lines_of("__thalweg_command", program);
    for (CommandHelp const& command : program.commands) {
        lines += fmt::format("\ncomplete -c thalweg -n __thalweg_command -a {} -d {}\n", command.name,
                             fish_in_single_quotes(command.summary));
        lines += lines_of(fmt::format("'__thalweg_command {}'", command.name), command);
    }
    return fmt::format("# fish completion of thalweg {}, written by: thalweg completion fish\n\n"
                       "function __thalweg_settings -d 'KEY=VALUE of a recipe'\n"
                       "    set -l setting (string replace -r '^--[a-z-]+=' '' -- (commandline -ct))\n"
                       "    switch \"$setting\"\n{}        case '*'\n{}    end\nend\n{}\n{}",
                       report::version(), values, keys, fish_machine, lines);
}

/// An action of _arguments.
std::string action(OptionHelp const& option) {
    switch (option.takes) {
    case Takes::word: return fmt::format("({})", fmt::join(option.words, " "));
    case Takes::file:
        // *.(toml) would be read as a glob qualifier.
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

/// One spec of _arguments per option: its names exclude one another unless it repeats.
std::string spec(OptionHelp const& option) {
    bool const flag = option.takes == Takes::nothing;
    std::string const tail =
        fmt::format("[{}]{}", escaped(option.meaning, "[]:\\"),
                    flag ? "" : fmt::format(":{}:{}", escaped(option.placeholder, ":\\"), action(option)));
    std::string const others = option.repeats ? "*" : fmt::format("({})", fmt::join(option.names, " "));
    std::string out;
    for (std::string const& name : option.names) {
        std::string const joint = flag ? "" : name.rfind("--", 0) == 0 ? "=" : "+";
        out += fmt::format(" \\\n        {}", in_single_quotes(fmt::format("{}{}{}{}", others, name, joint, tail)));
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
                           in_single_quotes(fmt::format("{}:{}:{}", place, escaped(long_name(p), ":\\"), action(p))));
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

std::string zsh_completion(CommandHelp const& program) {
    std::string commands;
    std::string functions;
    for (CommandHelp const& command : program.commands) {
        commands += "    " + in_single_quotes(escaped(command.name, ":\\") + ":" + command.summary) + "\n";
        functions += function_of(command);
    }
    std::string options;
    for (OptionHelp const& option : program.options) {
        for (std::string const& name : option.names) {
            options +=
                "    " + in_single_quotes(fmt::format("(- *){}[{}]", name, escaped(option.meaning, "[]:\\"))) + "\n";
        }
    }
    std::string keys;
    std::string values;
    for (recipe::KeyHelp const& key : recipe::recipe_keys()) {
        keys += "    " + in_single_quotes(key.path + ":" + key.meaning) + "\n";
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
                       report::version(), commands, options, keys, values, functions,
                       std::string(zsh_machine).substr(1));
}

} // namespace

Command add_completion(CLI::App& app) {
    auto const shell = std::make_shared<std::string>();
    app.add_option("SHELL", *shell, "The shell.")->required()->check(CLI::IsMember({"bash", "zsh", "fish"}));
    app.footer("The script completes commands, options and their values, files and recipe keys. An installed thalweg "
               "includes it; from a build, source it.\n\n"
               "Examples:\n"
               "  source <(thalweg completion bash)\n"
               "  thalweg completion fish > ~/.config/fish/completions/thalweg.fish\n");
    return [shell, &app] {
        CommandHelp const program = describe(*app.get_parent());
        fmt::print("{}", *shell == "bash"  ? bash_completion(program)
                         : *shell == "zsh" ? zsh_completion(program)
                                           : fish_completion(program));
        return static_cast<int>(Exit::done);
    };
}

} // namespace thalweg::tools
