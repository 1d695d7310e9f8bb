// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include <thalweg/core/run/run.hpp>

namespace thalweg {

/// Results of stages, found again by a text that says all they were made from. Those used least recently go first. May
/// be used by several threads.
class Kept {
public:
    /// \param most [bytes] together, at least the newest stays
    explicit Kept(std::int64_t most) : most_(most) {}

    /// \return nothing when there is no such result
    std::shared_ptr<void const> find(std::string const& made_from);
    /// \param bytes that it takes, about
    void keep(std::string made_from, std::shared_ptr<void const> result, std::int64_t bytes);
    /// \return [bytes] of all results
    std::int64_t bytes() const;

private:
    struct One {
        std::string made_from;
        std::shared_ptr<void const> result;
        std::int64_t bytes;
    };

    std::int64_t const most_;
    mutable std::mutex guard_;
    std::list<One> results_; ///< used last in front
    std::int64_t bytes_ = 0;
};

/// Makes the result of a stage, or takes the one that the run has kept.
/// \param made_from everything that decides the result; a function, as it is needed only where results are kept
/// \param make the result
/// \param bytes_of a result
/// \return the result, or a copy of what is kept
template <class MadeFrom, class Make, class BytesOf>
auto kept_or_made(Run const& run, char const* stage, MadeFrom const& made_from, Make const& make,
                  BytesOf const& bytes_of) {
    using Result = decltype(make());
    if (run.kept == nullptr) {
        return make();
    }
    std::string key = stage + ("\n" + made_from());
    if (auto found = run.kept->find(key)) {
        return *std::static_pointer_cast<Result const>(found);
    }
    auto made = std::make_shared<Result const>(make());
    run.kept->keep(std::move(key), made, bytes_of(*made));
    return *made;
}

} // namespace thalweg
