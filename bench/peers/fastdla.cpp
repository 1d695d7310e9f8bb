// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// fastDLA (clusters off the lattice): fastdla PARTICLES
#include <cstdio>
#include <iostream>

#include <fastDLA.hpp>

#include "peer.hpp"

int main(int, char** words) {
    std::size_t const particles = peer::size_of(words[1]);
    peer::measure(
        "fastdla", particles, 3, [] { return 0; }, [&](int) { FastCluster(static_cast<int>(particles), 7); });
}
