// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace thalweg {

/// \return memory [bytes] that can still be taken: what the system has available, or what is left of the control
/// group's limit.
std::int64_t free_memory_bytes();

/// \return most memory [bytes] this process has held so far.
std::int64_t peak_memory_bytes();

} // namespace thalweg
