// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <string>

#include <thalweg/core/run/run.hpp>
#include <thalweg/pipeline/make/terrain.hpp>

/// Private to this room.
namespace thalweg::pipeline {

/// Times the stages and says a line for each.
class Diary {
public:
    Diary(Run const& run, Terrain& terrain) : run_(run), terrain_(terrain) {}

    template <class Stage> auto stage(char const* name, Stage&& work) {
        run_.at(0.0, name);
        auto const begin = std::chrono::steady_clock::now();
        auto result = work();
        std::chrono::duration<double> const taken = std::chrono::steady_clock::now() - begin;
        terrain_.timings_s.emplace_back(name, taken.count());
        run_.at(1.0, name);
        return result;
    }
    /// About the last stage.
    void say(std::string const& words) const;

private:
    Run const& run_;
    Terrain& terrain_;
};

} // namespace thalweg::pipeline
