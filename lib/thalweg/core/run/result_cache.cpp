// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/run/result_cache.hpp>

#include <algorithm>

namespace thalweg {

std::shared_ptr<void const> ResultCache::find(std::string const& key) {
    std::scoped_lock const lock(guard_);
    auto const found = std::ranges::find(results_, key, &Entry::key);
    if (found == results_.end()) {
        return nullptr;
    }
    results_.splice(results_.begin(), results_, found);
    return results_.front().result;
}

void ResultCache::keep(std::string key, std::shared_ptr<void const> result, std::int64_t bytes) {
    std::scoped_lock const lock(guard_);
    results_.push_front({std::move(key), std::move(result), bytes});
    bytes_ += bytes;
    while (bytes_ > most_ && results_.size() > 1) {
        bytes_ -= results_.back().bytes;
        results_.pop_back();
    }
}

std::int64_t ResultCache::bytes() const {
    std::scoped_lock const lock(guard_);
    return bytes_;
}

} // namespace thalweg
