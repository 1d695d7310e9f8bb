// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/run/large_pages.hpp>

#include <sys/mman.h>

#include <cstdlib>
#include <new>

namespace thalweg {

void* take_large_pages(std::size_t bytes) {
    constexpr std::size_t page = std::size_t{2} << 20;
    void* memory = nullptr;
    if (posix_memalign(&memory, page, bytes) != 0) {
        throw std::bad_alloc();
    }
    // What fills no large page at the end stays in small ones. A wish: what comes of it only changes time and memory.
    madvise(memory, bytes / page * page, MADV_HUGEPAGE);
    return memory;
}

void give_large_pages(void* memory) noexcept {
    std::free(memory);
}

} // namespace thalweg
