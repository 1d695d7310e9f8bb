// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <thalweg/commands/make.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/ensemble/make_members.hpp>
#include <thalweg/ensemble/ranks.hpp>
#include <thalweg/recipe/plan.hpp>

namespace thalweg::commands {

/// Options of run_ensemble().
struct EnsembleParams : MakeParams {
    std::int64_t members = 0;                     ///< [1, 1e9]
    std::optional<std::uint64_t> first_seed = {}; ///< of member 0; nothing: that of the recipe
    std::vector<std::string> vary = {};           ///< as read_varied_key() takes them
    std::int64_t members_a_shard = 0;             ///< [0, 1e6] of a tar file; 0: a folder for each member
    std::int64_t share = 1;                       ///< [1, shares] the part of the members to make
    std::int64_t shares = 1;                      ///< [1, 1e6] parts
};

/// Runs `thalweg make --ensemble`: makes terrains by one recipe that differ in the seed and in what varies, and leaves
/// a folder for each, or tar files of many, and table.csv with a row for each. Members that the folder already holds
/// are kept; those that failed are tried again. The files are those of the recipe's output.files, dem and network where
/// it names none; "table" among the files asked for, alone, leaves no other.
/// \param params recipe or rivers, and options
/// \return what became of it; a share writes no table
/// \throws BadParameter for options out of their range, and when none of the first members has a possible recipe
/// \throws BadInput when the folder holds something else, or another ensemble
/// \throws IoError when a file cannot be written; members committed before stay
/// \throws Cancelled when the work must stop; members committed before stay
ensemble::EnsembleResult run_ensemble(EnsembleParams const& params, Run const& run = {});

/// \internal
/// Does the same together with other processes, which call it too: members are dealt to whoever is free.
/// \param ranks the processes; outlives the call
/// \return what became of the ensemble; of other ranks than the first, only what they made
/// \throws Error as run_ensemble(); IoError on the first rank when another one failed
ensemble::EnsembleResult run_ensemble_on(ensemble::Ranks& ranks, EnsembleParams const& params, Run const& run = {});

/// \internal
/// Runs `thalweg make --ensemble --dry-run`: plans member 0, and writes nothing.
/// \return memory of all workers, time of all members on one core
/// \throws Error as run_ensemble()
recipe::Forecast forecast_ensemble(EnsembleParams const& params, Run const& run = {});

} // namespace thalweg::commands
