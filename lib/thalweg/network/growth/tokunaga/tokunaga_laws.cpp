// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/growth/tokunaga/grow_tokunaga.hpp>

#include <cmath>

#include <fmt/format.h>

#include <thalweg/core/run/parameters.hpp>

namespace thalweg::network {

TokunagaLaws tokunaga_laws(int lambda) {
    require_in("network.tokunaga_laws", "the generator", lambda, Range::between(1, 50));
    TokunagaLaws laws;
    laws.a = lambda - 1;
    laws.c = 0.5 * (1.0 + std::sqrt(1.0 + 4.0 * lambda));
    laws.share = laws.c / lambda;
    double const sum = 2.0 + laws.a + laws.c;
    laws.bifurcation = 0.5 * (sum + std::sqrt(sum * sum - 8.0 * laws.c));
    return laws;
}

double mean_side_branches(int lambda, SideRule rule, int order) {
    TokunagaLaws const laws = tokunaga_laws(lambda);
    if (rule == SideRule::plane) {
        return laws.c - 1.0;
    }
    if (rule == SideRule::constant) {
        return laws.share * laws.a;
    }
    double links = lambda; // of a stream of order t + 1
    double branches = laws.a * laws.c;
    for (int t = 1; t < order - 1; ++t) {
        links += branches;
        branches *= laws.c;
    }
    return branches / links;
}

} // namespace thalweg::network
