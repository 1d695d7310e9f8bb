// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "help/describe.hpp"

namespace thalweg::tools {

/// A script that completes thalweg's commands, options and what they take, in the shell named. They follow from the
/// parser's description and, for KEY=VALUE, from the keys of a recipe.
std::string bash_completion(CommandHelp const& program);
std::string zsh_completion(CommandHelp const& program);
std::string fish_completion(CommandHelp const& program);

/// Text in single quotes for a POSIX shell.
std::string quoted(std::string const& text);

} // namespace thalweg::tools
