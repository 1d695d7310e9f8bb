// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/pipeline/ensemble/ensemble.hpp>
#include <thalweg/pipeline/ensemble/internal/table.hpp>

namespace thalweg::pipeline {

/// What an ensemble leaves of each member, beside its row of the table.
struct MemberFiles {
    bool folders = true;              ///< member_00000 and so on
    std::int64_t members_a_shard = 0; ///< > 0: shard-000000.tar and so on, in place of folders
};

/// \return "member_00012"
std::string member_folder(std::int64_t number);

/// Part K of N of an ensemble, for several processes.
struct Share {
    std::int64_t number = 1; ///< [1, of]
    std::int64_t of = 1;
};

/// The folder of an ensemble. Members are committed one by one, by several processes at once: the row of the table is
/// appended to a journal of the process, then the member's files are renamed into place. What a killed process leaves
/// unfinished is made again.
class MemberStore {
public:
    /// Who works in the folder.
    enum class Role : std::uint8_t {
        alone, ///< the whole ensemble: no other such process may work there
        share, ///< a share of it, beside other shares
        helper ///< a rank beside the first: the folder is there
    };

    /// Creates the folder with recipe.toml, inputs/ and ensemble.json, or opens one that has the same.
    /// \param folder of the ensemble
    /// \param ensemble its recipe's files are copied into inputs/
    /// \param vary as the user wrote it
    /// \throws BadInput when the folder holds something else or another ensemble, or another process works there
    /// \throws IoError when it cannot be written
    MemberStore(std::string const& folder, Ensemble ensemble, std::vector<std::string> const& vary,
                MemberFiles const& files, Role role, Share const& share, Run const& run);
    ~MemberStore();
    MemberStore(MemberStore const&) = delete;
    MemberStore& operator=(MemberStore const&) = delete;

    /// \return what was found when the folder was opened
    std::vector<Finding> const& findings() const { return findings_; }

    /// \return with the recipe that the folder holds
    Ensemble const& ensemble() const { return ensemble_; }

    /// \return the members of a share without files or row, and those that failed, in order
    std::vector<std::int64_t> missing(Share const& share = {});

    /// \return the number of members of a share
    std::int64_t members_of(Share const& share) const;

    /// Tells whether another process that works on the same share has committed a member since missing().
    bool made_meanwhile(std::int64_t number) const;

    /// Writes and commits a member. Several threads may do so at once.
    /// \param made a member; its terrain is written
    /// \param seconds [s] that making it took
    /// \throws IoError when a file cannot be written
    void add(MadeMember const& made, double seconds, Run const& run);

    /// Packs a shard whose members are all there.
    /// \param shard its number; others are left as they are
    void pack(std::int64_t shard);
    std::int64_t shard_of(std::int64_t number) const;

    /// Writes table.csv and timings.csv of all members, and packs the shards that are left.
    Journals::Account finish();

private:
    bool has_folder(std::int64_t number) const;
    bool is_there(std::int64_t number) const;
    std::pair<std::int64_t, std::int64_t> range_of(Share const& share) const;
    void start(std::vector<std::string> const& vary, Run const& run);
    void lock(Role role, Share const& share);
    void append(std::string line);
    std::string part(std::int64_t number) const;
    std::string shard_path(std::int64_t shard) const;
    static std::string staged_part(MadeMember const& made, std::string const& work, Run const& run);

    std::string folder_;
    std::string inner_; ///< FOLDER/.ensemble
    Ensemble ensemble_;
    MemberFiles files_;
    Role const role_;
    std::set<std::int64_t> without_row_; ///< members with a folder that no journal knows
    std::unique_ptr<io::OutputFolder> work_;
    std::vector<int> locks_; ///< open files
    std::vector<Finding> findings_;
    std::mutex guard_;
    std::mutex packing_;
    int journal_ = -1; ///< open file
    bool is_broken_ = false;
    std::int64_t next_work_ = 0;
};

} // namespace thalweg::pipeline
