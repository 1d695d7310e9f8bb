// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <string>
#include <utility>

#include <thalweg/core/run/run.hpp>
#include <thalweg/pipeline/plan/plan.hpp>

/// Private to this module.
namespace thalweg::pipeline {

/// Times the stages and says a line for each.
class Diary {
public:
    explicit Diary(Run const& run) : run_(run) {}

    template <class Stage> auto stage(char const* name, Stage&& work) {
        run_.at(0.0, name);
        auto const begin = std::chrono::steady_clock::now();
        auto result = work();
        std::chrono::duration<double> const taken = std::chrono::steady_clock::now() - begin;
        timings_s_.emplace_back(name, taken.count());
        run_.at(1.0, name);
        return result;
    }
    /// About the last stage.
    void say(std::string const& words) const;

    /// What the stages took, in order; none is left.
    Timings take() { return std::exchange(timings_s_, {}); }

private:
    Run const& run_;
    Timings timings_s_;
};

} // namespace thalweg::pipeline
