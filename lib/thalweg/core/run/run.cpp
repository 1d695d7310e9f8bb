// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/run/run.hpp>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <ctime>
#include <string>
#include <thread>
#ifdef THALWEG_TSAN
#include <exception>
#include <mutex>
#include <vector>
#endif

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/peak_memory.hpp>

namespace thalweg {

void Run::check() const {
    note_memory();
    if (stop.stop_requested()) {
        throw Cancelled("core.Run", "interrupted");
    }
}

void Run::at(double share, char const* what) const {
    check();
    if (progress != nullptr && progress(share, what, progress_arg) == 0) {
        throw Cancelled("core.Run", "interrupted");
    }
}

void Run::tell(std::string_view stage, std::string_view words) const {
    constexpr std::size_t column = 10; // the longest name of a stage: catchments
    std::string line(stage);
    line.append(std::max(column, stage.size()) - stage.size() + 1, ' ');
    say(line.append(words));
}

Run Run::quiet() const {
    Run run;
    run.threads = threads;
    run.device = device;
    run.stop = stop;
    return run;
}

void Run::report(std::vector<Finding> const& findings) const {
    for (Finding const& finding : findings) {
        if (found) {
            found(finding);
        } else if (finding.kind.row().printed == Printed::always) {
            say(line_of(finding));
        }
    }
}

namespace {

#ifdef THALWEG_TSAN
/// oneTBB is compiled without the thread sanitizer, which then reports each of its hand-overs as a race. In builds with
/// the sanitizer, threads of the standard library do the work; they take it in a relaxed order that synchronises
/// nothing else.
void share(int threads, std::int64_t count, std::int64_t grain,
           std::function<void(std::int64_t, std::int64_t)> const& body) {
    std::int64_t const length = std::max<std::int64_t>({grain, count / 64, 1});
    std::atomic<std::int64_t> next = 0;
    std::mutex guard;
    std::exception_ptr failure;
    auto const take = [&] { return next.fetch_add(length, std::memory_order_relaxed); };
    auto const work = [&] {
        try {
            for (std::int64_t begin = take(); begin < count; begin = take()) {
                body(begin, std::min(count, begin + length));
            }
        } catch (...) {
            std::scoped_lock const lock(guard);
            failure = failure ? failure : std::current_exception();
        }
    };
    {
        std::vector<std::jthread> workers;
        for (unsigned i = threads > 0 ? static_cast<unsigned>(threads) : std::thread::hardware_concurrency(); i > 0;
             --i) {
            workers.emplace_back(work);
        }
    }
    if (failure) {
        std::rethrow_exception(failure);
    }
}
#else
void share(int threads, std::int64_t count, std::int64_t grain,
           std::function<void(std::int64_t, std::int64_t)> const& body) {
    namespace tbb = oneapi::tbb;
    tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
    arena.execute([&] {
        auto const least = static_cast<std::size_t>(std::max<std::int64_t>(grain, 1));
        tbb::parallel_for(tbb::blocked_range<std::int64_t>(0, count, least),
                          [&](tbb::blocked_range<std::int64_t> const& r) { body(r.begin(), r.end()); });
    });
}
#endif

thread_local double lent_s = 0.0; ///< CPU time of workers for this thread

} // namespace

double cpu_seconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return lent_s + static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

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
    std::atomic<double> by_workers_s = 0.0;
    share(run.threads, count, grain, [&, caller = std::this_thread::get_id()](std::int64_t begin, std::int64_t end) {
        if (std::this_thread::get_id() == caller) {
            body(begin, end);
            return;
        }
        double const before_s = cpu_seconds();
        body(begin, end);
        by_workers_s += cpu_seconds() - before_s;
    });
    lent_s += by_workers_s;
    run.check();
}

} // namespace thalweg
