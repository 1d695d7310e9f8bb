// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/numbers/elementary.hpp>

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <thalweg/core/numbers/internal/arc_tangent.hpp>

namespace thalweg::portable {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

// ln 2 and pi/2 in pieces short enough that a whole number times a leading piece is exact.
constexpr double ln2_hi = 0x1.62e42fefa3800p-1;
constexpr double ln2_lo = 0x1.ef35793c76730p-45;
constexpr std::array<double, 4> half_pi = {0x1.921fb54400000p+0, 0x1.0b4611a600000p-34, 0x1.3198a2e000000p-69,
                                           0x1.b839a252049c1p-104};
constexpr double inverse_ln2 = 0x1.71547652b82fep+0;
constexpr double two_over_pi = 0x1.45f306dc9c883p-1;
constexpr double sqrt2 = 0x1.6a09e667f3bcdp+0;
constexpr double widest_angle = 1e5;

/// A number as an unevaluated sum: |lo| is at most half a unit in the last place of hi.
struct DoubleDouble {
    double hi;
    double lo;
};

/// a + b without error (Knuth 1969).
DoubleDouble sum(double a, double b) {
    double const hi = a + b;
    double const back = hi - a;
    return {hi, (a - (hi - back)) + (b - back)};
}

/// a b without error (Dekker 1971).
DoubleDouble product(double a, double b) {
    constexpr double splitter = 0x1p27 + 1.0;
    double const a_big = splitter * a;
    double const a_hi = a_big - (a_big - a);
    double const a_lo = a - a_hi;
    double const b_big = splitter * b;
    double const b_hi = b_big - (b_big - b);
    double const b_lo = b - b_hi;
    double const hi = a * b;
    return {hi, ((a_hi * b_hi - hi) + a_hi * b_lo + a_lo * b_hi) + a_lo * b_lo};
}

DoubleDouble operator+(DoubleDouble a, DoubleDouble b) {
    DoubleDouble const s = sum(a.hi, b.hi);
    return sum(s.hi, s.lo + (a.lo + b.lo));
}

DoubleDouble operator*(DoubleDouble a, DoubleDouble b) {
    DoubleDouble const p = product(a.hi, b.hi);
    return sum(p.hi, p.lo + (a.hi * b.lo + a.lo * b.hi));
}

/// c[0] + x (c[1] + x (c[2] + ...)).
template <std::size_t N> double polynomial(std::array<double, N> const& c, double x) {
    double value = c[N - 1];
    for (std::size_t i = N - 1; i-- > 0;) {
        value = c[i] + x * value;
    }
    return value;
}

/// x = mantissa 2^exponent with the mantissa in [sqrt(1/2), sqrt(2)].
struct ScaledNumber {
    double mantissa;
    double exponent;
};

ScaledNumber split(double x) {
    double exponent = 0.0;
    if (x < std::numeric_limits<double>::min()) {
        x *= 0x1p54;
        exponent = -54.0;
    }
    auto const bits = std::bit_cast<std::uint64_t>(x);
    exponent += static_cast<double>(static_cast<std::int64_t>(bits >> 52) - 1023);
    double const mantissa = std::bit_cast<double>((bits & 0x000fffffffffffffULL) | 0x3ff0000000000000ULL);
    return mantissa > sqrt2 ? ScaledNumber{0.5 * mantissa, exponent + 1.0} : ScaledNumber{mantissa, exponent};
}

double power_of_two(std::int64_t k) {
    return std::bit_cast<double>(static_cast<std::uint64_t>(k + 1023) << 52);
}

/// x 2^k, rounded once.
double scaled(double x, std::int64_t k) {
    if (k > 1023) {
        return x * 0x1p1023 * power_of_two(k - 1023);
    }
    if (k < -1022) {
        return x * power_of_two(k + 128) * 0x1p-128;
    }
    return x * power_of_two(k);
}

/// exp(x.hi + x.lo): Taylor series on |r| <= ln(2)/2, the first term left out is below 2^-58.
double exp_of(DoubleDouble x) {
    static constexpr std::array<double, 12> terms = {
        1.0 / 2.0,     1.0 / 6.0,      1.0 / 24.0,      1.0 / 120.0,      1.0 / 720.0,       1.0 / 5040.0,
        1.0 / 40320.0, 1.0 / 362880.0, 1.0 / 3628800.0, 1.0 / 39916800.0, 1.0 / 479001600.0, 1.0 / 6227020800.0};
    if (x.hi > 709.79) {
        return infinity;
    }
    if (x.hi < -745.2) {
        return 0.0;
    }
    double const k = std::floor(x.hi * inverse_ln2 + 0.5);
    DoubleDouble const r = sum(x.hi - k * ln2_hi, x.lo - k * ln2_lo);
    double const curved = r.hi * r.hi * polynomial(terms, r.hi);
    return scaled(1.0 + (r.hi + (curved + r.lo)), static_cast<std::int64_t>(k));
}

/// ln x for a finite x > 0 to about 2^-68 of its value: ln m = 2 artanh s, s = (m - 1)/(m + 1), |s| < 0.1716.
DoubleDouble log_double_double(double x) {
    static constexpr DoubleDouble third = {0x1.5555555555555p-2, 0x1.5555555555555p-56};
    static constexpr DoubleDouble fifth = {0x1.999999999999ap-3, -0x1.999999999999ap-57};
    static constexpr std::array<double, 9> rest = {1.0 / 7.0,  1.0 / 9.0,  1.0 / 11.0, 1.0 / 13.0, 1.0 / 15.0,
                                                   1.0 / 17.0, 1.0 / 19.0, 1.0 / 21.0, 1.0 / 23.0};
    ScaledNumber const part = split(x);
    double const above = part.mantissa - 1.0;
    DoubleDouble const below = sum(part.mantissa, 1.0);
    double const s_hi = above / below.hi;
    DoubleDouble const back = product(s_hi, below.hi);
    double const s_lo = (((above - back.hi) - back.lo) - s_hi * below.lo) / below.hi;
    DoubleDouble const s = sum(s_hi, s_lo);
    DoubleDouble const square = s * s;
    DoubleDouble const tail = sum(0.0, square.hi * polynomial(rest, square.hi));
    DoubleDouble const half = s + s * (square * (third + square * (fifth + tail)));
    DoubleDouble const whole = sum(part.exponent * ln2_hi, part.exponent * ln2_lo);
    return whole + DoubleDouble{2.0 * half.hi, 2.0 * half.lo};
}

/// sin and cos of r.hi + r.lo, |r| <= pi/4: Taylor series, the first term left out is below 2^-58.
double sin_near_zero(DoubleDouble r) {
    static constexpr std::array<double, 8> terms = {-1.0 / 6.0,          1.0 / 120.0,         -1.0 / 5040.0,
                                                    1.0 / 362880.0,      -1.0 / 39916800.0,   1.0 / 6227020800.0,
                                                    -1.0 / 1307674368e3, 1.0 / 355687428096e3};
    double const square = r.hi * r.hi;
    return r.hi + (r.hi * square * polynomial(terms, square) + r.lo * (1.0 - 0.5 * square));
}

double cos_near_zero(DoubleDouble r) {
    static constexpr std::array<double, 8> terms = {1.0 / 24.0,          -1.0 / 720.0,          1.0 / 40320.0,
                                                    -1.0 / 3628800.0,    1.0 / 479001600.0,     -1.0 / 87178291200.0,
                                                    1.0 / 20922789888e3, -1.0 / 6402373705728e3};
    double const square = r.hi * r.hi;
    double const fall = 0.5 * square;
    double const rest = 1.0 - fall;
    return rest + (((1.0 - rest) - fall) + (square * square * polynomial(terms, square) - r.hi * r.lo));
}

/// x = r + quarter pi/2 (modulo 2 pi), |r| <= pi/4 (Cody and Waite 1980, in four pieces).
struct ReducedAngle {
    DoubleDouble rest;
    int quarter;
};

ReducedAngle turn(double x) {
    double const n = std::floor(x * two_over_pi + 0.5);
    DoubleDouble const first = sum(x - n * half_pi[0], -n * half_pi[1]);
    DoubleDouble const second = sum(first.hi, -n * half_pi[2]);
    return {sum(second.hi, first.lo + (second.lo - n * half_pi[3])), static_cast<int>(n - 4.0 * std::floor(0.25 * n))};
}

/// atan q for q in [0, 1], from the nearest tabulated atan(i/8) and the series on |t| <= 1/16.
DoubleDouble atan_of(double q) {
    double const step = std::floor(8.0 * q + 0.5);
    double const known = 0.125 * step;
    double const t = (q - known) / (1.0 + q * known);
    auto const i = static_cast<std::size_t>(step);
    return sum(arc_tangents_hi[i], t + (t * (t * t) * polynomial(arc_tangent_terms, t * t) + arc_tangents_lo[i]));
}

} // namespace

