// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/run/peak_memory.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <fcntl.h>
#include <malloc.h>
#include <mutex>
#include <sys/types.h>
#include <unistd.h>
#include <vector>

#include <thalweg/core/run/small_blocks.hpp>

namespace thalweg {
namespace {

#ifdef __GLIBC__
/// Free small blocks that the process keeps for the next [bytes]: what a small terrain takes again at once.
constexpr int kept_free = 16 << 20;
#endif

/// Memory that this process takes now [bytes]; 0: unknown. Allocates nothing.
std::int64_t resident_bytes() noexcept {
    int const file = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
    if (file < 0) {
        return 0;
    }
    std::array<char, 128> text{};
    ssize_t const read_bytes = read(file, text.data(), text.size() - 1);
    close(file);
    long long pages = 0;
    bool const is_known = read_bytes > 0 && std::sscanf(text.data(), "%*s %lld", &pages) == 1;
    return is_known ? pages * sysconf(_SC_PAGESIZE) : 0;
}

/// Everyone who wants to know of peaks.
struct Watchers {
    std::mutex guard;
    std::vector<PeakMemory*> all;
    std::atomic<std::int64_t> last_ns = 0; ///< when memory was last noted
};

/// Never destroyed: threads may still release blocks when the program ends.
Watchers& watchers() {
    static Watchers* const only = new Watchers;
    return *only;
}

std::int64_t now_ns() noexcept {
    return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

} // namespace

void note_memory() noexcept {
    constexpr std::int64_t pause_ns = 1'000'000; // reading it takes some microseconds
    if (now_ns() - watchers().last_ns.load(std::memory_order_relaxed) > pause_ns) {
        note_memory_now();
    }
}

void note_memory_now() noexcept {
    Watchers& those = watchers();
    std::scoped_lock const lock(those.guard);
    if (!those.all.empty()) {
        std::int64_t const now = resident_bytes();
        for (PeakMemory* const one : those.all) {
            one->note(now);
        }
    }
    those.last_ns.store(now_ns(), std::memory_order_relaxed);
}

PeakMemory::PeakMemory() {
    Watchers& those = watchers();
    std::int64_t const now = resident_bytes();
    std::scoped_lock const lock(those.guard);
    note(now);
    those.all.push_back(this);
}

PeakMemory::~PeakMemory() {
    Watchers& those = watchers();
    std::scoped_lock const lock(those.guard);
    std::erase(those.all, this);
}

void PeakMemory::note(std::int64_t now) noexcept {
    most_.store(std::max(most_.load(std::memory_order_relaxed), now), std::memory_order_relaxed);
}

std::int64_t PeakMemory::bytes() const {
    note_memory_now();
    return most_.load(std::memory_order_relaxed);
}

void return_small_blocks() noexcept {
#ifdef __GLIBC__
    if (mallinfo2().fordblks > kept_free) {
        malloc_trim(0);
    }
#endif
}

void return_large_blocks() noexcept {
#ifdef __GLIBC__
    mallopt(M_MMAP_THRESHOLD, 1 << 20);
    mallopt(M_TRIM_THRESHOLD, kept_free); // left alone it would be 128 KiB from then on
#endif
}

} // namespace thalweg
