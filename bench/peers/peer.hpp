// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

/// What the programs in this folder share. scripts/bench compiles each with a library of others, calls it with a side
/// (or a number of particles) and, if it reads one, an input of thalweg_instructions --write, and reads its lines.
namespace peer {

inline std::size_t size_of(char const* word) {
    return static_cast<std::size_t>(std::atoll(word));
}

/// side x side floats, rows from the north.
inline std::vector<float> read(char const* path, std::size_t side) {
    std::vector<float> values(side * side);
    std::ifstream in(path, std::ios::binary);
    if (!in.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(float)))) {
        std::fprintf(stderr, "cannot read %s\n", path);
        std::exit(1);
    }
    return values;
}

inline double cpu_ns() {
    std::timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return 1e9 * static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec);
}

/// Prints "NAME/SIZE CPU_NS", the least of some runs. What prepare gives is not counted.
template <class Prepare, class Work>
void measure(std::string const& name, std::size_t size, int times, Prepare prepare, Work work) {
    double least = 0.0;
    for (int time = 0; time < times; ++time) {
        auto data = prepare();
        double const begin = cpu_ns();
        work(data);
        double const took = cpu_ns() - begin;
        least = time == 0 || took < least ? took : least;
    }
    std::printf("%s/%zu %.0f\n", name.c_str(), size, least);
}

} // namespace peer
