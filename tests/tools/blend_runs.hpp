// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "command.hpp"
#include "refused.hpp"

namespace blend_runs {

inline Outcome blend(Workplace const& place, std::string const& arguments) {
    return thalweg_run("blend " + arguments, place.path());
}

/// Exit 2, the words in the message, nothing written.
inline void refused(Workplace const& place, std::string const& arguments, std::string const& words) {
    expect_refused(place, "blend " + arguments, words);
}

} // namespace blend_runs
