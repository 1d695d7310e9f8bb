// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/sums.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/solver/spectral/fft.hpp>
#include <thalweg/solver/statistics/field_statistics.hpp>

namespace thalweg::solver {
namespace {

using PairLine = std::vector<Complex>;
using PairLines = std::vector<PairLine>;

// Two real lines form one complex line; this many pairs read at once fill a cache line with each row's part.
constexpr std::int64_t lines_at_once = 16;
// Number of blocks in which bundles are summed, in this order for any number of threads.
constexpr std::int64_t most_blocks = 64;
// Fewer weights than this are cheaper to add one by one.
constexpr std::size_t few_weights = 16;

/// A DEM as lines along an axis.
struct LinesOfDem {
    Raster<float> const& dem;
    double datum;
    Axis axis;

    std::int64_t count() const { return axis == Axis::rows ? dem.height() : dem.width(); }
    std::int64_t length() const { return axis == Axis::rows ? dem.width() : dem.height(); }
    std::int64_t index(std::int64_t line, std::int64_t i) const {
        return axis == Axis::rows ? line * dem.width() + i : i * dem.width() + line;
    }

    /// Heights minus the datum (0: no data) of the lines from `first`, in pairs as real and imaginary parts.
    void heights(std::int64_t first, PairLines& pairs) const {
        read(first, pairs, [&](float z) { return std::isnan(z) ? 0.0 : z - datum; });
    }
    /// 1: the cell has a height, 0: no data.
    void presence(std::int64_t first, PairLines& pairs) const {
        read(first, pairs, [](float z) { return std::isnan(z) ? 0.0 : 1.0; });
    }
    template <class Value> void read(std::int64_t first, PairLines& pairs, Value const& value) const {
        for (PairLine& pair : pairs) {
            std::fill(pair.begin(), pair.end(), Complex{});
        }
        std::int64_t const beyond = std::min(first + lines_at_once, count());
        auto const take = [&](std::int64_t line, std::int64_t i) {
            Complex& number = pairs[(line - first) / 2][i];
            double const v = value(dem[index(line, i)]);
            number = (line - first) % 2 == 0 ? Complex{v, number.imag()} : Complex{number.real(), v};
        };
        if (axis == Axis::rows) {
            for (std::int64_t line = first; line < beyond; ++line) {
                for (std::int64_t i = 0; i < length(); ++i) {
                    take(line, i);
                }
            }
        } else {
            for (std::int64_t i = 0; i < length(); ++i) {
                for (std::int64_t line = first; line < beyond; ++line) {
                    take(line, i);
                }
            }
        }
    }
};

PairLines empty_pairs(std::int64_t length) {
    PairLines pairs(lines_at_once / 2, PairLine(length));
    return pairs;
}

struct Power {
    std::vector<double> values;
    Power& operator+=(Power const& other) {
        values.resize(other.values.size(), 0.0);
        for (std::size_t i = 0; i < values.size(); ++i) {
            values[i] += other.values[i];
        }
        return *this;
    }
};

/// Sums products at the lags [0, lags] of the values that read(first, pairs) returns: adds up squared spectra and
/// transforms back once. Of a + ib the real part contains the products of a with a and of b with b.
template <class Read>
std::vector<double> lagged(LinesOfDem const& lines, std::int64_t lags, Run const& run, Read const& read) {
    std::int64_t const size = good_size(lines.length() + lags);
    LineTransform const prepared(size, Direction::forward);
    std::int64_t const bundles = (lines.count() + lines_at_once - 1) / lines_at_once;
    std::int64_t const blocks = std::min(bundles, most_blocks);
    Power const power = sum_rows(run, blocks, [&](std::int64_t block) {
        LineTransform transform = prepared;
        PairLines pairs = empty_pairs(size);
        PairLine spectrum(size);
        Power part{std::vector<double>(spectrum.size(), 0.0)};
        for (std::int64_t b = block; b < bundles; b += blocks) {
            run.check();
            read(b * lines_at_once, pairs);
            for (PairLine const& pair : pairs) {
                transform(pair.data(), spectrum.data());
                for (std::size_t i = 0; i < spectrum.size(); ++i) {
                    part.values[i] += std::norm(spectrum[i]);
                }
            }
        }
        return part;
    });
    PairLine spectrum(power.values.begin(), power.values.end());
    PairLine sums(spectrum.size());
    LineTransform(size, Direction::inverse)(spectrum.data(), sums.data());
    std::vector<double> result(static_cast<std::size_t>(lags + 1));
    for (std::size_t k = 0; k < result.size(); ++k) {
        result[k] = sums[k].real() / static_cast<double>(size);
    }
    return result;
}

void weigh_few(LinesOfDem const& lines, std::vector<double> const& weights, Raster<double>& sums, Run const& run) {
    std::int64_t const step = lines.axis == Axis::rows ? 1 : lines.dem.width();
    std::int64_t const width = lines.dem.width();
    parallel_ranges(run, lines.dem.height(), 8, [&](std::int64_t begin, std::int64_t end) {
        run.check();
        for (std::int64_t i = begin * width; i < end * width; ++i) {
            std::int64_t const place = lines.axis == Axis::rows ? i % width : i / width;
            auto const add = [&](std::int64_t k, double weight) {
                for (std::int64_t const there : {place - k, place + k}) {
                    if (there >= 0 && there < lines.length()) {
                        float const z = lines.dem[i + (there - place) * step];
                        sums[i] += std::isnan(z) ? 0.0 : weight * (z - lines.datum);
                    }
                }
            };
            for (std::size_t k = 0; k < weights.size() && !std::isnan(lines.dem[i]); ++k) {
                if (weights[k] != 0.0) {
                    add(static_cast<std::int64_t>(k) + 1, weights[k]);
                }
            }
        }
    });
}

void weigh_many(LinesOfDem const& lines, std::vector<double> const& weights, Raster<double>& sums, Run const& run) {
    std::int64_t const size = good_size(lines.length() + static_cast<std::int64_t>(weights.size()));
    LineTransform const there(size, Direction::forward);
    LineTransform const back(size, Direction::inverse);
    PairLine kernel(size);
    for (std::size_t k = 1; k <= weights.size(); ++k) {
        kernel[k] += weights[k - 1];
        kernel[kernel.size() - k] += weights[k - 1];
    }
    PairLine spectrum(kernel.size());
    LineTransform(size, Direction::forward)(kernel.data(), spectrum.data());
    std::int64_t const bundles = (lines.count() + lines_at_once - 1) / lines_at_once;
    parallel_ranges(run, bundles, 1, [&](std::int64_t begin, std::int64_t end) {
        LineTransform forward = there;
        LineTransform inverse = back;
        PairLines pairs = empty_pairs(size);
        PairLine line(size);
        for (std::int64_t b = begin; b < end; ++b) {
            run.check();
            std::int64_t const first = b * lines_at_once;
            lines.heights(first, pairs);
            for (PairLine& pair : pairs) {
                forward(pair.data(), line.data());
                for (std::size_t i = 0; i < line.size(); ++i) {
                    line[i] *= spectrum[i].real() / static_cast<double>(size); // even weights: a real spectrum
                }
                inverse(line.data(), pair.data());
            }
            std::int64_t const beyond = std::min(first + lines_at_once, lines.count());
            for (std::int64_t i = 0; i < lines.length(); ++i) {
                for (std::int64_t l = first; l < beyond; ++l) {
                    Complex const& number = pairs[(l - first) / 2][i];
                    std::int64_t const cell = lines.index(l, i);
                    sums[cell] = std::isnan(lines.dem[cell]) ? 0.0
                                 : (l - first) % 2 == 0      ? number.real()
                                                             : number.imag();
                }
            }
        }
    });
}

double one_over_e() {
    return portable::exp(-1.0);
}

/// Index of the first r at or below 1/e.
std::optional<std::size_t> crossing(std::vector<double> const& r) {
    for (std::size_t i = 0; i < r.size(); ++i) {
        if (r[i] <= one_over_e()) {
            return i;
        }
    }
    return std::nullopt;
}

/// The least-squares line through u = ln(-ln r) over x = ln k, for lags with 0 < r < 1.
struct Fit {
    double lags = 0.0;
    double mean_x = 0.0;
    double mean_u = 0.0;
    double spread = 0.0; ///< sum of (x - mean_x)^2
    double alpha = 0.0;

