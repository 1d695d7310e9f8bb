// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace thalweg {

/// Memory that this process can still take.
/// \return [bytes] the system's available memory, or what the control group's limit leaves
std::int64_t free_memory_bytes();

/// The process's peak memory.
/// \return [bytes]
std::int64_t peak_memory_bytes();

} // namespace thalweg