double exp(double x) {
    return x != x ? x : exp_of({x, 0.0});
}

double log(double x) {
    if (!(x > 0.0)) {
        return x == 0.0 ? -infinity : not_a_number;
    }
    return x == infinity ? x : log_double_double(x).hi;
}

double pow(double x, double y) {
    if (x == 1.0 || y == 0.0) {
        return 1.0;
    }
    if (!(x >= 0.0) || y != y) {
        return not_a_number;
    }
    if (x == 0.0 || x == infinity) {
        return (x > 0.0) == (y > 0.0) ? infinity : 0.0;
    }
    DoubleDouble const logarithm = log_double_double(x);
    double const rough = y * logarithm.hi;
    if (rough > 710.0) {
        return infinity;
    }
    if (rough < -746.0) {
        return 0.0;
    }
    return exp_of(logarithm * DoubleDouble{y, 0.0});
}

double sin(double x) {
    if (!(std::fabs(x) <= widest_angle)) {
        return not_a_number;
    }
    ReducedAngle const t = turn(x);
    double const value = t.quarter % 2 == 0 ? sin_near_zero(t.rest) : cos_near_zero(t.rest);
    return t.quarter < 2 ? value : -value;
}

double cos(double x) {
    if (!(std::fabs(x) <= widest_angle)) {
        return not_a_number;
    }
    ReducedAngle const t = turn(x);
    double const value = t.quarter % 2 == 0 ? cos_near_zero(t.rest) : sin_near_zero(t.rest);
    return t.quarter == 0 || t.quarter == 3 ? value : -value;
}

double atan2(double y, double x) {
    if (x != x || y != y) {
        return not_a_number;
    }
    double const wide = std::fabs(x);
    double const tall = std::fabs(y);
    double const longer = wide < tall ? tall : wide;
    double const shorter = wide < tall ? wide : tall;
    DoubleDouble angle = {0.0, 0.0};
    if (shorter == infinity) {
        angle = atan_of(1.0);
    } else if (longer > 0.0) {
        angle = atan_of(shorter / longer);
    }
    if (wide < tall) {
        angle = DoubleDouble{half_pi_hi, half_pi_lo} + DoubleDouble{-angle.hi, -angle.lo};
    }
    if (std::signbit(x)) {
        angle = DoubleDouble{2.0 * half_pi_hi, 2.0 * half_pi_lo} + DoubleDouble{-angle.hi, -angle.lo};
    }
    return std::copysign(angle.hi + angle.lo, y);
}

} // namespace thalweg::portable
