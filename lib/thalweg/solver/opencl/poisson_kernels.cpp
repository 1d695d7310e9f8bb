// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/opencl/internal/poisson_kernels.hpp>

namespace thalweg::solver {

namespace {

constexpr std::string_view source_of_poisson = R"(
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#pragma OPENCL FP_CONTRACT OFF

/* A level holds its numbers as one line, row behind row of an even length, with margins of zeros before and after. The
   matrix: diagonal, and what ties a cell to its eastern and southern neighbour; 0 where there is no free cell, so that
   nothing has to ask where rows end. Cells are red and black like a board; the one at 0, 0 is red. Levels are in float:
   they only guide the search, whose own numbers are double. */

/* The finest level: free cells are tied by 1; fixed neighbours are in the diagonal and on the right side. */
kernel void assemble(global const uchar* kind, global const double* value, global const double* source, int sourced,
                     int guessed, double start, double scale, long width, long height, long stride, long margin, global float* diagonal,
                     global float* sink, global float* inverse, global float* east, global float* south, global double* right,
                     global double* u) {
    long const col = get_global_id(0);
    long const row = get_global_id(1);
    long const i = row * width + col;
    if (col >= width || kind[i] != 1) {
        return;
    }
    long const at = margin + row * stride + col;
    bool const inside[4] = {col > 0, col + 1 < width, row > 0, row + 1 < height};
    long const step[4] = {-1, 1, -width, width};
    float degree = 0.0f;
    float to_fixed = 0.0f;
    double sum = sourced ? source[i] : 0.0;
    for (int side = 0; side < 4; ++side) {
        if (inside[side]) {
            uchar const other = kind[i + step[side]];
            degree += other != 0 ? 1.0f : 0.0f;
            to_fixed += other == 2 ? 1.0f : 0.0f;
            sum += other == 2 ? value[i + step[side]] : 0.0;
        }
    }
    diagonal[at] = degree;
    sink[at] = to_fixed;
    inverse[at] = 1.0f / degree;
    east[at] = inside[1] && kind[i + 1] == 1 ? 1.0f : 0.0f;
    south[at] = inside[3] && kind[i + width] == 1 ? 1.0f : 0.0f;
    right[at] = scale * sum;
    u[at] = scale * (guessed ? value[i] : start);
}

/* The matrix of cells two by two: Galerkin's of what ties cells to fixed ones, but between cells a share of it: where
   numbers stay the same two by two, differences between those look steeper than they are. */
kernel void coarsen(global const float* sink, global const float* east, global const float* south, float share,
                    long stride, long margin, long coarse_width, long coarse_stride, long coarse_margin,
                    global float* coarse_sink, global float* coarse_inverse, global float* coarse_east,
                    global float* coarse_south) {
    long const col = get_global_id(0);
    long const row = get_global_id(1);
    if (col >= coarse_width) {
        return;
    }
    long const a = margin + 2 * row * stride + 2 * col;
    long const b = a + 1;
    long const c = a + stride;
    long const d = c + 1;
    long const at = coarse_margin + row * coarse_stride + col;
    float const to_east = share * (east[b] + east[d]);
    float const to_south = share * (south[c] + south[d]);
    float const to_west = share * (east[a - 1] + east[c - 1]);
    float const to_north = share * (south[a - stride] + south[b - stride]);
    float const to_fixed = sink[a] + sink[b] + sink[c] + sink[d];
    float const diagonal = to_fixed + to_east + to_south + to_west + to_north;
    coarse_sink[at] = to_fixed;
    coarse_inverse[at] = diagonal > 0.0f ? 1.0f / diagonal : 0.0f;
    coarse_east[at] = to_east;
    coarse_south[at] = to_south;
}

/* From x = 0: red cells, then black ones. */
kernel void smooth_from_zero(global const float* restrict inverse, global const float* restrict east,
                             global const float* restrict south, global const float* restrict right, long width,
                             long stride, long margin, global float* restrict x) {
    long const col = get_global_id(0);
    long const row = get_global_id(1);
    if (col >= width) {
        return;
    }
    long const at = margin + row * stride + col;
    float const reds = east[at] * (right[at + 1] * inverse[at + 1]) +
                        east[at - 1] * (right[at - 1] * inverse[at - 1]) +
                        south[at] * (right[at + stride] * inverse[at + stride]) +
                        south[at - stride] * (right[at - stride] * inverse[at - stride]);
    x[at] = (right[at] + (((row + col) & 1) ? reds : 0.0f)) * inverse[at];
}

/* What smooth_from_zero leaves of the right side, summed two by two: black cells have none, red ones what their black
   neighbours brought. */
kernel void restrict_residual(global const float* restrict east, global const float* restrict south,
                              global const float* restrict x, long stride, long margin, long coarse_width,
                              long coarse_stride, long coarse_margin, global float* restrict coarse_right) {
    long const col = get_global_id(0);
    long const row = get_global_id(1);
    if (col >= coarse_width) {
        return;
    }
    long const a = margin + 2 * row * stride + 2 * col;
    long const d = a + stride + 1;
    coarse_right[coarse_margin + row * coarse_stride + col] =
        (east[a] * x[a + 1] + east[a - 1] * x[a - 1] + south[a] * x[a + stride] + south[a - stride] * x[a - stride]) +
        (east[d] * x[d + 1] + east[d - 1] * x[d - 1] + south[d] * x[d + stride] + south[d - stride] * x[d - stride]);
}

/* Black cells from red ones to which what the coarser level found is added. */
kernel void correct_black(global const float* restrict inverse, global const float* restrict east,
                          global const float* restrict south, global const float* restrict right,
                          global const float* restrict coarse_x, long width, long stride, long margin,
                          long coarse_stride, long coarse_margin, global float* x) {
    long const row = get_global_id(1);
    long const col = 2 * (long)get_global_id(0) + (1 - (row & 1));
    if (col >= width) {
        return;
    }
    long const at = margin + row * stride + col;
    global const float* const here = coarse_x + coarse_margin + (row >> 1) * coarse_stride;
    global const float* const above = coarse_x + coarse_margin + ((row - 1) >> 1) * coarse_stride;
    global const float* const below = coarse_x + coarse_margin + ((row + 1) >> 1) * coarse_stride;
    float const reds = east[at] * (x[at + 1] + here[(col + 1) >> 1]) +
                        east[at - 1] * (x[at - 1] + here[(col - 1) >> 1]) +
                        south[at] * (x[at + stride] + below[col >> 1]) +
                        south[at - stride] * (x[at - stride] + above[col >> 1]);
    x[at] = (right[at] + reds) * inverse[at];
}

/* Red cells from black ones. */
kernel void smooth_red(global const float* restrict inverse, global const float* restrict east,
                       global const float* restrict south, global const float* restrict right, long width,
                       long stride, long margin, global float* x) {
    long const row = get_global_id(1);
    long const col = 2 * (long)get_global_id(0) + (row & 1);
    if (col >= width) {
        return;
    }
    long const at = margin + row * stride + col;
    x[at] = (right[at] + east[at] * x[at + 1] + east[at - 1] * x[at - 1] + south[at] * x[at + stride] +
             south[at - stride] * x[at - stride]) *
            inverse[at];
}

/* The sum of a group's numbers, in one order. */
void sum_of_group(local double* own, double mine, global double* sums) {
    int const me = get_local_id(0);
    own[me] = mine;
    for (int step = GROUP / 2; step > 0; step /= 2) {
        barrier(CLK_LOCAL_MEM_FENCE);
        if (me < step) {
            own[me] += own[me + step];
        }
    }
    if (me == 0) {
        sums[get_group_id(0)] = own[0];
    }
}

/* A group takes GROUP * EACH cells that stand in a line; sums has a number for every group. */
#define FIRST (margin + (long)get_group_id(0) * GROUP * EACH + get_local_id(0))

kernel void square_sum(global const double* restrict a, long margin, global double* restrict sums) {
    local double own[GROUP];
    double sum = 0.0;
    for (long k = 0, at = FIRST; k < EACH; ++k, at += GROUP) {
        sum += a[at] * a[at];
    }
    sum_of_group(own, sum, sums);
}

/* Of each work item the greatest |u| and |z|. */
kernel void find_greatest(global const double* restrict u, global const float* restrict z, long margin,
                          global double* restrict most_u, global double* restrict most_z) {
    double a = 0.0;
    double b = 0.0;
    for (long k = 0, at = FIRST; k < EACH; ++k, at += GROUP) {
        a = fmax(a, fabs(u[at]));
        b = fmax(b, fabs((double)z[at]));
    }
    most_u[get_global_id(0)] = a;
    most_z[get_global_id(0)] = b;
}

kernel void product_sum(global const double* restrict r, global const float* restrict z, long margin,
                        global double* restrict sums) {
    local double own[GROUP];
    double sum = 0.0;
    for (long k = 0, at = FIRST; k < EACH; ++k, at += GROUP) {
        sum += r[at] * z[at];
    }
    sum_of_group(own, sum, sums);
}

double product_at(global const float* restrict diagonal, global const float* restrict east,
                  global const float* restrict south, global const double* restrict p, long stride, long at) {
    return diagonal[at] * p[at] - east[at] * p[at + 1] - east[at - 1] * p[at - 1] - south[at] * p[at + stride] -
           south[at - stride] * p[at - stride];
}

/* r = right - A u, and r' r; scaled is scale r. */
kernel void find_residual(global const float* restrict diagonal, global const float* restrict east,
                          global const float* restrict south, global const double* restrict u,
                          global const double* restrict right, double scale, long stride, long margin,
                          global double* restrict r, global float* restrict scaled, global double* restrict sums) {
    local double own[GROUP];
    double sum = 0.0;
    for (long k = 0, at = FIRST; k < EACH; ++k, at += GROUP) {
        double const left = right[at] - product_at(diagonal, east, south, u, stride, at);
        r[at] = left;
        scaled[at] = scale * left;
        sum += left * left;
    }
    sum_of_group(own, sum, sums);
}

/* q = A p, and p' q. */
kernel void apply(global const float* restrict diagonal, global const float* restrict east,
                  global const float* restrict south, global const double* restrict p, long stride, long margin,
                  global double* restrict q, global double* restrict sums) {
    local double own[GROUP];
    double sum = 0.0;
    for (long k = 0, at = FIRST; k < EACH; ++k, at += GROUP) {
        double const product = product_at(diagonal, east, south, p, stride, at);
        q[at] = product;
        sum += p[at] * product;
    }
    sum_of_group(own, sum, sums);
}

/* u += alpha p, r -= alpha q, and r' r; scaled is scale r. */
kernel void advance(global const double* restrict p, global const double* restrict q, double alpha, double scale,
                    long margin, global double* restrict u, global double* restrict r, global float* restrict scaled,
                    global double* restrict sums) {
    local double own[GROUP];
    double sum = 0.0;
    for (long k = 0, at = FIRST; k < EACH; ++k, at += GROUP) {
        u[at] += alpha * p[at];
        double const left = r[at] - alpha * q[at];
        r[at] = left;
        scaled[at] = scale * left;
        sum += left * left;
    }
    sum_of_group(own, sum, sums);
}

/* p = z + beta p. */
kernel void turn(global const float* restrict z, double beta, long margin, global double* restrict p) {
    long const at = margin + get_global_id(0);
    p[at] = z[at] + beta * p[at];
}

/* Into the free cells of the grid. */
kernel void collect(global const uchar* kind, global const double* u, double times, long width, long stride, long margin,
                    global double* value) {
    long const col = get_global_id(0);
    long const row = get_global_id(1);
    long const i = row * width + col;
    if (col < width && kind[i] == 1) {
        value[i] = times * u[margin + row * stride + col];
    }
}
)";

} // namespace

std::string_view poisson_kernels() {
    return source_of_poisson;
}

} // namespace thalweg::solver
