// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <thalweg/pipeline/recipe/recipe.hpp>
#include <thalweg/pipeline/report/report.hpp>

#include "help/complete.hpp"

namespace thalweg::tools {

namespace {

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

/// Lines of a case: what stands behind "COMMAND OPTION" or "COMMAND 1", its first positional.
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
        out += fmt::format("    {}) takes={} ;;\n", names, quoted(kind(option)));
    }
    for (std::size_t i = 0; i < command.positionals.size(); ++i) {
        std::string const place = command.positionals[i].repeats ? "*" : "";
        out +=
            fmt::format("    '{} '{}) takes={} ;;\n", command.name,
                        place.empty() ? std::to_string(i + 1) : place + "[0-9]", quoted(kind(command.positionals[i])));
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

} // namespace

std::string quoted(std::string const& text) {
    std::string out = "'";
    for (char const c : text) {
        out += c == '\'' ? "'\\''" : std::string(1, c);
    }
    return out + "'";
}

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
    for (pipeline::KeyHelp const& key : pipeline::recipe_keys()) {
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
                       pipeline::version(), keys, values, offers, names, takes, bash_machine);
}

} // namespace thalweg::tools
