// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/run/memory.hpp>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <string>
#include <sys/mman.h>
#include <sys/resource.h>

#include <thalweg/core/run/peak_memory.hpp>

namespace thalweg {
namespace {

/// Reads the number in a file; -1: no file, or no number ("max").
std::int64_t number_in(char const* path) {
    std::ifstream in(path);
    std::int64_t value = -1;
    return in >> value ? value : -1;
}

} // namespace

std::int64_t free_memory_bytes() {
    std::int64_t free = std::numeric_limits<std::int64_t>::max();
    std::ifstream info("/proc/meminfo");
    for (std::string name; info >> name;) {
        std::int64_t kib = 0;
        info >> kib;
        if (name == "MemAvailable:") {
            free = kib * 1024;
            break;
        }
        info.ignore(256, '\n');
    }
    std::int64_t const limit = number_in("/sys/fs/cgroup/memory.max");
    std::int64_t const used = number_in("/sys/fs/cgroup/memory.current");
    if (limit >= 0 && used >= 0) {
        free = std::min(free, std::max<std::int64_t>(limit - used, 0));
    }
    return free;
}

std::int64_t peak_memory_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::int64_t>(usage.ru_maxrss) * 1024;
}

void* allocate_large_pages(std::size_t bytes) {
    constexpr std::size_t page = std::size_t{2} << 20;
    void* memory = nullptr;
    if (posix_memalign(&memory, page, bytes) != 0) {
        throw std::bad_alloc();
    }
    // A remainder smaller than a large page stays in small pages. madvise() is a hint: only time and memory depend on
    // it.
    madvise(memory, bytes / page * page, MADV_HUGEPAGE);
    return memory;
}

void free_large_pages(void* memory) noexcept {
    note_memory_now();
    std::free(memory);
}

} // namespace thalweg
