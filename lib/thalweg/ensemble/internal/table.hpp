// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/ensemble/ensemble.hpp>

namespace thalweg::ensemble {

/// A hash of bytes (FNV-1a, 64 bits).
std::uint64_t hash_of(std::string_view text);

/// How a member was made.
struct MemberWork {
    double seconds = 0.0;                ///< [s] that making and writing took
    double writing_s = 0.0;              ///< [s] of it for writing
    std::vector<std::string> files = {}; ///< of the member's folder, by names relative to it; none without a folder
};

/// Formats a row as one line of JSON with a checksum, without the line's end.
std::string row_json(MemberRow const& row, MemberWork const& work);

/// The values of a row as one JSON object: member, seed, keys, state, measures.
std::string row_object(MemberRow const& row);

/// Where rows are found again: rows of one member are equal, and one of a member that was made counts more than one of
/// a member that failed.
struct RowPlace {
    std::int64_t member = 0;
    std::int64_t offset = 0; ///< [bytes] where its line begins
    std::uint32_t file = 0;  ///< index of the journal
    std::uint32_t files = 0; ///< of the member, an index of Journals::files_of()
    bool is_failed = false;
    bool had_failed = false; ///< before it was made
};

/// Rows that processes have written, line by line, into journals.
class Journals {
public:
    /// Reads every journal of a folder. Lines that are not complete, as those of a killed process, and damaged ones are
    /// left out.
    /// \param folder of files rows-*.jsonl
    /// \throws BadInput when one is a link, a pipe or a device
    /// \throws IoError when one cannot be read
    Journals(std::string const& folder, Run const& run);

    /// By member, one each.
    std::vector<RowPlace> const& rows() const { return rows_; }
    /// \return the names of a member's files
    std::vector<std::string> const& files_of(RowPlace const& row) const { return lists_[row.files]; }
    /// \return lines that are complete, but not as they were written
    std::int64_t damaged() const { return damaged_; }

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
    Account write_tables(std::int64_t members, std::string const& table, std::string const& timings,
                         Run const& run) const;

private:
    std::vector<std::string> journals_;
    std::vector<std::vector<std::string>> lists_{{}}; ///< different lists of files; the first is empty
    std::vector<RowPlace> rows_;
    std::int64_t damaged_ = 0;
};

} // namespace thalweg::ensemble
