// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>

#include <thalweg/core/run/run.hpp>

namespace thalweg {

/// Calls body(begin, end) on disjoint ranges that tile [0, count), on run.threads workers.
/// \post the same result for any number of threads when the body writes only its own range.
/// \pre a body whose ranges do not depend on one another.
/// \param run progress, log, stop token and number of threads
/// \param count how many
/// \param grain least length of a range (but for the last)
/// \param body called with the begin and end of a range
/// \throws Error what the body throws
/// \throws Cancelled
void parallel_ranges(Run const& run, std::int64_t count, std::int64_t grain,
                     std::function<void(std::int64_t, std::int64_t)> const& body);

} // namespace thalweg
