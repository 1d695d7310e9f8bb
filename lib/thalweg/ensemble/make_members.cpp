// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/ensemble/make_members.hpp>

#include <algorithm>
#include <atomic>
#include <exception>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/append.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/ensemble/internal/member_store.hpp>

namespace thalweg::ensemble {

namespace {

/// Hands out the members to make, in order.
using Next = std::function<std::optional<std::int64_t>()>;

/// Makes members on several threads, each of which works on one member at a time.
class Pool {
public:
    /// \param next may be called by several threads at once
    /// \param count of the members that next hands out, at most
    Pool(MemberStore& store, Next next, std::int64_t count, Run const& run)
        : store_(store), next_(std::move(next)), count_(std::max<std::int64_t>(count, 1)), run_(run),
          passes_on_(run.stop, [this] { stop_.request_stop(); }) {}

    /// \throws Error what the first thread throws that cannot go on
    void work() {
        int const threads = threads_of(run_);
        auto const workers = static_cast<int>(std::min<std::int64_t>(count_, threads));
        member_run_.threads = threads / workers;
        member_run_.device = run_.device;
        member_run_.stop = stop_.get_token();
        {
            std::vector<std::jthread> others;
            for (int i = 1; i < workers; ++i) {
                others.emplace_back([this] { take_members(); });
            }
            take_members();
        }
        if (failure_) {
            std::rethrow_exception(failure_);
        }
    }

    std::int64_t made() const { return made_; }

private:
    void take_members() {
        try {
            std::optional<std::int64_t> shard;
            auto const leave_shard = [&](std::optional<std::int64_t> next) {
                if (shard && shard != next) {
                    store_.pack(*shard);
                }
                shard = next;
            };
            for (auto number = next_(); number && !stop_.stop_requested(); number = next_()) {
                leave_shard(store_.shard_of(*number));
                make_one(*number);
            }
            run_.check();
            leave_shard({});
        } catch (...) {
            std::scoped_lock const hold(guard_);
            failure_ = failure_ ? failure_ : std::current_exception();
            stop_.request_stop();
        }
    }

    void make_one(std::int64_t number) {
        if (!store_.made_meanwhile(number)) {
            Stopwatch const stopwatch;
            MadeMember const made = make_member(store_.ensemble(), number, member_run_);
            store_.add(made, stopwatch.time_of("member").wall_s, member_run_);
        }
        std::scoped_lock const hold(guard_);
        ++made_;
        if (!stop_.stop_requested()) {
            run_.at(static_cast<double>(made_) / static_cast<double>(count_), "members");
        }
    }

