// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/large_pages.hpp>

#include <sys/mman.h>

#include <cstdlib>
#include <new>

namespace thalweg {

void* take_large_pages(std::size_t bytes) {
    constexpr std::size_t page = std::size_t{2} << 20;
    std::size_t const whole = (bytes + page - 1) / page * page;
    void* const memory = whole < bytes ? nullptr : std::aligned_alloc(page, whole);
    if (memory == nullptr) {
        throw std::bad_alloc();
    }
    madvise(memory, whole, MADV_HUGEPAGE); // a wish: what comes of it only changes the time
    return memory;
}

void give_large_pages(void* memory) noexcept {
    std::free(memory);
}

} // namespace thalweg
