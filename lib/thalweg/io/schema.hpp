// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace thalweg::io {

/// Whose words and units a network's fields are in.
enum class Schema : std::uint8_t { native, taudem, nhdplus, hydrorivers, grass };

} // namespace thalweg::io
