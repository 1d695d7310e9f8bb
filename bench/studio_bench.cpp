// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How soon the land follows an edit, without a page. The terrain is make's default on 1024 x 1024 cells; beside it what
// make itself needs in the same process: `fill` on 256 x 256 and on 1024 x 1024 cells.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include <benchmark/benchmark.h>

#include <thalweg/io/files/files.hpp>
#include <thalweg/studio/document.hpp>
#include <thalweg/studio/document_folder.hpp>
#include <thalweg/studio/drawing.hpp>
#include <thalweg/studio/drawing_files.hpp>
#include <thalweg/studio/engine.hpp>

namespace {

using namespace thalweg;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

double process_seconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double stage_s(make::MakeResult const& made, std::string const& name) {
    double sum = 0.0;
    for (StageTime const& time : make::timings_of(made)) {
        sum += time.stage == name ? time.wall_s : 0.0;
    }
    return sum;
}

double fill_s(std::int64_t side) {
    return stage_s(make::make(recipe::default_recipe_on(side, side)), "fill");
}

/// Times of a job, from the call on.
struct Times {
    double first_s = 0.0; ///< first new land
    double full_s = 0.0;  ///< the finished heights
};

/// An engine that measures.
class Timed {
public:
    Times make(studio::Document const& document) {
        {
            std::scoped_lock const lock(guard_);
            times_ = {};
            begun_ = Clock::now();
        }
        made_ = engine_.wait(engine_.make({document.revision, document.recipe, document.toml}));
        std::scoped_lock const lock(guard_);
        return times_;
    }
    studio::Engine& engine() { return engine_; }
    make::MakeResult const& made() const { return *made_; }

private:
    void note(bool is_finished) {
        std::scoped_lock const lock(guard_);
        double const now = seconds_since(begun_);
        times_.first_s = times_.first_s > 0.0 ? times_.first_s : now;
        times_.full_s = is_finished ? now : times_.full_s;
    }

