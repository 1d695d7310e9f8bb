// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/run/error.hpp>

#include "ranks/ranks.hpp"

namespace thalweg::tools {

std::string mpi_version() {
    return "without MPI";
}

std::unique_ptr<ensemble::Ranks> join_ranks() {
    if (launched_ranks() > 1) {
        throw BadInput(
            "ensemble.Ranks",
            "this thalweg was built without MPI, and mpirun has started several: start one, share the members "
            "by --share K/N, or install libopenmpi-dev and build thalweg again");
    }
    return nullptr;
}

} // namespace thalweg::tools
