// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <exception>

#include <thalweg/core/run/run.hpp>

namespace thalweg::io {

/// Carries a Run through GDAL, which knows no exceptions: pass &Watch::step and the watch as GDAL's progress function
/// and argument, then call settle() before asking GDAL whether it worked.
class Watch {
public:
    Watch(Run const& run, char const* what) : run_(run), what_(what) {}

    static int step(double share, char const* /*message*/, void* watch) {
        auto& self = *static_cast<Watch*>(watch);
        try {
            self.run_.at(share, self.what_);
            return 1;
        } catch (...) {
            self.stopped_ = std::current_exception();
            return 0;
        }
    }
    /// Throws what stopped the work.
    void settle() const {
        if (stopped_) {
            std::rethrow_exception(stopped_);
        }
    }

private:
    Run const& run_;
    char const* what_;
    std::exception_ptr stopped_;
};

} // namespace thalweg::io
