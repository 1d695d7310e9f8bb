// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <cstdint>

namespace thalweg {

/// \internal
/// Notes how much memory the process takes now, for every PeakMemory there is. Run::check and the release of a large
/// block call it: between two allocations memory is at its most before something is released.
void note_memory() noexcept;

/// \internal
/// The same, also if it was noted a moment ago: before a large block is released.
void note_memory_now() noexcept;

/// \internal
/// The most memory that the process took while this object lived, of what note_memory saw.
class PeakMemory {
public:
    PeakMemory();
    ~PeakMemory();
    PeakMemory(PeakMemory const&) = delete;
    PeakMemory& operator=(PeakMemory const&) = delete;

    /// \return [bytes] with the program's own; 0: the system does not tell
    std::int64_t bytes() const;
    /// \param now [bytes] that the process takes
    void note(std::int64_t now) noexcept;

private:
    std::atomic<std::int64_t> most_ = 0;
};

/// \internal
/// Keeps blocks of a MiB and more out of the heap, so that each goes back to the system when it is released: between
/// others it would stay the process's. For a program; it holds for all of its libraries.
void return_large_blocks() noexcept;

} // namespace thalweg
