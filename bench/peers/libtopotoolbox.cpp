// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// libtopotoolbox, filling by Vincent's hybrid algorithm: libtopotoolbox SIDE RELIEF
#include <cstdint>

extern "C" {
#include <topotoolbox.h>
}

#include "peer.hpp"

int main(int, char** words) {
    std::size_t const side = peer::size_of(words[1]);
    std::vector<float> const dem = peer::read(words[2], side);
    std::vector<std::uint8_t> border(side * side, 0);
    for (std::size_t i = 0; i < side; ++i) {
        border[i] = border[(side - 1) * side + i] = border[i * side] = border[i * side + side - 1] = 1;
    }
    peer::measure(
        "libtopotoolbox_fill", side, 3, [&] { return dem; },
        [&](std::vector<float>& values) {
            std::vector<float> filled(side * side);
            std::vector<std::ptrdiff_t> queue(side * side);
            std::ptrdiff_t dims[2] = {static_cast<std::ptrdiff_t>(side), static_cast<std::ptrdiff_t>(side)};
            fillsinks_hybrid(filled.data(), queue.data(), values.data(), border.data(), dims);
        });
}
