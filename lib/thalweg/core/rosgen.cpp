// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/rosgen.hpp>

#include <thalweg/core/by_enum.hpp>

namespace thalweg {
namespace {

// In the order of the enumeration.
constexpr ByEnum<Rosgen, char const*, rosgen_types.size()> names_of_rivers{
    {{"Aa+", "A", "B", "C", "D", "DA", "E", "F", "G"}}};

} // namespace

char const* name_of(Rosgen type) {
    return names_of_rivers[type];
}

std::optional<Rosgen> rosgen_of(std::string_view name) {
    for (Rosgen const type : rosgen_types) {
        if (name == name_of(type)) {
            return type;
        }
    }
    return name == "A+" ? std::optional(Rosgen::aa_plus) : std::nullopt;
}

} // namespace thalweg
