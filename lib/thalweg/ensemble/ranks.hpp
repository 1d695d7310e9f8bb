// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

namespace thalweg::ensemble {

/// Processes (ranks) that make the members of an ensemble together, as those that mpirun starts. The first one hands
/// out the numbers of members.
class Ranks {
public:
    Ranks() = default;
    Ranks(Ranks const&) = delete;
    Ranks& operator=(Ranks const&) = delete;
    virtual ~Ranks() = default;

    /// \return [0, count)
    virtual int rank() const = 0;
    /// \return [2, ...]
    virtual int count() const = 0;

    /// Called by all: waits until all are here.
    /// \param is_fine of the first rank
    /// \return that of the first rank
    virtual bool start(bool is_fine) = 0;
    /// Of the first rank: answers the others until each has said good-bye.
    /// \param next the number of a member; nothing: none is left
    /// \param failed called when a rank has failed
    virtual void deal(std::function<std::optional<std::int64_t>()> const& next,
                      std::function<void()> const& failed) = 0;
    /// Of the others, by any thread: asks the first rank for a member.
    virtual std::optional<std::int64_t> ask() = 0;
    /// Of the others, once: tells the first rank that no thread will ask again.
    virtual void say_goodbye(bool is_fine) = 0;
};

} // namespace thalweg::ensemble
