// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \cpponly

#include <cstdint>
#include <functional>
#include <stop_token>
#include <string_view>
#include <vector>

namespace thalweg {

/// The device on which linear systems are solved.
/// \cpponly
enum class Device : std::uint8_t { cpu, opencl };

template <class T> class Raster;
class ResultCache;
struct Finding;
struct StageTime;

/// Controls execution (progress, cancellation, threads, device). It never changes results.
struct Run {
    /// Receives progress, with GDAL's signature: share done [0, 1], what is being done, progress_arg. Called by one
    /// thread at a time; return 0 to stop the work. The text is one word, a stage's name, preceded once by an
    /// announcement of the amount if it is known: "grow 100000 particles".
    using Progress = int (*)(double, char const*, void*);

    int threads = 0;             ///< [1, ...] workers; 0: all cores
    Device device = Device::cpu; ///< results agree within the solver's stated tolerance
    Progress progress = nullptr;
    void* progress_arg = nullptr;
    std::function<void(std::string_view)> log; ///< called with one line, without newline
    /// Receives what was found, once each, also where a kept result says it; empty: log has a line of each that is
    /// printed always.
    std::function<void(Finding const&)> found;
    /// Receives, before a terrain is made, its stages in order with the time that each is expected to take on one core;
    /// the last, "write", is that of its files. Empty: nobody asks.
    std::function<void(std::vector<StageTime> const&)> planned;
    std::stop_token stop;
    /// Receives a terrain while it is made: heights [m], first of larger cells, which what follows refines;
    /// is_finished: those of the result. Called by one thread at a time; empty: nobody looks on.
    std::function<void(Raster<float> const& dem, bool is_finished)> preview;
    ResultCache* cache = nullptr; ///< results of stages of earlier runs; null: all stages run

    /// Reports progress.
    /// \param share [0, 1] done
    /// \param what name of the stage
    /// \throws Cancelled when the work must stop
    void at(double share, char const* what) const;
    /// Checks the stop token.
    /// \throws Cancelled when the work must stop
    void check() const;
    /// Logs a line about a stage: "grow       100000 particles".
    /// \param stage name of the stage, in a column of its own
    /// \param words the message
    void tell(std::string_view stage, std::string_view words) const;
    /// \return a run on the same threads and device, with the same stop token, that reports nothing
    Run quiet() const;
    /// Hands findings of a stage's result to whoever looks on.
    /// \param findings part of the result
    void report(std::vector<Finding> const& findings) const;
    void say(std::string_view line) const {
        if (log) {
            log(line);
        }
    }
};

/// Number of cells a loop may process between two checks of the stop token.
inline constexpr std::int64_t cells_between_checks = 1 << 18;

/// Calls body(begin, end) on disjoint ranges that tile [0, count), on run.threads workers. The result does not depend
/// on the number of threads if body writes only its own range.
/// \pre The ranges do not depend on one another.
/// \param count end of the last range
/// \param grain minimum length of a range (except the last)
/// \param body called with the begin and end of a range
/// \throws Error what body throws
void parallel_ranges(Run const& run, std::int64_t count, std::int64_t grain,
                     std::function<void(std::int64_t, std::int64_t)> const& body);

/// Measures the CPU time of this thread, and of the workers that parallel_ranges lent it.
/// \return [s] since some moment: the difference of two calls is the CPU time between them
double cpu_seconds();

} // namespace thalweg
