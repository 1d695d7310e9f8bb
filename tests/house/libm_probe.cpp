// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Hashes what libm gives. It tells whether masking the processor's features has any effect: where it has none,
// comparing fingerprints with and without them shows nothing.
#include <cmath>
#include <cstdio>

#include "fnv.hpp"

int main() {
    Fnv fnv;
    for (int i = 1; i <= 200000; ++i) {
        double const x = i * 0.37;
        fnv.add(std::sin(x));
        fnv.add(std::exp(x * 1e-3));
        fnv.add(std::pow(x, 0.7));
    }
    std::printf("%016llx\n", static_cast<unsigned long long>(fnv.hash()));
}
