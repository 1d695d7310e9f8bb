// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace thalweg::ensemble {

enum class DrawnStatus : std::uint8_t { ok, check_failed, failed };

/// A member in the table of an ensemble.
struct DrawnMember {
    std::int64_t number = 0;
    std::string seed; ///< as in the table; "": unknown
    DrawnStatus status = DrawnStatus::ok;
    std::string reason;              ///< "" for none
    std::vector<std::string> values; ///< of the varied keys, as in the table
};

/// Numbers of the members in one column of the table.
struct MeasureColumn {
    std::string name;           ///< "law.hack"
    std::vector<double> values; ///< by member; NaN: unknown
};

/// The table of an ensemble.
struct MembersTable {
    std::vector<DrawnMember> members;
    std::vector<std::string> keys;       ///< of the recipe that vary, in the table's order
    std::vector<MeasureColumn> measures; ///< columns rivers.*, dem.*, law.*, dem_law.* and relief.*, in order
};

/// Reads the records of a CSV text strictly by RFC 4180; lines may end with LF alone, and a byte order mark is skipped.
/// \param text the table
/// \param name its name for messages
/// \return a header and the other records, all of the same number of fields
/// \throws BadInput naming the line: a quote inside a field or none at its end, another number of fields than in the
/// header, a NUL, invalid UTF-8
std::vector<std::vector<std::string>> csv_records(std::string_view text, std::string const& name);

/// Reads the table.csv that `make --ensemble` writes.
/// \param path of the table
/// \throws BadInput for a missing file, one above 250 MB or that is no CSV, one without a column member, members or
/// measures, members that are no whole numbers or appear twice, an unknown status, measures that are no numbers
MembersTable read_members_table(std::string const& path);

/// The number that a text is, plain or with an exponent; NaN: it is not a finite number.
double plain_number(std::string_view text);

} // namespace thalweg::ensemble
