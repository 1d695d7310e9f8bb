// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace thalweg::io {

/// The letters, in lower case, and digits of a name: "US survey foot", "us_survey_foot" and "US-survey-foot" are one.
std::string simple_name(std::string_view name);

} // namespace thalweg::io
