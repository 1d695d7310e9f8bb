// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <thalweg/pipeline/recipe/recipe.hpp>
#include <thalweg/pipeline/report/report.hpp>

#include "help/complete.hpp"

namespace thalweg::tools {

namespace {

/// Text in single quotes as fish reads them.
std::string fish_quoted(std::string const& text) {
    std::string out = "'";
    for (char const c : text) {
        out += c == '\'' || c == '\\' ? std::string("\\") + c : std::string(1, c);
    }
    return out + "'";
}

/// Switches of `complete` for what an option takes: nothing, or words, files, folders.
std::string switches(OptionHelp const& option) {
    switch (option.takes) {
    case Takes::nothing: return "";
    case Takes::text: return " -x";
    case Takes::word: return fmt::format(" -x -a {}", fish_quoted(fmt::format("{}", fmt::join(option.words, " "))));
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
        out += fmt::format("{} -d {}\n", switches(option), fish_quoted(option.meaning));
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

} // namespace

std::string fish_completion(CommandHelp const& program) {
    std::string keys;
    std::string values;
    for (pipeline::KeyHelp const& key : pipeline::recipe_keys()) {
        keys += fmt::format("            printf '%s\\t%s\\n' {}= {}\n", key.path, fish_quoted(key.meaning));
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
                             fish_quoted(command.summary));
        lines += lines_of(fmt::format("'__thalweg_command {}'", command.name), command);
    }
    return fmt::format("# fish completion of thalweg {}, written by: thalweg completion fish\n\n"
                       "function __thalweg_settings -d 'KEY=VALUE of a recipe'\n"
                       "    set -l setting (string replace -r '^--[a-z-]+=' '' -- (commandline -ct))\n"
                       "    switch \"$setting\"\n{}        case '*'\n{}    end\nend\n{}\n{}",
                       pipeline::version(), values, keys, fish_machine, lines);
}

} // namespace thalweg::tools
