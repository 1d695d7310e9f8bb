// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Compiled instead of perlin.cpp where libnoise is not installed.
#include <thalweg/core/run/error.hpp>
#include <thalweg/skeleton/internal/perlin.hpp>

namespace thalweg::skeleton {

std::vector<double> perlin(std::vector<Vec3> const&, int, Run const&) {
    throw BadParameter("skeleton.perlin", "skeleton.ridge_noise needs libnoise, and this thalweg was built without it; "
                                          "install libnoise-dev and build again, or leave ridge_noise out");
}

} // namespace thalweg::skeleton
