// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>

#include <thalweg/core/run/run.hpp>

namespace thalweg {

/// Calls body(begin, end) on disjoint ranges that tile [0, count), on run.threads workers. The result does not depend
/// on the number of threads if body writes only its own range.
/// \pre The ranges do not depend on one another.
/// \param run progress, log, stop token and number of threads
/// \param count end of the last range
/// \param grain minimum length of a range (except the last)
/// \param body called with the begin and end of a range
/// \throws Error what body throws
/// \throws Cancelled
void parallel_ranges(Run const& run, std::int64_t count, std::int64_t grain,
                     std::function<void(std::int64_t, std::int64_t)> const& body);

} // namespace thalweg
