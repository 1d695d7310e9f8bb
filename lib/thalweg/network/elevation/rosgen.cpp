// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/elevation/rosgen.hpp>

#include <cstddef>

#include <thalweg/core/indexed.hpp>

namespace thalweg::network {

namespace {

constexpr double least = 0.001;   // of the classes open below: water must flow
constexpr double greatest = 0.20; // of Aa+, open above

struct Class {
    char const* name;
    SlopeRange slope;
};

// In the order of the enumeration.
constexpr ByEnum<Rosgen, Class, rosgen_types.size()> classes{{{{"Aa+", {0.10, greatest, 0.12}},
                                                               {"A", {0.04, 0.10, 0.07}},
                                                               {"B", {0.02, 0.04, 0.03}},
                                                               {"C", {least, 0.02, 0.01}},
                                                               {"D", {least, 0.04, 0.02}},
                                                               {"DA", {least, 0.005, 0.003}},
                                                               {"E", {least, 0.02, 0.01}},
                                                               {"F", {least, 0.02, 0.01}},
                                                               {"G", {0.02, 0.04, 0.03}}}}};

Class const& class_of(Rosgen type) {
    return classes[type];
}

} // namespace

SlopeRange slope_range(Rosgen type) {
    return class_of(type).slope;
}

char const* name_of(Rosgen type) {
    return class_of(type).name;
}

std::optional<Rosgen> rosgen_of(std::string_view name) {
    for (Rosgen const type : rosgen_types) {
        if (name == name_of(type)) {
            return type;
        }
    }
    return name == "A+" ? std::optional(Rosgen::aa_plus) : std::nullopt;
}

bool is_braided(Rosgen type) {
    return type == Rosgen::d || type == Rosgen::da;
}

} // namespace thalweg::network
