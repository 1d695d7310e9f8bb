// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>

#include <thalweg/surface/dilation/dilation.hpp>

int main() {
    thalweg::Valley valley{thalweg::Raster<float>({9, 5}, NAN)};
    for (std::int64_t col = 0; col < 9; ++col) {
        valley.z[{col, 2}] = 1.0F; // one level river from the west to the east
    }
    thalweg::surface::DilatedDem const land = thalweg::surface::dilate(valley, {.increment = {.increment = "uniform"}});
    std::printf("%.1f\n", static_cast<double>(land.dem[{4, 0}])); // two dilations of 0.1 above the river
}
