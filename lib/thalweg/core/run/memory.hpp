// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \cpponly

#include <cstddef>
#include <cstdint>
#include <new>

namespace thalweg {

/// Memory that this process can still take.
/// \return [bytes] the system's available memory, or what the control group's limit leaves
std::int64_t free_memory_bytes();

/// The process's peak memory.
/// \return [bytes]
std::int64_t peak_memory_bytes();

/// Allocates memory aligned to 2 MiB, in pages of that size if the system has them: the first access then costs a
/// third.
/// \param bytes size
/// \return to be released by free_large_pages
/// \throws std::bad_alloc when the system refuses
void* allocate_large_pages(std::size_t bytes);
void free_large_pages(void* memory) noexcept;

/// An allocator that uses large pages for large blocks and operator new for small ones.
template <class T> struct LargePages {
    using value_type = T;
    static constexpr std::size_t least_bytes = std::size_t{4} << 20;

    LargePages() = default;
    template <class U> LargePages(LargePages<U> const&) noexcept {}

    T* allocate(std::size_t n) {
        std::size_t const bytes = n * sizeof(T);
        return static_cast<T*>(bytes < least_bytes ? ::operator new(bytes) : allocate_large_pages(bytes));
    }
    void deallocate(T* memory, std::size_t n) noexcept {
        if (n * sizeof(T) < least_bytes) {
            ::operator delete(memory);
        } else {
            free_large_pages(memory);
        }
    }
    friend bool operator==(LargePages const&, LargePages const&) { return true; }
};

} // namespace thalweg
