// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <thalweg/pipeline/plan/plan.hpp>

namespace thalweg::tools {

/// A forecast as lines of words, or as one JSON object: stages, grid (null where it is unknown), cells, memory_bytes,
/// seconds.
std::string forecast_in_words(pipeline::Forecast const& forecast, bool json);

} // namespace thalweg::tools
