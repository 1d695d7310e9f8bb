// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/ensemble/ensemble.hpp>
#include <thalweg/ensemble/ranks.hpp>

namespace thalweg::ensemble {

/// What an ensemble leaves of each member, beside its row of the table.
struct MemberFiles {
    bool folders = true;              ///< member_00000 and so on
    std::int64_t members_a_shard = 0; ///< > 0: shard-000000.tar and so on, in place of folders
};

/// Part K of N of an ensemble, for several processes.
struct Share {
    std::int64_t number = 1; ///< [1, of]
    std::int64_t of = 1;
};

/// An ensemble to make, and where its members are kept.
struct EnsembleOrder {
    Ensemble ensemble = {};
    std::vector<std::string> vary = {}; ///< what varies, as read_varied_key() takes it
    MemberFiles files = {};
    std::string folder = {};
    Share share = {}; ///< the part to make
};

/// What became of an ensemble.
struct EnsembleResult {
    std::int64_t members = 0;           ///< of the ensemble
    std::int64_t made_now = 0;          ///< by this run
    std::int64_t found = 0;             ///< of its share, made by earlier runs
    std::int64_t ok = 0;                ///< of all members, like the following; 0 for a share
    std::int64_t checks_failed = 0;     ///< made, and a check failed
    std::int64_t failed = 0;            ///< not made
    std::int64_t warned = 0;            ///< made with warnings
    std::string table = {};             ///< path of table.csv; "" for a share
    double seconds = 0.0;               ///< [s] of making and writing members
    std::vector<Finding> findings = {}; ///< on the whole ensemble
};

/// \internal
/// \param run threads: 0 for all cores
/// \return how many members are made at a time
int threads_of(Run const& run);

/// Makes the members of an ensemble that its folder does not hold yet, on several threads, and writes the tables when
/// all are there.
/// \internal
/// \param order the ensemble
/// \param ranks other processes, to which the members are dealt; null: none
/// \throws Error as run_ensemble()
EnsembleResult make_members(EnsembleOrder const& order, Ranks* ranks, Run const& run);

/// Makes the members that the first rank hands out.
/// \internal
/// \pre start() of the ranks has been called
EnsembleResult help_to_make(EnsembleOrder const& order, Ranks& ranks, Run const& run);

} // namespace thalweg::ensemble