    std::mutex guard_;
    Clock::time_point begun_;
    Times times_;
    std::shared_ptr<make::MakeResult const> made_;
    studio::Engine engine_{
        {.heights = [this](studio::Job const&, studio::Heights const& heights) { note(heights.is_finished); }}};
};

studio::Document with(studio::Document const& document, char const* key, std::string const& value) {
    return apply(document, {"", {studio::SetKey{key, value}}}).document;
}

/// Counts: first and full [ms]; first_over_fill256 and full_over_fill; grown_s: growth and meander of the edit, which
/// first_over_fill256 leaves out where the seed is new.
void follow(benchmark::State& state, char const* key, bool is_new_seed) {
    double const small_s = fill_s(256);
    studio::Document document = studio::document_of(recipe::write_recipe(recipe::default_recipe()));
    Timed timed;
    timed.make(document);
    std::int64_t value = is_new_seed ? 100 : 60;
    for (auto _ : state) {
        document = with(document, key, std::to_string(++value));
        Times const times = timed.make(document);
        double const grown_s = stage_s(timed.made(), "grow") + stage_s(timed.made(), "meander");
        double const left_out_s = is_new_seed ? grown_s : 0.0;
        state.counters["first_ms"] = 1e3 * times.first_s;
        state.counters["full_ms"] = 1e3 * times.full_s;
        state.counters["grown_ms"] = 1e3 * grown_s;
        state.counters["first_over_fill256"] = (times.first_s - left_out_s) / small_s;
        state.counters["full_over_fill"] = (times.full_s - left_out_s) / stage_s(timed.made(), "fill");
    }
}

void BM_studio_prune(benchmark::State& state) {
    follow(state, "network.prune", false);
}
BENCHMARK(BM_studio_prune)->Arg(1024)->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(5);

void BM_studio_seed(benchmark::State& state) {
    follow(state, "seed", true);
}
BENCHMARK(BM_studio_seed)->Arg(1024)->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(5);

/// A river is drawn on an island of 1024 x 1024 cells that is drawn by hand. Counts: from the pen's leaving to the
/// first new land and to the finished heights, with the file written and the document saved.
void BM_studio_draw(benchmark::State& state) {
    double const small_s = fill_s(256);
    io::TemporaryFolder const folder("thalweg-bench");
    std::string const at = (folder.path() / "doc").string();
    studio::new_sheet(at);
    studio::DocumentFolder document(at);
    document.edit({"", {studio::SetKey{"grid.width", "1024"}, studio::SetKey{"grid.height", "1024"}}});
    Grid const grid = *studio::grid_of(document.document().recipe);
    studio::Drawing drawing = studio::read_drawing(document.document().recipe, grid);
    auto const place = [&](double x, double y) {
        return Vec2{grid.west + x * grid.cell_m, grid.north - y * grid.cell_m};
    };
    auto const draw = [&](studio::DrawStep const& step) {
        studio::DrawResult after = studio::drawn(drawing, step);
        document.edit(studio::edit_between(
            document.document(), drawing, after,
            [&](auto const& key, auto const& name, auto const& write) { return document.put(key, name, write); }));
        drawing = std::move(after.drawing);
    };
    studio::DrawnLine shore;
    for (double turn = 0.0; turn < 6.28; turn += 0.05) {
        double const away = 400.0 + 40.0 * std::sin(5.0 * turn);
        shore.push_back(place(512.0 + away * std::cos(turn), 512.0 - away * std::sin(turn)));
    }
    draw(studio::DrawCoast{shore});
    Timed timed;
    double x = 200.0;
    for (auto _ : state) {
        x += 60.0;
        studio::DrawRiver const river{
            {place(x, 470.0), place(x + 20.0, 560.0), place(x - 10.0, 700.0), place(x, 980.0)}};
        auto const begin = Clock::now();
        draw(river);
        double const saved_s = seconds_since(begin);
        Times const times = timed.make(document.document());
        state.counters["saved_ms"] = 1e3 * saved_s;
        state.counters["first_ms"] = 1e3 * (saved_s + times.first_s);
        state.counters["full_ms"] = 1e3 * (saved_s + times.full_s);
        state.counters["first_over_fill256"] = (saved_s + times.first_s) / small_s;
        state.counters["full_over_fill"] = (saved_s + times.full_s) / stage_s(timed.made(), "fill");
    }
}
BENCHMARK(BM_studio_draw)->Arg(1024)->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(6);

/// The longest time [ms] from a new edit to the end of what ran, over 100 moments of a run of 1024 x 1024 cells;
/// cpu_ms: of the process in that time, at the worst, in the stage that the label names.
void BM_studio_stop(benchmark::State& state) {
    studio::Document document = studio::document_of(recipe::write_recipe(recipe::default_recipe()));
    for (auto _ : state) {
        std::mutex guard;
        std::string stage;
        std::string worst;
        studio::Engine engine({.at = [&](studio::Job const&, std::string_view what, double share) {
            std::scoped_lock const lock(guard);
            stage = std::string(what) + " " + std::to_string(share);
        }});
        double cpu_s = 0.0;
        for (int moment = 0; moment < 100; ++moment) {
            document = with(document, "seed", std::to_string(500 + moment));
            std::int64_t const job = engine.make({document.revision, document.recipe, document.toml});
            std::this_thread::sleep_for(std::chrono::milliseconds(37 * moment % 2400));
            double const before_s = process_seconds();
            engine.stop();
            engine.wait(job);
            double const took_s = process_seconds() - before_s;
            std::scoped_lock const lock(guard);
            worst = took_s > cpu_s ? stage : worst;
            cpu_s = std::max(cpu_s, took_s);
        }
        state.SetLabel(worst);
        state.counters["stop_ms"] = 1e3 * engine.slowest_stop_s();
        state.counters["stop_cpu_ms"] = 1e3 * cpu_s;
    }
}
BENCHMARK(BM_studio_stop)->Arg(1024)->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(1);

} // namespace
