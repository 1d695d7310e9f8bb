// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>
#include <utility>
#include <vector>

#include <thalweg/core/run/run.hpp>

namespace thalweg {

/// Jobs beside the work of the thread that adds them: on up to run.threads - 1 threads of their own, and on that thread
/// while it waits for them. With one thread each runs when it is added.
class Beside {
public:
    /// Runs with one thread; on a thread of its own without progress and log.
    using Job = std::function<void(Run const&)>;

    /// \param run outlives this object
    /// \param what name of the stage for progress while it waits
    Beside(Run const& run, char const* what);
    /// Stops the jobs.
    ~Beside();
    Beside(Beside const&) = delete;
    Beside& operator=(Beside const&) = delete;

    /// \param job does not depend on another one
    /// \throws Cancelled when the work must stop; with one thread Error what the job throws
    void add(Job job);
    /// Works on the jobs until all are done; after a failure those that have not begun are left out.
    /// \throws Cancelled when the work must stop
    /// \throws Error what jobs have thrown: of several the one that was added first
    void wait();

private:
    /// Runs the next job, without the lock.
    void work_on(std::unique_lock<std::mutex>& lock, Run const& run);

    Run const& run_;
    char const* const what_;
    Run job_run_; ///< of threads of their own
    std::stop_source stop_;
    std::stop_callback<std::function<void()>> const passes_on_;
    std::mutex guard_;
    std::condition_variable_any changed_;
    std::deque<std::pair<std::size_t, Job>> waiting_; ///< with their numbers
    std::size_t added_ = 0;
    std::size_t running_ = 0;
    std::pair<std::size_t, std::exception_ptr> failure_; ///< of the job with the lowest number
    std::vector<std::jthread> threads_;                  ///< the last member: they use all others
};

} // namespace thalweg
