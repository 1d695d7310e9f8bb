// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/opencl/internal/relax_kernels.hpp>

namespace thalweg::solver {

std::string_view relax_kernels() {
    return R"(
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#pragma OPENCL FP_CONTRACT OFF

/* Of every free cell a bit for each neighbour that is not outside: west 1, east 2, north 4, south 8; else 0. */
kernel void find_sides(global const uchar* kind, long width, long height, long margin, global uchar* sides) {
    long const col = get_global_id(0);
    long const row = get_global_id(1);
    long const i = row * width + col;
    if (col >= width || kind[i] != 1) {
        return;
    }
    uchar open = 0;
    if (col > 0 && kind[i - 1] != 0) {
        open |= 1;
    }
    if (col + 1 < width && kind[i + 1] != 0) {
        open |= 2;
    }
    if (row > 0 && kind[i - width] != 0) {
        open |= 4;
    }
    if (row + 1 < height && kind[i + width] != 0) {
        open |= 8;
    }
    sides[margin + i] = open;
}

/* One sweep over all cells as one line; the margins keep its neighbours inside the arrays. */
kernel void sweep(global const uchar* restrict sides, global const double* restrict from, double alpha, long width,
                  long margin, global double* restrict to) {
    long const i = margin + get_global_id(0);
    uchar const open = sides[i];
    double const u = from[i];
    double const west = (open & 1) ? from[i - 1] : 0.0;
    double const east = (open & 2) ? from[i + 1] : 0.0;
    double const north = (open & 4) ? from[i - width] : 0.0;
    double const south = (open & 8) ? from[i + width] : 0.0;
    double const sum = (west + east) + (north + south);
    double const count = (open & 1) + (open >> 1 & 1) + (open >> 2 & 1) + (open >> 3);
    to[i] = open ? u + alpha * (sum - count * u) : u;
}
)";
}

} // namespace thalweg::solver
