// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace thalweg::tools {

/// What an option or a positional takes, as far as a shell can help with it.
enum class Takes { nothing, text, word, file, folder, setting };

/// An option, or a positional, in plain words.
struct OptionHelp {
    std::vector<std::string> names; ///< "-o", "--output"; the one name of a positional
    std::string placeholder;        ///< "DIR"; "" for a flag
    std::string meaning;
    std::string standard; ///< the default; "" for none
    Takes takes = Takes::nothing;
    std::vector<std::string> words; ///< what can be chosen; of files their suffixes without the dot, none for any file
    bool required = false;
    bool repeats = false; ///< may be given more than once
};

/// A command in plain words; the program itself is one too.
struct CommandHelp {
    std::string name;
    std::string summary; ///< one sentence
    std::string text;    ///< paragraphs with an empty line between; "" for none
    std::vector<std::string> examples;
    std::vector<OptionHelp> options;
    std::vector<OptionHelp> positionals;
    std::vector<CommandHelp> commands; ///< of the program; a command has none
};

/// Reads a parser: whatever is added to it is in its help, its completions and its manual by itself.
/// What an option takes is told by its type name: FILE, FILE(toml,json), DIR or KEY=VALUE (of a recipe); choices are
/// found by CLI::IsMember. The command's footer is its text; below a line "Examples:" each line is an example.
CommandHelp describe(CLI::App const& app);

/// The names of an option's longest form first: "--output", or the positional's name.
std::string const& long_name(OptionHelp const& option);

/// Text broken into lines of at most width characters, each after the first with an indent.
std::string wrapped(std::string const& text, std::size_t width, std::size_t indent);

/// What --help prints.
std::string help_text(CLI::App const& app);

/// What is wrong with a command line that the parser refused for a reason, and what was probably meant: an unknown
/// command, an unknown option, or a value that is none of an option's choices; else the reason. Ends with where to
/// read more. words: the command line without the program's name.
std::string complaint(CLI::App const& app, std::vector<std::string> const& words, std::string const& reason);

} // namespace thalweg::tools
