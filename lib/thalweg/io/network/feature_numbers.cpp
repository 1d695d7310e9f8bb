// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/network/internal/feature_numbers.hpp>

#include <fmt/format.h>
#include <ogrsf_frmts.h>

namespace thalweg::io {

std::int64_t FeatureNumbers::whole(FileColumn const& column, std::int64_t of, bool nothing) const {
    if (!column.is_there()) {
        return 0;
    }
    if (column.is_null(feature_)) {
        if (!nothing) {
            note("null_number", of, fmt::format("feature {} has no {}", number_, column.name()));
        }
        return 0;
    }
    if (auto const value = column.whole(feature_)) {
        return *value;
    }
    note("not_a_number", of,
         fmt::format("feature {} has {} {}, not a whole number", number_, column.name(), column.text(feature_)));
    return 0;
}

} // namespace thalweg::io
