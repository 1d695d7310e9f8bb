// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace thalweg {

/// Instructions a kernel is compiled for (lanes.inc): the same bytes from each.
enum class Lanes : std::uint8_t {
    plain, ///< what every processor of the architecture has
    avx2
};

/// \return the widest that this processor has.
Lanes widest_lanes();

} // namespace thalweg
