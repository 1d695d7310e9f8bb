// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace thalweg::pipeline {

/// What stages took [s], in their order.
using Timings = std::vector<std::pair<std::string, double>>;

} // namespace thalweg::pipeline
