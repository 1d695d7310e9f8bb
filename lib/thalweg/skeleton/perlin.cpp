// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/skeleton/internal/perlin.hpp>

#include <libnoise/noise.h>

namespace thalweg::skeleton {

std::vector<double> perlin(std::vector<Vec3> const& places, int seed, Run const& run) {
    constexpr std::size_t places_between_checks = 65536;
    noise::module::Perlin field;
    field.SetSeed(seed);
    field.SetOctaveCount(4);
    field.SetPersistence(0.5);
    field.SetLacunarity(2.0);
    std::vector<double> values(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (i % places_between_checks == 0) {
            run.check();
        }
        values[i] = field.GetValue(places[i].x, places[i].y, places[i].z);
    }
    return values;
}

} // namespace thalweg::skeleton
