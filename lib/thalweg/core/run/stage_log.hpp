// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <exception>
#include <string>
#include <utility>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/run/peak_memory.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg {

/// What a stage took.
struct StageTime {
    std::string stage;
    double wall_s = 0.0;
    double cpu_s = 0.0;   ///< of all its threads
    double peak_mb = 0.0; ///< [10^6 bytes] the most that the process took meanwhile, all threads and libraries
};

/// Times of stages, in order.
using Timings = std::vector<StageTime>;

/// Measures what work of this thread takes, and the process's memory meanwhile.
class Stopwatch {
public:
    StageTime time_of(char const* stage) const {
        std::chrono::duration<double> const taken = std::chrono::steady_clock::now() - begin_;
        return {stage, taken.count(), cpu_seconds() - cpu_begin_s_, static_cast<double>(peak_.bytes()) * 1e-6};
    }

private:
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
    double cpu_begin_s_ = cpu_seconds();
    PeakMemory peak_;
};

/// Times the stages, logs a line for each and collects what they find. When an error ends the work, what was found so
/// far is reported.
class StageLog {
public:
    explicit StageLog(Run const& run) : run_(run) {}
    ~StageLog();
    StageLog(StageLog const&) = delete;
    StageLog& operator=(StageLog const&) = delete;

    template <class Stage> auto stage(char const* name, Stage&& work) {
        run_.at(0.0, name);
        Stopwatch const stopwatch;
        auto result = work();
        timings_s_.push_back(stopwatch.time_of(name));
        run_.at(1.0, name);
        return result;
    }
    /// Logs a line about the last stage.
    void say(std::string const& words) const;

    /// Adds times of stages that ran before.
    void add(Timings const& timings_s) { timings_s_.insert(timings_s_.end(), timings_s.begin(), timings_s.end()); }
    /// Returns the times of the stages, in order, and clears them.
    Timings take() { return std::exchange(timings_s_, {}); }

    void find(Finding finding) { findings_.push_back(std::move(finding)); }
    void find(std::vector<Finding> const& findings) {
        findings_.insert(findings_.end(), findings.begin(), findings.end());
    }
    /// Returns the findings, in order, and clears them.
    std::vector<Finding> take_findings() { return std::exchange(findings_, {}); }

private:
    Run const& run_;
    int exceptions_ = std::uncaught_exceptions();
    Timings timings_s_;
    std::vector<Finding> findings_;
};

} // namespace thalweg
