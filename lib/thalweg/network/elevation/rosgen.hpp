// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace thalweg::network {

/// Rosgen's types of rivers, from steep headwaters to flat land.
enum class Rosgen : std::uint8_t { aa_plus, a, b, c, d, da, e, f, g };

inline constexpr std::array<Rosgen, 9> rosgen_types{Rosgen::aa_plus, Rosgen::a, Rosgen::b, Rosgen::c, Rosgen::d,
                                                    Rosgen::da,      Rosgen::e, Rosgen::f, Rosgen::g};

/// How steeply rivers of a type fall. Law: 0 < low < high, low <= usual <= high. Where the table leaves a class open,
/// it ends at 0.001 below and 0.2 above. Source: Rosgen 1994; \cite nenu2015, table 2.
struct SlopeRange {
    double low = 0.0;   ///< [m/m]
    double high = 0.0;  ///< [m/m]
    double usual = 0.0; ///< [m/m] where one slope stands for the class
};
SlopeRange slope_range(Rosgen type);

/// \param type the type
/// \return "Aa+", "A", "B", "C", "D", "DA", "E", "F" or "G".
char const* name_of(Rosgen type);

/// \param name its name
/// \return the type of a name in these very letters, or nothing; "A+", as in the text of Northeast Normal University
/// 2015, is Aa+.
std::optional<Rosgen> rosgen_of(std::string_view name);

/// \param type the type
/// \return whether rivers of the type run in several channels: D and DA.
bool is_braided(Rosgen type);

} // namespace thalweg::network
