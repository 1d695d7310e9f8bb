// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include <thalweg/io/network/internal/read_network_columns.hpp>

namespace thalweg::io {

/// The numbers of a feature; what cannot be read as one stands as 0.
class FeatureNumbers {
public:
    FeatureNumbers(OGRFeature const& feature, std::int64_t number, std::string const& what, Notes& notes)
        : feature_(feature), number_(number), what_(what), notes_(notes) {}

    /// of: the id of the arc or node in the file. nothing: null is no fault, and stands as 0.
    std::int64_t whole(FileColumn const& column, std::int64_t of, bool nothing) const;

private:
    void note(char const* kind, std::int64_t of, std::string text) const {
        notes_.add(what_, {kind, of, {}, 0.0, std::move(text)});
    }

    OGRFeature const& feature_;
    std::int64_t number_; ///< in the order of the layer, from 1
    std::string const& what_;
    Notes& notes_;
};

} // namespace thalweg::io
