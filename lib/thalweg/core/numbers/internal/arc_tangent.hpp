// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

namespace thalweg::portable {

// pi/2 as an unevaluated sum
inline constexpr double half_pi_hi = 0x1.921fb54442d18p+0;
inline constexpr double half_pi_lo = 0x1.1a62633145c07p-54;

// atan(i/8) as unevaluated sums
inline constexpr std::array<double, 9> arc_tangents_hi = {0.0,
                                                          0x1.fd5ba9aac2f6ep-4,
                                                          0x1.f5b75f92c80ddp-3,
                                                          0x1.6f61941e4def1p-2,
                                                          0x1.dac670561bb4fp-2,
                                                          0x1.1e00babdefeb4p-1,
                                                          0x1.4978fa3269ee1p-1,
                                                          0x1.700a7c5784634p-1,
                                                          0x1.921fb54442d18p-1};
inline constexpr std::array<double, 9> arc_tangents_lo = {0.0,
                                                          -0x1.cd37686760c17p-59,
                                                          0x1.8ab6e3cf7afbdp-57,
                                                          -0x1.c63aae6f6e918p-56,
                                                          0x1.a2b7f222f65e2p-56,
                                                          -0x1.928df287a668fp-58,
                                                          0x1.2419a87f2a458p-56,
                                                          -0x1.8c34d25aadef6p-56,
                                                          0x1.1a62633145c07p-55};
/// Of t^3, t^5 ... in atan t, |t| <= 1/16.
inline constexpr std::array<double, 7> arc_tangent_terms = {-1.0 / 3.0,  1.0 / 5.0,  -1.0 / 7.0, 1.0 / 9.0,
                                                            -1.0 / 11.0, 1.0 / 13.0, -1.0 / 15.0};

} // namespace thalweg::portable
