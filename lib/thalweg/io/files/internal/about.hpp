// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace thalweg::io {

/// What the errors of a call are about.
struct About {
    std::string where; ///< the public function that was called: "io.read_dem"
    std::string name;  ///< of the file, layer or database, for messages: "out/dem.tif"; "": the call has none

    /// How a message begins: "out/dem.tif: ", or "" without a name.
    std::string beginning() const { return name.empty() ? "" : name + ": "; }
};

} // namespace thalweg::io
