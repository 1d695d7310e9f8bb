// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/numbers/random.hpp>

#include <Random123/philox.h>

namespace thalweg {

namespace {

std::array<std::uint64_t, 4> philox(std::uint64_t seed, std::uint64_t stage, std::uint64_t a, std::uint64_t b,
                                    std::uint64_t c, std::uint64_t d) {
    r123::Philox4x64::ctr_type const counter = {{a, b, c, d}};
    r123::Philox4x64::key_type const key = {{seed, stage}};
    auto const out = r123::Philox4x64{}(counter, key);
    return {out[0], out[1], out[2], out[3]};
}

} // namespace

std::array<std::uint64_t, 4> random_block(std::uint64_t seed, std::uint64_t a, std::uint64_t b, std::uint64_t c,
                                          std::uint64_t d) {
    return philox(seed, 0, a, b, c, d);
}

void RandomStream::refill() {
    for (std::size_t i = 0; i < words_.size(); i += 4) {
        auto const four = philox(seed_, ~stage_, item_, block_++, 0, 0);
        for (std::size_t k = 0; k < 4; ++k) {
            words_[i + k] = four[k];
        }
    }
    next_ = 0;
}

} // namespace thalweg
