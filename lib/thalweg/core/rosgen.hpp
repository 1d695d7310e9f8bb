// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace thalweg {

/// Rosgen's river types, from steep headwaters to lowlands.
enum class Rosgen : std::uint8_t { aa_plus, a, b, c, d, da, e, f, g };

inline constexpr std::array<Rosgen, 9> rosgen_types{Rosgen::aa_plus, Rosgen::a, Rosgen::b, Rosgen::c, Rosgen::d,
                                                    Rosgen::da,      Rosgen::e, Rosgen::f, Rosgen::g};

/// The name of a river type.
/// \param type any type
/// \return "Aa+", "A", "B", "C", "D", "DA", "E", "F" or "G"
char const* name_of(Rosgen type);

/// Finds a river type by name.
/// \param name case-sensitive; "A+", as \cite nenu2015 writes, means Aa+
/// \return nothing for an unknown name
std::optional<Rosgen> rosgen_of(std::string_view name);

} // namespace thalweg
