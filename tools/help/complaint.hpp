// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace thalweg::tools {

/// What is wrong with a command line that the parser refused for a reason, and what was probably meant: an unknown
/// command, an unknown option, or a value that is none of an option's choices; else the reason. Ends with where to
/// read more. words: the command line without the program's name.
std::string complaint(CLI::App const& app, std::vector<std::string> const& words, std::string const& reason);

} // namespace thalweg::tools
