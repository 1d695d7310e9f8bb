// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/run.hpp>

#include <thalweg/core/error.hpp>

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

} // namespace thalweg
