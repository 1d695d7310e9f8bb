// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>

#include <thalweg/core/run/run.hpp>

namespace thalweg {

/// Calls body(begin, end) on disjoint ranges that tile [0, count), on run.threads workers.
/// Takes: a body whose ranges do not depend on one another. grain: least length of a range (but for the last).
/// Gives: the same result for any number of threads when the body writes only its own range.
/// Throws: what the body throws; Cancelled.
void parallel_ranges(Run const& run, std::int64_t count, std::int64_t grain,
                     std::function<void(std::int64_t, std::int64_t)> const& body);

} // namespace thalweg
