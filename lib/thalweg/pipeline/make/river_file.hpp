// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/river_files.hpp>
#include <thalweg/pipeline/make/line_sources.hpp>

namespace thalweg::pipeline {

/// What a file of rivers holds beside the network.
struct RiverFile {
    std::vector<SecondaryLine> secondary; ///< lines that are not in the network
    AttributeTable attributes;            ///< of all lines
    LineSources sources;                  ///< the lines in the network
    StreamNetwork adopted;                ///< the network that was made of them, before outlets are carried
    double taken_m = 0.0;                 ///< [m] of the lines from which it was made, copies among them
    double lengthened = 1.0;              ///< by bends: length of the adopted network / that as it was drawn
};

} // namespace thalweg::pipeline
