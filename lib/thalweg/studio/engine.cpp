// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/studio/engine.hpp>

#include <algorithm>
#include <exception>
#include <utility>

#include <thalweg/core/run/error.hpp>
#include <thalweg/recipe/recipe_files.hpp>

namespace thalweg::studio {
namespace {

/// Calls a function if there is one.
template <class... Arguments, class... Given>
void tell(std::function<void(Arguments...)> const& function, Given&&... given) {
    if (function) {
        function(std::forward<Given>(given)...);
    }
}

/// What Run's progress is given.
struct Reporting {
    Watcher const& watcher;
    Job const& job;
};

int report(double share, char const* what, void* reporting) {
    auto const& to = *static_cast<Reporting const*>(reporting);
    tell(to.watcher.at, to.job, std::string_view(what), share);
    return 1;
}

/// About the bytes of a terrain of which all parts are there.
std::int64_t bytes_of(make::MakeResult const& made) {
    constexpr std::int64_t of_cell = 40;
    constexpr std::int64_t least = 1 << 20;
    return least + of_cell * made.terrain.grid.cells();
}

} // namespace

Engine::Engine(Watcher watcher, int threads, std::int64_t kept)
    : watcher_(std::move(watcher)), threads_(threads), results_(kept),
      thread_([this](std::stop_token const& ends) { work(ends); }) {}

Engine::~Engine() {
    thread_.request_stop();
    stop();
}

std::int64_t Engine::make(Job job) {
    std::scoped_lock const lock(guard_);
    job.number = ++last_;
    job.asked = std::chrono::steady_clock::now();
    next_ = std::move(job);
    stops_next_ = false;
    ask_to_stop();
    return last_;
}

void Engine::stop() {
    std::scoped_lock const lock(guard_);
    stops_next_ = next_.has_value();
    ask_to_stop();
}

void Engine::ask_to_stop() {
    if (!running_.stop_requested()) {
        asked_to_stop_ = std::chrono::steady_clock::now();
    }
    running_.request_stop();
    changed_.notify_all();
}

std::shared_ptr<make::MakeResult const> Engine::wait(std::int64_t number, std::stop_token const& stop) {
    std::unique_lock lock(guard_);
    changed_.wait(lock, stop, [&] { return ended_ >= number; });
    return latest_number_ == number ? latest_ : nullptr;
}

std::int64_t Engine::last() const {
    std::scoped_lock const lock(guard_);
    return last_;
}

double Engine::slowest_stop_s() const {
    std::scoped_lock const lock(guard_);
    return slowest_stop_s_;
}

void Engine::work(std::stop_token const& ends) {
    std::unique_lock lock(guard_);
    while (changed_.wait(lock, ends, [this] { return next_.has_value(); })) {
        Job const job = std::move(*next_);
        next_.reset();
        running_ = std::stop_source();
        if (std::exchange(stops_next_, false)) {
            asked_to_stop_ = std::chrono::steady_clock::now();
            running_.request_stop();
        }
        std::stop_token const stop = running_.get_token();
        lock.unlock();
        run(job, stop);
        lock.lock();
        if (stop.stop_requested()) {
            std::chrono::duration<double> const waited = std::chrono::steady_clock::now() - asked_to_stop_;
            slowest_stop_s_ = std::max(slowest_stop_s_, waited.count());
        }
        running_ = std::stop_source(std::nostopstate);
        ended_ = job.number;
        changed_.notify_all();
    }
}

void Engine::run(Job const& job, std::stop_token const& stop) {
    Reporting reporting{watcher_, job};
    Run run;
    run.threads = threads_;
    run.progress = report;
    run.progress_arg = &reporting;
    std::vector<Finding> findings;
    run.found = [&](Finding const& finding) { findings.push_back(finding); };
    run.stop = stop;
    run.cache = &results_;
    try {
        run.check();
        std::string const key = "made\n" + job.toml + recipe::state_of_files(job.recipe);
        auto made = std::static_pointer_cast<make::MakeResult const>(results_.find(key));
        if (made) {
            findings = make::findings_of(*made);
            tell(watcher_.found, job, findings);
            if (job.recipe.network) {
                tell(watcher_.rivers, job, made->plan.recipe, made->planform, run);
            }
            if (made->terrain.has_surface()) {
                tell(watcher_.heights, job,
                     Heights{made->terrain.ground.dem, made->terrain.grid, report::sea_of(made->terrain), true});
            }
        } else {
            auto const fresh = std::make_shared<make::MakeResult>();
            fresh->plan = recipe::resolve(job.recipe, run);
            fresh->planform = make::make_planform(fresh->plan, run);
            tell(watcher_.found, job, findings);
            if (job.recipe.network) {
                tell(watcher_.rivers, job, fresh->plan.recipe, fresh->planform, run);
            }
            run.preview = [&](Raster<float> const& dem, bool is_finished) {
                run.check();
                tell(watcher_.heights, job,
                     Heights{dem, job.recipe.network ? fresh->planform.grid : *fresh->plan.grid,
                             report::sea_of(fresh->plan.recipe, fresh->planform), is_finished});
            };
            fresh->terrain = make::make_terrain(fresh->plan, fresh->planform, run);
            run.preview = nullptr;
            tell(watcher_.found, job, findings);
            fresh->recipe = make::recipe_of(fresh->plan, fresh->terrain);
            tell(watcher_.made, job, *fresh);
            fresh->assessment = make::assess(fresh->plan, fresh->planform, fresh->terrain, run);
            tell(watcher_.found, job, findings);
            made = fresh;
            results_.keep(key, made, bytes_of(*made));
        }
        run.check();
        {
            std::scoped_lock const lock(guard_);
            latest_ = made;
            latest_number_ = job.number;
        }
        tell(watcher_.measured, job, made);
    } catch (Cancelled const&) {
        tell(watcher_.stopped, job);
    } catch (std::exception const& error) {
        if (stop.stop_requested()) {
            tell(watcher_.stopped, job);
            return;
        }
        tell(watcher_.found, job, findings);
        tell(watcher_.failed, job, std::string_view(words_of(error)));
    }
}

} // namespace thalweg::studio