    MemberStore& store_;
    Next const next_;
    std::int64_t const count_;
    Run const& run_;
    Run member_run_;
    std::stop_source stop_;
    std::stop_callback<std::function<void()>> const passes_on_;
    std::mutex guard_;
    std::int64_t made_ = 0;
    std::exception_ptr failure_;
};

/// Hands out numbers of a list.
Next in_order(MemberNumbers const& numbers, std::atomic<std::int64_t>& next) {
    return [&numbers, &next]() -> std::optional<std::int64_t> {
        std::int64_t const i = next++;
        return i < numbers.size() ? std::optional(numbers[i]) : std::nullopt;
    };
}

/// A warning of members that something is wrong with; none where their count is 0.
std::vector<Finding> on_members(FindingKind kind, std::int64_t count, std::int64_t members, char const* what,
                                std::string const& first) {
    if (count == 0) {
        return {};
    }
    return {{.kind = kind,
             .amount = static_cast<double>(count),
             .text = fmt::format("{} of {} members {}. The first, {}", count, members, what, first),
             .numbers = {{"members", static_cast<double>(members)}}}};
}

std::string range_of(std::uint64_t first, std::int64_t members) {
    return members == 1 ? fmt::format("seed {}", first)
                        : fmt::format("seeds {} to {}", first, first + static_cast<std::uint64_t>(members) - 1);
}

/// Says where the work stopped.
std::string account_of_stop(std::int64_t there, std::int64_t all, std::string const& folder) {
    return fmt::format("{} of {} members are in {}. The same command goes on", there, all, folder);
}

/// Writes the tables, and says what was not ok.
void finish(MemberStore& store, EnsembleOrder const& order, EnsembleResult& result, Run const& run) {
    Journals::Account const account = store.finish(run);
    result.ok = account.ok;
    result.checks_failed = account.checks_failed;
    result.failed = account.failed;
    result.warned = account.warned;
    result.table = (std::filesystem::path(order.folder) / "table.csv").string();
    std::int64_t const all = order.ensemble.members;
    std::vector<Finding> findings =
        on_members("members_failed", account.failed, all, "could not be made", account.first_failed);
    append(findings, on_members("members_failed", account.checks_failed, all, "fail a check", account.first_check));
    append(findings, on_members("members_warned", account.warned, all, "gave warnings", account.first_warning));
    run.report(findings);
    append(result.findings, findings);
}

/// Makes members, and deals them to other ranks where there are any.
std::int64_t work_on(MemberStore& store, MemberNumbers const& missing, Ranks* ranks, Run const& run) {
    std::atomic<std::int64_t> next = 0;
    Next const hand_out = in_order(missing, next);
    Pool pool(store, hand_out, missing.size(), run);
    if (ranks == nullptr) {
        pool.work();
        return pool.made();
    }
    bool others_fine = true;
    auto const stop = [&] { next = missing.size(); };
    std::exception_ptr failure;
    std::jthread own([&] {
        try {
            pool.work();
        } catch (...) {
            failure = std::current_exception();
            stop();
        }
    });
    ranks->deal(hand_out, [&] {
        others_fine = false;
        stop();
    });
    own.join();
    if (failure) {
        std::rethrow_exception(failure);
    }
    refuse_if<IoError>(!others_fine, "ensemble.make_members", "another rank has failed");
    return missing.size();
}

} // namespace

int threads_of(Run const& run) {
    return run.threads > 0 ? run.threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

EnsembleResult make_members(EnsembleOrder const& order, Ranks* ranks, Run const& run) {
    bool has_started = false;
    auto const tell_others = [&](bool is_fine) {
        if (ranks != nullptr && !std::exchange(has_started, true)) {
            ranks->start(is_fine);
        }
    };
    try {
        Share const share = order.share;
        MemberStore store(order.folder, order.ensemble, order.vary, order.files,
                          share.of > 1 ? MemberStore::Role::share : MemberStore::Role::alone, share, run);
        MemberNumbers const missing = store.missing(share, run);
        EnsembleResult result{.members = order.ensemble.members};
        result.findings = store.findings();
        run.report(result.findings);
        std::int64_t const all = store.members_of(share);
        result.found = all - missing.size();
        auto const account = [&] { // without a stop token: it has been triggered
            std::int64_t const there =
                ranks != nullptr ? all - store.missing(share, {}).size() : result.found + store.added();
            return account_of_stop(there, all, order.folder);
        };
        run.tell("ensemble", fmt::format("{} members, {}{}{}{}", order.ensemble.members,
                                         range_of(order.ensemble.recipe.seed, order.ensemble.members),
                                         share.of > 1 ? fmt::format(", share {} of {}", share.number, share.of) : "",
                                         result.found > 0 ? fmt::format(", {} are there", result.found) : "",
                                         ranks != nullptr ? fmt::format(", on {} ranks", ranks->count()) : ""));
        tell_others(true);
        Stopwatch const stopwatch;
        try {
            result.made_now = work_on(store, missing, ranks, run);
        } catch (Cancelled const& stopped) {
            throw Cancelled(stopped.where(), "interrupted; " + account());
        } catch (IoError const& error) {
            throw IoError(error.where(), fmt::format("{}; {}", error.what(), account()));
        }
        result.seconds = stopwatch.time_of("members").wall_s;
        run.tell("members", fmt::format("{} made, {:.3g} a second", result.made_now,
                                        static_cast<double>(result.made_now) / std::max(result.seconds, 1e-9)));
        if (share.of == 1) {
            finish(store, order, result, run);
        }
        return result;
    } catch (...) {
        tell_others(false);
        throw;
    }
}

EnsembleResult help_to_make(EnsembleOrder const& order, Ranks& ranks, Run const& run) {
    EnsembleResult result{.members = order.ensemble.members};
    try {
        MemberStore store(order.folder, order.ensemble, order.vary, order.files, MemberStore::Role::helper, {}, run);
        Pool pool(
            store, [&] { return ranks.ask(); }, order.ensemble.members, run);
        pool.work();
        result.made_now = pool.made();
    } catch (...) {
        ranks.say_goodbye(false);
        throw;
    }
    ranks.say_goodbye(true);
    return result;
}

} // namespace thalweg::ensemble
