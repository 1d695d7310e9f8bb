// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "help/describe.hpp"

namespace thalweg::tools {

/// A page of the manual in man(7), plain ASCII, without a date.
struct ManPage {
    std::string name; ///< thalweg-make
    char section;     ///< '1' a command, '5' a file format
    std::string roff;
};

/// thalweg(1), one page a command, and thalweg-recipe(5). They follow from the parser's description and the keys of a
/// recipe.
std::vector<ManPage> man_pages(CommandHelp const& program);

} // namespace thalweg::tools
