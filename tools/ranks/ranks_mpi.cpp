// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <chrono>
#include <mutex>
#include <string_view>
#include <thread>

#include <mpi.h>

#include <thalweg/core/run/error.hpp>

#include "ranks/ranks.hpp"

namespace thalweg::tools {

namespace {

enum Message : std::int64_t { wants_member, is_done, has_failed };
constexpr int to_first = 1; ///< tags
constexpr int to_other = 2;
constexpr std::int64_t none_left = -1;

class MpiRanks : public ensemble::Ranks {
public:
    MpiRanks() {
        int provided = MPI_THREAD_SINGLE;
        MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided);
        if (provided < MPI_THREAD_SERIALIZED) {
            MPI_Finalize();
            throw BadInput("ensemble.Ranks", "this MPI allows no threads: it has no MPI_THREAD_SERIALIZED");
        }
        MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
        MPI_Comm_size(MPI_COMM_WORLD, &count_);
    }
    ~MpiRanks() override { MPI_Finalize(); }
    MpiRanks(MpiRanks const&) = delete;
    MpiRanks& operator=(MpiRanks const&) = delete;

    int rank() const override { return rank_; }
    int count() const override { return count_; }

    bool start(bool is_fine) override {
        int word = is_fine ? 1 : 0;
        MPI_Bcast(&word, 1, MPI_INT, 0, MPI_COMM_WORLD);
        return word != 0;
    }

    void deal(std::function<std::optional<std::int64_t>()> const& next, std::function<void()> const& failed) override {
        for (int there = count_ - 1; there > 0;) {
            int is_waiting = 0;
            MPI_Status status;
            MPI_Iprobe(MPI_ANY_SOURCE, to_first, MPI_COMM_WORLD, &is_waiting, &status);
            if (is_waiting == 0) { // a blocking receive would take a core from this rank's own members
                std::this_thread::sleep_for(std::chrono::microseconds(500));
                continue;
            }
            std::int64_t message = 0;
            MPI_Recv(&message, 1, MPI_INT64_T, status.MPI_SOURCE, to_first, MPI_COMM_WORLD, &status);
            if (message == wants_member) {
                std::int64_t const number = next().value_or(none_left);
                MPI_Send(&number, 1, MPI_INT64_T, status.MPI_SOURCE, to_other, MPI_COMM_WORLD);
                continue;
            }
            --there;
            if (message == has_failed) {
                failed();
            }
        }
    }

    std::optional<std::int64_t> ask() override {
        std::scoped_lock const hold(guard_);
        std::int64_t number = wants_member;
        MPI_Send(&number, 1, MPI_INT64_T, 0, to_first, MPI_COMM_WORLD);
        MPI_Recv(&number, 1, MPI_INT64_T, 0, to_other, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
        return number == none_left ? std::nullopt : std::optional(number);
    }

    void say_goodbye(bool is_fine) override {
        std::scoped_lock const hold(guard_);
        std::int64_t const message = is_fine ? is_done : has_failed;
        MPI_Send(&message, 1, MPI_INT64_T, 0, to_first, MPI_COMM_WORLD);
    }

private:
    int rank_ = 0;
    int count_ = 1;
    std::mutex guard_;
};

} // namespace

std::string mpi_version() {
    std::array<char, MPI_MAX_LIBRARY_VERSION_STRING> text{};
    int length = 0;
    MPI_Get_library_version(text.data(), &length);
    std::string_view const whole(text.data(), static_cast<std::size_t>(length));
    return std::string(whole.substr(0, whole.find_first_of(",\n")));
}

std::unique_ptr<ensemble::Ranks> join_ranks() {
    return launched_ranks() > 1 ? std::make_unique<MpiRanks>() : nullptr;
}

} // namespace thalweg::tools
