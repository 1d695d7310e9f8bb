// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <thalweg/pipeline/ensemble/ensemble.hpp>

namespace thalweg::pipeline {

/// Formats a row as one line of JSON, without the line's end.
/// \param seconds [s] that making and writing took
/// \param writing_s [s] of it for writing
std::string row_json(MemberRow const& row, double seconds, double writing_s);

/// The values of a row as one JSON object: member, seed, keys, state, measures.
std::string row_object(MemberRow const& row);

/// Where rows are found again: rows of one member are equal, and one of a member that was made counts more than one of
/// a member that failed.
struct RowPlace {
    std::size_t file = 0;    ///< index of the journal
    std::int64_t offset = 0; ///< [bytes] where its line begins
    bool is_failed = false;
};

/// Rows that processes have written, line by line, into journals.
class Journals {
public:
    /// Reads every journal of a folder. Lines that are not complete, as those of a killed process, are left out.
    /// \param folder of files rows-*.jsonl
    /// \throws IoError when one cannot be read
    explicit Journals(std::string const& folder);

    /// By member.
    std::map<std::int64_t, RowPlace> const& rows() const { return rows_; }

    /// What of the members was not ok.
    struct Account {
        std::int64_t ok = 0;
        std::int64_t checks_failed = 0;
        std::int64_t failed = 0;
        std::int64_t warned = 0;
        std::string first_failed;  ///< "member 17: reason"; "": none
        std::string first_check;   ///< likewise
        std::string first_warning; ///< likewise
    };
    /// Writes table.csv and timings.csv of members [0, members), in order. Columns are in the order of the first member
    /// that has them.
    /// \throws IoError when a file cannot be written
    Account write_tables(std::int64_t members, std::string const& table, std::string const& timings) const;

private:
    std::vector<std::string> files_;
    std::map<std::int64_t, RowPlace> rows_;
};

} // namespace thalweg::pipeline
