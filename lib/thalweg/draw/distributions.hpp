// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <thalweg/draw/picture.hpp>

namespace thalweg::draw {

/// An index of the members of an ensemble, with its natural range.
struct Distribution {
    std::string name;                ///< UTF-8
    std::string unit;                ///< UTF-8; "" for none
    std::vector<double> values;      ///< [unit] by member; NaN: unknown
    std::optional<double> low = {};  ///< [unit] of the natural range; without both ends there is none
    std::optional<double> high = {}; ///< [unit]
    std::string group = {}; ///< UTF-8, a heading above the first of consecutive indices of one group; "" for none
};

/// How many members have an index.
struct DistributionCounts {
    std::int64_t known = 0;                  ///< with a number
    std::optional<std::int64_t> inside = {}; ///< with one in the natural range, ends included; nothing: there is none
};

/// Counts the members that have an index, and those inside its natural range.
DistributionCounts counts_of(Distribution const& index);

/// Options of distributions().
struct DistributionsParams {
    std::string title;   ///< UTF-8; "" for none
    std::string note;    ///< UTF-8, a line below the title; "" for none
    int width_px = 1400; ///< [200, 8000]; the height follows
    Format format = Format::svg;
};

/// Draws a small histogram of each index, or a dot for each member if 20 or fewer have the index. The natural range is
/// a band, members outside it have another colour, a line marks the median. An axis covers the values, and the ends of
/// the range that are near them.
/// \param indices none: an empty sheet that says so
/// \return the picture
/// \throws BadInput when a value is infinite, a range has one end only or ends before it begins, or the picture would
/// be higher than 32 000 pixels
Picture distributions(std::vector<Distribution> const& indices, DistributionsParams const& params = {});

/// Options of responses().
struct ResponsesParams {
    std::string title;   ///< UTF-8; "" for none
    std::string note;    ///< UTF-8, a line below the title; "" for none
    int width_px = 1400; ///< [200, 8000]; the height follows
    Format format = Format::svg;
    std::vector<std::string> words = {}; ///< UTF-8, of a parameter whose values are their numbers from 0; empty: none
};

/// Draws each index against a parameter that varies: a dot for each member, or for 500 evenly chosen ones, natural
/// ranges as bands, medians, and Spearman's rank correlation unless the parameter is a word. Medians are those of each
/// value if there are 8 or fewer, else of groups of ten members or more.
/// \param parameter its values by member; its range and group are not used
/// \param indices by member, as many values as the parameter
/// \return the picture
/// \throws BadInput as distributions(), when an index has not as many values as the parameter, and when a value is not
/// the number of a word
Picture responses(Distribution const& parameter, std::vector<Distribution> const& indices,
                  ResponsesParams const& params = {});

} // namespace thalweg::draw
