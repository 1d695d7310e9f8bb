// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/run/run.hpp>

#include <algorithm>
#include <string>

#include <thalweg/core/run/error.hpp>

namespace thalweg {

void Run::check() const {
    if (stop.stop_requested()) {
        throw Cancelled("interrupted");
    }
}

void Run::at(double share, char const* what) const {
    check();
    if (progress != nullptr && progress(share, what, progress_arg) == 0) {
        throw Cancelled("interrupted");
    }
}

void Run::tell(std::string_view stage, std::string_view words) const {
    constexpr std::size_t column = 10; // the longest name of a stage: catchments
    std::string line(stage);
    line.append(std::max(column, stage.size()) - stage.size() + 1, ' ');
    say(line.append(words));
}

} // namespace thalweg
