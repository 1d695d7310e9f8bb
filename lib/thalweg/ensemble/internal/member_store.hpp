// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/ensemble/ensemble.hpp>
#include <thalweg/ensemble/internal/table.hpp>
#include <thalweg/ensemble/make_members.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/io/files/tar.hpp>

namespace thalweg::ensemble {

/// \return "member_00012"
std::string member_folder(std::int64_t number);

/// Numbers of members in order, as ranges: few, where most are there or most are missing.
class MemberNumbers {
public:
    /// Adds [begin, end), beyond all that are in it.
    void add(std::int64_t begin, std::int64_t end);
    std::int64_t size() const { return ranges_.empty() ? 0 : ranges_.back().before + ranges_.back().count; }
    /// \param i [0, size())
    std::int64_t operator[](std::int64_t i) const;

private:
    struct Range {
        std::int64_t begin = 0;
        std::int64_t count = 0;
        std::int64_t before = 0; ///< in the ranges before it
    };
    std::vector<Range> ranges_;
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

    /// \return the members of a share without row or with a file missing, and those that failed
    MemberNumbers missing(Share const& share, Run const& run);
    /// \return members that this process has added and that did not fail
    std::int64_t added() const { return added_; }

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
    Journals::Account finish(Run const& run);

private:
    void open_folder(std::vector<std::string> const& vary, Share const& share, Run const& run);
    bool has_folder(std::int64_t number) const;
    bool is_there(std::int64_t number) const;
    bool is_done(Journals const& journals, RowPlace const& row);
    bool is_in_shard(std::int64_t number);
    std::set<std::int64_t> numbers_of_folders(Run const& run) const;
    std::pair<std::int64_t, std::int64_t> range_of(Share const& share) const;
    void start(std::vector<std::string> const& vary, Run const& run);
    int locked_at(std::string const& path, bool waits, Run const& run);
    void keep(int lock);
    void append(std::string line);
    std::string part(std::int64_t number) const;
    std::string shard_path(std::int64_t shard) const;
    void write_shard(std::string const& path, std::vector<io::TarEntry> const& before,
                     std::vector<std::int64_t> const& parts) const;
    static std::string staged_part(MadeMember const& made, std::string const& work, Run const& run);

    std::string folder_;
    std::string inner_; ///< FOLDER/.ensemble
    Ensemble ensemble_;
    MemberFiles files_;
    Role const role_;
    std::set<std::int64_t> without_row_;                       ///< members with a folder that no journal knows
    std::map<std::int64_t, std::set<std::int64_t>> in_shards_; ///< members of the shards looked into
    std::atomic<std::int64_t> added_ = 0;
    std::unique_ptr<io::OutputFolder> work_;
    std::vector<int> locks_; ///< open files
    std::vector<Finding> findings_;
    std::mutex guard_;
    std::mutex packing_;
    int journal_ = -1; ///< open file
    bool is_broken_ = false;
    std::int64_t next_work_ = 0;
};

} // namespace thalweg::ensemble
