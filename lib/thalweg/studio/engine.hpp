// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/run/result_cache.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/make/make.hpp>
#include <thalweg/recipe/recipe.hpp>
#include <thalweg/report/landmarks.hpp>

namespace thalweg::studio {

/// A recipe to be made.
struct Job {
    std::int64_t revision = 0; ///< of the document
    recipe::Recipe recipe = {};
    std::string toml = {};   ///< the recipe as text
    std::int64_t number = 0; ///< from 1, by the engine: of two jobs the later has the larger one
    std::chrono::steady_clock::time_point asked = {}; ///< by the engine
};

/// A terrain while it is made.
struct Heights {
    Raster<float> const& dem;       ///< [m] coarse first
    Grid const& grid;               ///< of the result
    std::optional<report::Sea> sea; ///< that its cells without heights are
    bool is_finished;               ///< the DEM is the result
};

/// Hears what becomes of jobs, one call at a time, on the engine's thread. Each may be empty.
struct Watcher {
    std::function<void(Job const&, std::string_view stage, double share)> at = {}; ///< [0, 1] of a stage is done
    /// \param findings all of the job so far, again after each stage that may find something
    std::function<void(Job const&, std::vector<Finding> const& findings)> found = {};
    /// Before their land.
    /// \param run of the job
    std::function<void(Job const&, recipe::Recipe const&, make::Planform const&, Run const& run)> rivers = {};
    std::function<void(Job const&, Heights const&)> heights = {};
    std::function<void(Job const&, make::MakeResult const&)> made = {}; ///< not yet measured
    /// The end of a job.
    std::function<void(Job const&, std::shared_ptr<make::MakeResult const> const&)> measured = {};
    std::function<void(Job const&, std::string_view error)> failed = {};
    std::function<void(Job const&)> stopped = {}; ///< by a later job, or stop()
};

/// Makes terrain on a thread of its own, always that of the last recipe asked for: a new one stops what is running.
/// Stages whose input and parameters are those of an earlier job are not run again.
class Engine {
public:
    /// \param watcher kept
    /// \param threads as Run
    /// \param kept [bytes] of results of stages that stay for later jobs
    explicit Engine(Watcher watcher, int threads = 0, std::int64_t kept = std::int64_t{1} << 30);
    /// Stops what is running.
    ~Engine();
    Engine(Engine const&) = delete;
    Engine& operator=(Engine const&) = delete;

    /// Begins a job.
    /// \return its number
    std::int64_t make(Job job);
    /// Stops what is running, or waits to.
    void stop();
    /// \return the number of the job begun last
    std::int64_t last() const;
    /// Waits for the terrain of a job.
    /// \return nothing when it failed, was stopped, a later one has ended, or stop ended the wait
    std::shared_ptr<make::MakeResult const> wait(std::int64_t number, std::stop_token const& stop = {});
    /// \return [s] the longest time from the request to stop a job to its end
    double slowest_stop_s() const;

private:
    void ask_to_stop();
    void work(std::stop_token const& ends);
    void run(Job const& job, std::stop_token const& stop);

    Watcher const watcher_;
    int const threads_;
    ResultCache results_;
    mutable std::mutex guard_;
    std::condition_variable_any changed_;
    std::optional<Job> next_;
    bool stops_next_ = false; ///< it begins only to be told
    std::int64_t last_ = 0;   ///< number given out
    std::int64_t ended_ = 0;  ///< number of the last job that ended
    std::stop_source running_{std::nostopstate};
    std::chrono::steady_clock::time_point asked_to_stop_{};
    double slowest_stop_s_ = 0.0;
    std::shared_ptr<make::MakeResult const> latest_; ///< of the last job that was made
    std::int64_t latest_number_ = 0;
    std::jthread thread_; ///< the last member: it uses all others
};

} // namespace thalweg::studio
