// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/run/parallel.hpp>

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <cstddef>

namespace thalweg {

void parallel_ranges(Run const& run, std::int64_t count, std::int64_t grain,
                     std::function<void(std::int64_t, std::int64_t)> const& body) {
    run.check();
    if (count <= 0) {
        return;
    }
    if (run.threads == 1 || count <= grain) {
        body(0, count);
        return;
    }
    namespace tbb = oneapi::tbb;
    tbb::task_arena arena(run.threads > 0 ? run.threads : tbb::task_arena::automatic);
    arena.execute([&] {
        auto const least = static_cast<std::size_t>(std::max<std::int64_t>(grain, 1));
        tbb::parallel_for(tbb::blocked_range<std::int64_t>(0, count, least),
                          [&](tbb::blocked_range<std::int64_t> const& r) { body(r.begin(), r.end()); });
    });
    run.check();
}

} // namespace thalweg
