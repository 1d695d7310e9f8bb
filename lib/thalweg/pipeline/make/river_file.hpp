// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/attributes.hpp>
#include <thalweg/core/river_lines.hpp>
#include <thalweg/pipeline/make/line_sources.hpp>

namespace thalweg::pipeline {

/// What a file of rivers holds beside the network.
struct RiverFile {
    std::vector<SecondaryLine> secondary; ///< lines that are not in the network
    std::vector<SecondaryLine> drawn;     ///< all lines as they are drawn, without reasons
    AttributeTable attributes;            ///< of all lines
    LineSources sources;                  ///< the lines in the network
};

} // namespace thalweg::pipeline
