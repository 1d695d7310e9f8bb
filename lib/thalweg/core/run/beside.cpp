// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/run/beside.hpp>

#include <chrono>
#include <system_error>

namespace thalweg {

Beside::Beside(Run const& run, char const* what)
    : run_(run), what_(what), job_run_(run), passes_on_(run.stop, [this] { stop_.request_stop(); }) {
    job_run_.threads = 1;
    job_run_.progress = nullptr;
    job_run_.log = nullptr;
    job_run_.preview = nullptr;
    job_run_.cache = nullptr;
    job_run_.stop = stop_.get_token();
}

Beside::~Beside() {
    stop_.request_stop();
    std::scoped_lock const lock(guard_);
    waiting_.clear();
}

void Beside::add(Job job) {
    run_.check();
    auto const most = run_.threads > 0 ? static_cast<std::size_t>(run_.threads) : std::thread::hardware_concurrency();
    if (most <= 1) {
        job(run_);
        return;
    }
    std::scoped_lock const lock(guard_);
    if (failure_.second) {
        return; // wait() throws it
    }
    waiting_.emplace_back(added_++, std::move(job));
    changed_.notify_one();
    if (threads_.size() + 1 < most) {
        try {
            threads_.emplace_back([this](std::stop_token const& end) {
                std::unique_lock own(guard_);
                while (changed_.wait(own, end, [this] { return !waiting_.empty(); })) {
                    work_on(own, job_run_);
                }
            });
        } catch (std::system_error const&) { // no more threads: wait() does the work
        }
    }
}

void Beside::wait() {
    using namespace std::chrono_literals;
    Run here = run_;
    here.threads = 1; // others may be at work
    std::unique_lock lock(guard_);
    while (!waiting_.empty() || running_ > 0) {
        if (!waiting_.empty()) {
            work_on(lock, here);
            continue;
        }
        changed_.wait_for(lock, 50ms);
        double const share = 1.0 - static_cast<double>(running_) / static_cast<double>(added_);
        lock.unlock();
        run_.at(share, what_);
        lock.lock();
    }
    if (failure_.second) {
        std::rethrow_exception(std::exchange(failure_.second, nullptr));
    }
}

void Beside::work_on(std::unique_lock<std::mutex>& lock, Run const& run) {
    auto const [number, job] = std::move(waiting_.front());
    waiting_.pop_front();
    ++running_;
    lock.unlock();
    std::exception_ptr thrown;
    try {
        job(run);
    } catch (...) {
        thrown = std::current_exception();
    }
    lock.lock();
    --running_;
    if (thrown) {
        waiting_.clear();
        if (!failure_.second || number < failure_.first) {
            failure_ = {number, thrown};
        }
    }
    changed_.notify_all();
}

} // namespace thalweg
