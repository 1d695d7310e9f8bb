// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace thalweg::pipeline {

/// What takes the place of a page's markers, byte for byte: it must be safe where it comes to stand.
struct PageParts {
    std::string title;   ///< for @@TITLE@@
    std::string data;    ///< for @@DATA@@
    std::string heights; ///< for @@HEIGHTS@@
    std::string lines;   ///< for @@LINES@@
};

/// A page with its markers replaced.
/// Gives: each marker's part where the page holds it; what looks like a marker in a part stays as it is.
/// Throws: std::logic_error when the page does not hold each of the four markers exactly once: it was built wrongly.
std::string fill_page(std::string_view page, PageParts const& parts);

} // namespace thalweg::pipeline
