// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <bit>
#include <vector>

#include <thalweg/network/vectorise/vectorise.hpp>

namespace thalweg::network {

namespace {

using Word = std::uint64_t;

/// A range of words in a row; empty if first > last.
struct Span {
    std::int64_t first = 1;
    std::int64_t last = 0;
    bool empty() const { return first > last; }
    void cover(std::int64_t from, std::int64_t to) {
        first = empty() ? from : std::min(first, from);
        last = std::max(last, to);
    }
};

/// Rows of bits, 64 cells per word, the westernmost in the lowest bit; framed by empty rows and words.
class BitRows {
public:
    BitRows(std::int64_t width, std::int64_t height)
        : words_((width + 63) / 64), bits_(static_cast<std::size_t>((words_ + 2) * (height + 2)), 0) {}

    std::int64_t words() const { return words_; }
    Word* row(std::int64_t y) { return bits_.data() + (y + 1) * (words_ + 2) + 1; }

private:
    std::int64_t words_;
    std::vector<Word> bits_;
};

/// One bit for each of eight cells, 1: not 0.
Word pack8(std::uint8_t const* p) {
    Word v = 0;
    for (unsigned k = 0; k < 8; ++k) {
        v |= static_cast<Word>(p[k]) << (8 * k);
    }
    Word const low7 = 0x7f7f7f7f7f7f7f7f;
    Word const set = ((((v & low7) + low7) | v) & ~low7) >> 7;
    return (set * 0x0102040810204080) >> 56;
}

void pack(Mask const& mask, BitRows& bits) {
    for (std::int64_t y = 0; y < mask.height(); ++y) {
        std::uint8_t const* const cells = mask.row(y).data();
        Word* const row = bits.row(y);
        std::int64_t x = 0;
        for (; x + 8 <= mask.width(); x += 8) {
            row[x / 64] |= pack8(cells + x) << (x % 64);
        }
        for (; x < mask.width(); ++x) {
            row[x / 64] |= static_cast<Word>(cells[x] != 0) << (x % 64);
        }
    }
}

Mask unpack(Grid const& grid, BitRows& bits) {
    Mask mask(grid);
    for (std::int64_t y = 0; y < grid.height; ++y) {
        std::uint8_t* const cells = mask.row(y).data();
        Word const* const row = bits.row(y);
        for (std::int64_t k = 0; k < bits.words(); ++k) {
            for (Word w = row[k]; w != 0; w &= w - 1) {
                cells[k * 64 + std::countr_zero(w)] = 1;
            }
        }
    }
    return mask;
}

/// The cells of a word that a subiteration deletes (Guo and Hall 1989, algorithm A1), neighbours named as there:
///     p9 p2 p3
///     p8 p1 p4
///     p7 p6 p5
template <int Subiteration>
Word deletable(Word p1, Word p2, Word p3, Word p4, Word p5, Word p6, Word p7, Word p8, Word p9) {
    Word const c1 = ~p2 & (p3 | p4);
    Word const c2 = ~p4 & (p5 | p6);
    Word const c3 = ~p6 & (p7 | p8);
    Word const c4 = ~p8 & (p9 | p2);
    Word const one_component = ((c1 ^ c2) & ~(c3 | c4)) | ((c3 ^ c4) & ~(c1 | c2));

    auto const at_least_two = [](Word a, Word b, Word c, Word d) { return (a & b) | (c & d) | ((a | b) & (c | d)); };
    Word const a1 = p9 | p2;
    Word const a2 = p3 | p4;
    Word const a3 = p5 | p6;
    Word const a4 = p7 | p8;
    Word const b1 = p2 | p3;
    Word const b2 = p4 | p5;
    Word const b3 = p6 | p7;
    Word const b4 = p8 | p9;
    Word const two_or_three =
        at_least_two(a1, a2, a3, a4) & at_least_two(b1, b2, b3, b4) & ~(a1 & a2 & a3 & a4 & b1 & b2 & b3 & b4);

    Word const keep = Subiteration == 0 ? (p2 | p3 | ~p5) & p4 : (p6 | p7 | ~p9) & p8;
    return p1 & one_component & two_or_three & ~keep;
}

template <int Subiteration> Word mark_row(Word const* up, Word const* mid, Word const* down, Word* marked, Span span) {
    Word any = 0;
    for (std::int64_t k = span.first; k <= span.last; ++k) {
        auto const west = [k](Word const* r) { return (r[k] << 1) | (r[k - 1] >> 63); };
        auto const east = [k](Word const* r) { return (r[k] >> 1) | (r[k + 1] << 63); };
        marked[k] = deletable<Subiteration>(mid[k], up[k], east(up), east(mid), east(down), down[k], west(down),
                                            west(mid), west(up));
        any |= marked[k];
    }
    return any;
}

/// What each subiteration must examine: per row the words around which something changed since that subiteration last
/// examined them. Row y is at y + 1.
using Live = std::array<std::vector<Span>, 2>;

template <int Subiteration> bool subiterate(BitRows& bits, BitRows& marks, Live& live, std::int64_t height) {
    std::vector<Span>& mine = live[Subiteration];
    std::vector<std::int64_t> changed;
    std::vector<Span> looked_at;
    for (std::int64_t y = 0; y < height; ++y) {
        Span& span = mine[y + 1];
        if (span.empty()) {
            continue;
        }
        if (mark_row<Subiteration>(bits.row(y - 1), bits.row(y), bits.row(y + 1), marks.row(y), span) != 0) {
            changed.push_back(y);
            looked_at.push_back(span);
        }
        span = {};
    }
    for (std::size_t i = 0; i < changed.size(); ++i) {
        std::int64_t const y = changed[i];
        Word* const row = bits.row(y);
        Word const* const marked = marks.row(y);
        Span hit;
        for (std::int64_t k = looked_at[i].first; k <= looked_at[i].last; ++k) {
            if (marked[k] != 0) {
                row[k] &= ~marked[k];
                hit.cover(k, k);
            }
        }
        std::int64_t const from = std::max<std::int64_t>(hit.first - 1, 0);
        std::int64_t const to = std::min(hit.last + 1, bits.words() - 1);
        for (std::vector<Span>& spans : live) {
            for (std::int64_t near = y; near <= y + 2; ++near) {
                spans[near].cover(from, to);
            }
        }
    }
    return !changed.empty();
}

} // namespace

Mask thin(Mask const& mask, Run const& run) {
    std::int64_t const height = mask.height();
    BitRows bits(mask.width(), height);
    BitRows marks(mask.width(), height);
    pack(mask, bits);
    Live live;
    live.fill(std::vector<Span>(height + 2, Span{0, bits.words() - 1}));
    for (bool changed = true; changed;) {
        run.check();
        changed = subiterate<0>(bits, marks, live, height);
        changed = subiterate<1>(bits, marks, live, height) || changed;
    }
    return unpack(mask.grid(), bits);
}

} // namespace thalweg::network
