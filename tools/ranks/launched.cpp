// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <charconv>
#include <cstdlib>
#include <string_view>

#include "ranks/ranks.hpp"

namespace thalweg::tools {

int launched_ranks() {
    // Open MPI; MPICH and Intel MPI; srun --mpi=pmix, which also sets SLURM_NTASKS.
    for (char const* const name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK"}) {
        bool const is_srun = std::string_view(name) == "PMIX_RANK";
        char const* const value = std::getenv(is_srun && std::getenv(name) != nullptr ? "SLURM_NTASKS" : name);
        if (value != nullptr) {
            int count = 1;
            std::string_view const text(value);
            std::from_chars(text.data(), text.data() + text.size(), count);
            return count;
        }
    }
    return 1;
}

} // namespace thalweg::tools
