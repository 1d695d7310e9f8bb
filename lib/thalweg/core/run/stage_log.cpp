// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/run/stage_log.hpp>

#include <fmt/format.h>

namespace thalweg {

void StageLog::say(std::string const& words) const {
    StageTime const& last = timings_s_.back();
    run_.tell(last.stage, fmt::format("{:<56}{:6.1f} s", words, last.wall_s));
}

StageLog::~StageLog() {
    if (std::uncaught_exceptions() > exceptions_) {
        try {
            run_.report(findings_);
        } catch (...) { // the error that ends the work says more
        }
    }
}

} // namespace thalweg
