// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <stop_token>
#include <string_view>

namespace thalweg {

/// Where large systems are solved.
enum class Device : std::uint8_t { cpu, opencl };

/// How a stage runs, never what it makes: no field changes a result.
struct Run {
    /// GDAL's signature: share done [0,1], what is being done, progress_arg. Called from one thread at a time;
    /// returning 0 stops the work like the stop token. What is one word, a stage's name; where a stage's share is one
    /// of a known amount, it is said once before it: "grow 100000 particles".
    using Progress = int (*)(double, char const*, void*);

    int threads = 0;             ///< [1, ...] workers; 0 takes every core
    Device device = Device::cpu; ///< what solver does on it agrees with the CPU within the tolerance its header states
    Progress progress = nullptr;
    void* progress_arg = nullptr;
    std::function<void(std::string_view)> log; ///< one finished line, without its newline
    std::stop_token stop;

    /// Reports progress.
    /// \param share [0, 1] share of the work
    /// \param what what is being done
    /// \throws Cancelled when the work must stop
    void at(double share, char const* what) const;
    /// \throws Cancelled when the work must stop
    void check() const;
    /// Logs a line about a stage, its name in a column of its own: "grow       100000 particles".
    /// \param stage name of the stage
    /// \param words what to say
    void tell(std::string_view stage, std::string_view words) const;
    void say(std::string_view line) const {
        if (log) {
            log(line);
        }
    }
};

/// Cells that a loop may pass before it looks whether it must stop.
inline constexpr std::int64_t cells_between_checks = 1 << 18;

} // namespace thalweg
