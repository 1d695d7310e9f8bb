// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

namespace thalweg::draw {

enum class Format : std::uint8_t { png, svg, pdf };

/// A finished picture, ready to be written to a file. The same input gives the same bytes on one machine: text uses its
/// fonts (DejaVu Sans, then Noto Sans CJK if installed).
struct Picture {
    std::string bytes;
    Format format = Format::png;
};

} // namespace thalweg::draw
