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

/// Results of stages, found again by a key, a text of all that they were made from. Those used least recently go
/// first. May be used by several threads.
class ResultCache {
public:
    /// \param most [bytes] together, at least the newest stays
    explicit ResultCache(std::int64_t most) : most_(most) {}

    /// \return nothing when there is no such result
    std::shared_ptr<void const> find(std::string const& key);
    /// \param bytes that it takes, about
    void keep(std::string key, std::shared_ptr<void const> result, std::int64_t bytes);
    /// \return [bytes] of all results
    std::int64_t bytes() const;

private:
    struct Entry {
        std::string key;
        std::shared_ptr<void const> result;
        std::int64_t bytes;
    };

    std::int64_t const most_;
    mutable std::mutex guard_;
    std::list<Entry> results_; ///< used last in front
    std::int64_t bytes_ = 0;
};

/// Makes the result of a stage, or takes it from the run's cache.
/// \param key_of everything that decides the result; a function, as it is needed only where there is a cache
/// \param make the result
/// \param bytes_of a result
/// \return the result, or a copy of that in the cache
template <class KeyOf, class Make, class BytesOf>
auto cached(Run const& run, char const* stage, KeyOf const& key_of, Make const& make, BytesOf const& bytes_of) {
    using Result = decltype(make());
    if (run.cache == nullptr) {
        return make();
    }
    std::string key = stage + ("\n" + key_of());
    if (auto found = run.cache->find(key)) {
        return *std::static_pointer_cast<Result const>(found);
    }
    auto made = std::make_shared<Result const>(make());
    run.cache->keep(std::move(key), made, bytes_of(*made));
    return *made;
}

} // namespace thalweg
