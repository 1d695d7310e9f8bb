// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/diary.hpp>

#include <fmt/format.h>

namespace thalweg::pipeline {

void Diary::say(std::string const& words) const {
    auto const& [name, seconds] = terrain_.timings_s.back();
    run_.say(fmt::format("{:<6} {:<60}{:6.1f} s", name, words, seconds));
}

} // namespace thalweg::pipeline
