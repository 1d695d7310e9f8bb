// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/growth/tokunaga/grow_tokunaga.hpp>

#include <cmath>
#include <utility>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>

namespace thalweg::growth {

TokunagaLaws tokunaga_laws(int lambda) {
    require_in("growth.tokunaga_laws", "the generator", lambda, Range::between(1, 50));
    TokunagaLaws laws;
    laws.a = lambda - 1;
    laws.c = 0.5 * (1.0 + std::sqrt(1.0 + 4.0 * lambda));
    laws.share = laws.c / lambda;
    double const sum = 2.0 + laws.a + laws.c;
    laws.bifurcation = 0.5 * (sum + std::sqrt(sum * sum - 8.0 * laws.c));
    return laws;
}

double mean_side_branches(int lambda, SideRule rule, int order) {
    TokunagaLaws const laws = tokunaga_laws(lambda);
    if (rule == SideRule::plane) {
        return laws.c - 1.0;
    }
    if (rule == SideRule::constant) {
        return laws.share * laws.a;
    }
    double links = lambda; // of a stream of order t + 1
    double branches = laws.a * laws.c;
    for (int t = 1; t < order - 1; ++t) {
        links += branches;
        branches *= laws.c;
    }
    return branches / links;
}

namespace {

constexpr std::uint64_t tokunaga_stage = 0x746f6b756e616761; // "tokunaga"

void check(TokunagaParams const& params) {
    require_in("growth.grow_tokunaga", "generator", params.generator, Range::between(1, 50));
    require_in("growth.grow_tokunaga", "order", params.order, Range::between(1, 30));
    require_in("growth.grow_tokunaga", "max_links", params.max_links, Range::at_least(1));
}

/// One refinement of a tree.
class Refinement {
public:
    Refinement(TokunagaParams const& params, int step) : params_(params), step_(step) {
        for (int order = 2; order <= params.order; ++order) {
            means_.push_back(mean_side_branches(params.generator, params.rule, order));
        }
    }

    std::vector<TreeLink> refine(std::vector<TreeLink> const& coarse) {
        links_.clear();
        tops_.assign(coarse.size(), -1);
        for (std::size_t i = 0; i < coarse.size(); ++i) {
            words_ = random_block(params_.seed, tokunaga_stage, static_cast<std::uint64_t>(step_), i);
            TreeLink const& old = coarse[i];
            LinkId const below = old.down < 0 ? -1 : tops_[old.down];
            bool const source = old.up[0] < 0;
            int const sides = source ? params_.generator - 1 : side_branches(old.order);
            LinkId top = add(below, old.order + 1, old.turn);
            for (int k = 0; k < sides; ++k) {
                LinkId const next = add(top, old.order + 1, 0);
                add(top, 1, bank(source, k, sides));
                top = next;
            }
            if (source) {
                int const first = turned(fork_bit) ? 1 : -1;
                add(top, 1, first);
                add(top, 1, -first);
            }
            tops_[i] = top;
            refuse_if<BadParameter>(
                std::ssize(links_) > params_.max_links, "growth.grow_tokunaga",
                "order {} with generator {} has more than {} links; lower the order or the generator", params_.order,
                params_.generator, params_.max_links);
        }
        return std::move(links_);
    }

private:
    static constexpr int fork_bit = 63;

    LinkId add(LinkId down, int order, int turn) {
        LinkId const link = std::ssize(links_);
        links_.push_back({.down = down, .up = {{-1, -1}}, .order = order, .turn = turn});
        if (down >= 0) {
            auto& up = links_[down].up;
            up[up[0] < 0 ? 0 : 1] = link;
        }
        return link;
    }

    int side_branches(int order) const {
        double const mean = means_[order - 2];
        double const whole = std::floor(mean);
        return static_cast<int>(whole) + (unit(words_[0]) < mean - whole ? 1 : 0);
    }

    bool turned(int bit) const {
        return params_.banks == BankRule::random && (words_[1] >> static_cast<unsigned>(bit) & 1) != 0;
    }

    /// The rules of the L-system in \cite nenu2015: G[--G] alone, otherwise from the left; F[++G] alone, F[--G]F[++G].
    int bank(bool source, int k, int sides) const {
        int const first = source == (sides == 1) || (!source && sides % 2 == 0) ? -2 : 2;
        int const side = k % 2 == 0 ? first : -first;
        return turned(k) ? -side : side;
    }

    TokunagaParams const& params_;
    int step_;
    std::vector<double> means_; ///< by order - 2
    std::array<std::uint64_t, 4> words_{};
    std::vector<TreeLink> links_;
    std::vector<LinkId> tops_; ///< by old link: the uppermost of the links that replaced it
};

} // namespace

TokunagaTree grow_tokunaga(TokunagaParams const& params, Run const& run) {
    check(params);
    TokunagaTree tree;
    tree.links.resize(1);
    double const c = tokunaga_laws(params.generator).c;
    for (int step = 1; step < params.order; ++step) {
        run.check();
        tree.links = Refinement(params, step).refine(tree.links);
        tree.link_length = step == 1 ? 1.0 : tree.link_length / c;
    }
    return tree;
}

} // namespace thalweg::growth
