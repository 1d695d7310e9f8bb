// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/plan/internal/plan.hpp>

#include <fmt/format.h>

namespace thalweg::pipeline {

void Diary::say(std::string const& words) const {
    auto const& [name, seconds] = timings_s_.back();
    run_.tell(name, fmt::format("{:<56}{:6.1f} s", words, seconds));
}

} // namespace thalweg::pipeline
