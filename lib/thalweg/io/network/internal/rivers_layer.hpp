// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

class GDALDataset;
class OGRLayer;

namespace thalweg::io {

/// Throws: BadInput that lists the layers when none has lines; IoError when features cannot be read.
void require_lines(GDALDataset& data, std::string const& name, std::string const& who);

/// The layer of a source that holds its rivers. Private to this module.
/// Takes: a layer's name, or "" for the only layer with lines that is not empty; where there are several, the one whose
/// name says that it holds rivers (arcs, NHDFlowline, waterways, rivers, ...), if only one does. name: of the source,
/// for messages; who: begins them. Throws: BadInput that lists the layers: no such layer, none with lines, several of
/// which none is clearly meant; IoError when features cannot be read.
OGRLayer& rivers_layer(GDALDataset& data, std::string const& wanted, std::string const& name, std::string const& who);

} // namespace thalweg::io
