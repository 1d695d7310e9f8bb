// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// hmm, the TIN of a DEM at an error of 5 m: hmm SIDE MOUNTAINS
#include <heightmap.h>
#include <triangulator.h>

#include "peer.hpp"

int main(int, char** words) {
    std::size_t const side = peer::size_of(words[1]);
    auto const map =
        std::make_shared<Heightmap>(static_cast<int>(side), static_cast<int>(side), peer::read(words[2], side));
    peer::measure(
        "hmm", side, 3, [] { return 0; },
        [&](int) {
            Triangulator triangulator(map);
            triangulator.Run(5.0F, 0, 0);
        });
}