    explicit Fit(std::vector<double> const& r) {
        for_lags(r, [&](std::size_t, double x, double u) {
            lags += 1.0;
            mean_x += x;
            mean_u += u;
        });
        mean_x /= lags;
        mean_u /= lags;
        for_lags(r, [&](std::size_t, double x, double u) {
            spread += (x - mean_x) * (x - mean_x);
            alpha += (x - mean_x) * (u - mean_u);
        });
        alpha /= spread;
    }
    /// A single lag determines no line, and correlation that does not decrease has no length.
    bool holds() const { return lags > 1.0 && alpha > 0.0; }

    template <class Body> static void for_lags(std::vector<double> const& r, Body const& body) {
        for (std::size_t i = 0; i < r.size(); ++i) {
            if (r[i] > 0.0 && r[i] < 1.0) {
                body(i, portable::log(static_cast<double>(i + 1)), portable::log(-portable::log(r[i])));
            }
        }
    }
};

} // namespace

LagSums lag_sums(Raster<float> const& dem, double datum, Axis axis, std::int64_t lags, Run const& run) {
    LinesOfDem const lines{dem, datum, axis};
    LagSums sums;
    sums.products =
        lagged(lines, lags, run, [&](std::int64_t first, PairLines& pairs) { lines.heights(first, pairs); });
    auto const values = dem.values();
    bool const holes = std::any_of(values.begin(), values.end(), [](float z) { return std::isnan(z); });
    if (holes) {
        sums.pairs =
            lagged(lines, lags, run, [&](std::int64_t first, PairLines& pairs) { lines.presence(first, pairs); });
        for (double& count : sums.pairs) {
            count = std::floor(count + 0.5);
        }
    } else {
        for (std::int64_t k = 0; k <= lags; ++k) {
            sums.pairs.push_back(static_cast<double>((lines.length() - k) * lines.count()));
        }
    }
    return sums;
}

Raster<double> weigh_lags(Raster<float> const& dem, double datum, Axis axis, std::vector<double> const& weights,
                          Run const& run) {
    LinesOfDem const lines{dem, datum, axis};
    Raster<double> sums(dem.grid());
    auto const zeros = static_cast<std::size_t>(std::count(weights.begin(), weights.end(), 0.0));
    if (weights.size() - zeros <= few_weights) {
        weigh_few(lines, weights, sums, run);
    } else {
        weigh_many(lines, weights, sums, run);
    }
    return sums;
}

Correlogram correlogram(Raster<float> const& dem, double mean, double std, Axis axis, Run const& run) {
    Correlogram result;
    if (!(std > 0.0)) {
        return result;
    }
    std::int64_t const lags = (axis == Axis::rows ? dem.width() : dem.height()) / 2;
    LagSums const sums = lag_sums(dem, mean, axis, lags, run);
    for (std::size_t k = 1; k < sums.pairs.size(); ++k) {
        result.pairs.push_back(sums.pairs[k]);
        result.r.push_back(sums.pairs[k] > 0.0 ? sums.products[k] / sums.pairs[k] / (std * std)
                                               : std::numeric_limits<double>::quiet_NaN());
    }
    return result;
}

CorrelationLength correlation_length(Correlogram const& correlogram) {
    std::vector<double> const& r = correlogram.r;
    if (auto const i = crossing(r)) {
        double const before = *i > 0 ? r[*i - 1] : 1.0;
        return {static_cast<double>(*i) + (before - one_over_e()) / (before - r[*i]), false};
    }
    Fit const fit(r);
    return fit.holds() ? CorrelationLength{portable::exp(fit.mean_x - fit.mean_u / fit.alpha), true}
                       : CorrelationLength{};
}

std::vector<double> correlation_length_slopes(Correlogram const& correlogram) {
    std::vector<double> const& r = correlogram.r;
    std::vector<double> slopes(r.size(), 0.0);
    if (auto const i = crossing(r)) {
        double const cells = correlation_length(correlogram).cells;
        double const before = *i > 0 ? r[*i - 1] : 1.0;
        double const fall = before - r[*i];
        slopes[*i] = (before - one_over_e()) / (fall * fall) / cells;
        if (*i > 0) {
            slopes[*i - 1] = (one_over_e() - r[*i]) / (fall * fall) / cells;
        }
        return slopes;
    }
    Fit const fit(r);
    if (!fit.holds()) {
        return {};
    }
    Fit::for_lags(r, [&](std::size_t i, double x, double) {
        double const by_u =
            fit.mean_u / (fit.alpha * fit.alpha) * (x - fit.mean_x) / fit.spread - 1.0 / (fit.lags * fit.alpha);
        slopes[i] = by_u / (r[i] * portable::log(r[i]));
    });
    return slopes;
}

} // namespace thalweg::solver
