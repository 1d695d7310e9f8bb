// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Sample 8: the library inside a program that owns its data.
// Arrays in, arrays out, no file; the program shows progress, can cancel, and survives what goes wrong.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include <thalweg/core.hpp>
#include <thalweg/surface.hpp>

using namespace thalweg;

/// What the program has: heights row by row from the north-west, NaN where none is known.
struct Heights {
    std::int64_t width = 0;
    std::int64_t height = 0;
    std::vector<float> z;
};

//! [arrays]
/// Fills in what is not known. A Raster owns its values; those of the program are copied in and out.
Heights filled(Heights const& known, double cell_m, Run const& run) {
    Grid const grid{known.width, known.height, cell_m, 0, 0, ""};
    Skeleton skeleton{Raster<float>(grid)};
    std::copy(known.z.begin(), known.z.end(), skeleton.z.values().begin());
    surface::DiffusedDem const land = surface::diffuse(skeleton, {.mode = surface::Diffusion::explicit_sweeps}, run);
    return {known.width, known.height, {land.dem.values().begin(), land.dem.values().end()}};
}
//! [arrays]

struct Watch {
    std::stop_source stop = {};
    double cancel_at = 2.0; ///< share of the work
    double seen = 0.0;
    int calls = 0;
};

//! [run]
int show(double share, char const*, void* of) {
    auto& watch = *static_cast<Watch*>(of);
    watch.seen = std::max(watch.seen, share);
    watch.calls += 1;
    if (share >= watch.cancel_at) {
        watch.stop.request_stop(); // any thread may ask for it
    }
    return 1;
}

/// One attempt; whatever happens, the program goes on.
void attempt(char const* name, Heights const& known, double cancel_at = 2.0) {
    Watch watch{.cancel_at = cancel_at};
    Run run;
    run.progress = show;
    run.progress_arg = &watch;
    run.stop = watch.stop.get_token();
    try {
        Heights const land = filled(known, 10.0, run);
        auto const [low, high] = std::minmax_element(land.z.begin(), land.z.end());
        std::printf("%s: %zu heights, %.1f to %.1f m, %.0f %% told in %s\n", name, land.z.size(),
                    static_cast<double>(*low), static_cast<double>(*high), 100.0 * watch.seen,
                    watch.calls > 1 ? "steps" : "one step");
    } catch (Cancelled const&) {
        std::printf("%s: cancelled\n", name);
    } catch (Error const& error) { // where() for the log, what() for the user
        std::printf("%s: refused by %s: %s\n", name, error.where(), error.what());
    }
}
//! [run]

int main() {
    Heights known{200, 100, std::vector<float>(20000, NAN)};
    attempt("nothing known", known);
    known.z[0] = 100.0F;     // north-west
    known.z[19999] = 300.0F; // south-east
    attempt("two corners", known);
    attempt("impatient", known, 0.3);
}
