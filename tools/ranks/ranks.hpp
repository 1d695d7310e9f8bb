// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>

#include <thalweg/ensemble/ranks.hpp>

namespace thalweg::tools {

/// \return "Open MPI v4.1.4", or "without MPI"
std::string mpi_version();

/// \return the number of processes that mpirun or srun has started together with this one, by the environment; 1: it
/// was started alone
int launched_ranks();

/// Joins the processes that were started together. At the end of its life it waits for all of them.
/// \return null: this process was started alone
/// \throws BadInput in a program without MPI
std::unique_ptr<ensemble::Ranks> join_ranks();

} // namespace thalweg::tools
