// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/growth/tokunaga/internal/spread_forest.hpp>

#include <array>
#include <cmath>
#include <limits>

#include <thalweg/core/numbers/chance.hpp>
#include <thalweg/geometry/point_grid.hpp>

namespace thalweg::network {

namespace {

constexpr std::uint64_t spread_stage = 0x737072656164; // "spread"
constexpr std::size_t no_link = std::numeric_limits<std::size_t>::max();
constexpr double sharpest_fork = 0.9396926; // cosine of 20 degrees

Vec2 unit_of(Vec2 a) {
    double const length = norm(a);
    return length > 0.0 ? Vec2{a.x / length, a.y / length} : Vec2{0.0, 1.0};
}
/// Turned to the left by the angle of this cosine and sine.
Vec2 turned(Vec2 a, double cosine, double sine) {
    return {cosine * a.x - sine * a.y, sine * a.x + cosine * a.y};
}

class Spread {
public:
    explicit Spread(Forest const& forest)
        : forest_(forest), links_(forest.links.size()), at_(links_ + forest.shares.size()),
          up_(links_ + forest.shares.size()), below_(links_, no_link), active_(links_, 0), wide_(links_, 1.0) {
        for (std::size_t t = 0; t < forest.shares.size(); ++t) {
            at_[links_ + t] = forest.shares[t].mouth;
        }
        for (std::size_t i = 0; i < links_; ++i) {
            highest_ = std::max(highest_, forest.links[i].order);
            if (forest.links[i].pinned) {
                at_[i] = *forest.links[i].pinned;
            }
        }
    }

    std::vector<Vec2> spread(Run const& run) {
        for (int order = highest_; order >= 1; --order) {
            enter(order);
            int const sweeps = order == 1 ? 40 : 60;
            for (int sweep = 0; sweep < sweeps; ++sweep) {
                run.check();
                relax(order, sweep, sweeps);
            }
        }
        at_.resize(links_);
        return std::move(at_);
    }

private:
    bool pinned(std::size_t node) const { return node >= links_ || forest_.links[node].pinned.has_value(); }
    Vec2 below_at(std::size_t i) const { return at_[below_[i]]; }
    Segment segment(std::size_t i) const { return {at_[below_[i]], at_[i]}; }

    std::size_t node_below(std::size_t i) const {
        std::int64_t const down = forest_.links[i].down;
        return down < 0 ? links_ + forest_.links[i].tree : static_cast<std::size_t>(down);
    }

    /// Makes the nodes of an order's streams and those they enter take part.
    void enter(int order) {
        std::vector<std::uint8_t> const before = active_;
        std::vector<std::uint8_t> runs(links_, 0); // the link is part of a stream that is there
        std::vector<int> arrivals(links_ + forest_.shares.size(), 0);
        for (std::size_t i = 0; i < links_; ++i) {
            if (forest_.links[i].order >= order || pinned(i)) {
                runs[i] = 1;
                ++arrivals[node_below(i)];
            }
        }
        std::vector<std::size_t> count(forest_.shares.size(), 0);
        for (auto& up : up_) {
            up.clear();
        }
        for (std::size_t i = 0; i < links_; ++i) {
            active_[i] = runs[i] != 0 && (pinned(i) || arrivals[i] != 1) ? 1 : 0;
            std::size_t const node = node_below(i);
            below_[i] = node >= links_ || active_[node] != 0 ? node : below_[node];
            if (active_[i] != 0) {
                up_[below_[i]].push_back(i);
                ++count[forest_.links[i].tree];
            }
        }
        low_ = high_ = at_[links_];
        for (std::size_t t = 0; t < count.size(); ++t) {
            ForestShare const& share = forest_.shares[t];
            double const h = std::sqrt(share.area_m2 / static_cast<double>(std::max<std::size_t>(count[t], 1)));
            spacing_.resize(count.size());
            spacing_[t] = h;
        }
        samples_.assign(count.size(), {});
        double cell = std::numeric_limits<double>::infinity();
        for (std::size_t t = 0; t < count.size(); ++t) {
            samples_[t] = forest_.shares[t].sample(spacing_[t] / 3.0);
            cell = std::min(cell, spacing_[t]);
            for (Vec2 const p : samples_[t]) {
                low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y)};
                high_ = {std::max(high_.x, p.x), std::max(high_.y, p.y)};
            }
        }
        for (std::size_t i = 0; i < links_; ++i) {
            wide_[i] = spacing_[forest_.links[i].tree];
        }
        divide(before);
        grid_.emplace(low_, high_, cell, links_ + forest_.walls.size());
        for (std::size_t k = 0; k < forest_.walls.size(); ++k) {
            grid_->add(links_ + k, forest_.walls[k]);
        }
        for (std::size_t i = 0; i < links_; ++i) {
            if (active_[i] != 0 && (before[i] != 0 || is_between(i, before))) {
                grid_->add(i, segment(i));
            }
        }
        for (std::size_t i = 0; i < links_; ++i) {
            if (active_[i] != 0 && !grid_->holds(i)) {
                sprout(i);
            }
        }
    }

    /// Whether the new node lies on a stream that was there before.
    bool is_between(std::size_t i, std::vector<std::uint8_t> const& before) const {
        return divided_[i] != 0 || before[i] != 0 || pinned(i);
    }

    /// Sets the new nodes of old streams at equal distances.
    void divide(std::vector<std::uint8_t> const& before) {
        divided_.assign(links_, 0);
        std::vector<std::size_t> chain;
        for (std::size_t i = 0; i < links_; ++i) {
            if (before[i] == 0) {
                continue;
            }
            chain.clear();
            std::size_t node = below_[i];
            while (node < links_ && before[node] == 0) {
                chain.push_back(node);
                node = below_[node];
            }
            for (std::size_t k = 0; k < chain.size(); ++k) {
                double const share = static_cast<double>(k + 1) / static_cast<double>(chain.size() + 1);
                if (!pinned(chain[k])) {
                    at_[chain[k]] = at_[i] + share * (at_[node] - at_[i]);
                    divided_[chain[k]] = 1;
                }
            }
        }
    }

    /// The direction of the stream in a node, upstream, without link i.
    Vec2 course(std::size_t node, std::size_t without) const {
        Vec2 sum{};
        if (node < links_) {
            sum = unit_of(at_[node] - below_at(node));
        } else {
            sum = unit_of(forest_.shares[node - links_].far - at_[node]);
        }
        for (std::size_t const u : up_[node]) {
            if (u != without && grid_->holds(u) && forest_.links[u].turn == 0) {
                sum = sum + unit_of(at_[u] - at_[node]);
            }
        }
        return unit_of(sum);
    }

    /// Finds a first place for a new stream's source.
    void sprout(std::size_t i) {
        std::size_t const node = below_[i];
        ForestLink const& link = forest_.links[first_link(i)];
        Vec2 const ahead = course(node, i);
        if (node >= links_) {
            at_[i] = forest_.shares[node - links_].far;
            grid_->add(i, segment(i));
            return;
        }
        struct Heading {
            double cosine;
            double sine;
        };
        static constexpr std::array<Heading, 7> headings = {{{0.6428, 0.7660},
                                                             {0.8192, 0.5736},
                                                             {0.4226, 0.9063},
                                                             {0.1736, 0.9848},
                                                             {0.9397, 0.3420},
                                                             {-0.1736, 0.9848},
                                                             {-0.5, 0.8660}}};
        bool const fork = link.turn == 1 || link.turn == -1;
        std::array<double, 2> const sides = link.turn > 0 ? std::array{1.0, -1.0} : std::array{-1.0, 1.0};
        double length = 0.75 * wide_[i];
        for (int attempt = 0; attempt < 24; ++attempt, length *= 0.7) {
            for (double const side : sides) {
                for (std::size_t k = 0; k < headings.size(); ++k) {
                    Heading const h = headings[fork && k < 2 ? 1 - k : k];
                    Vec2 const to = at_[node] + length * turned(ahead, h.cosine, side * h.sine);
                    if (fits(i, to, false)) {
                        at_[i] = to;
                        grid_->add(i, segment(i));
                        return;
                    }
                }
            }
        }
        at_[i] = at_[node] + length * ahead;
        grid_->add(i, segment(i));
    }

    std::size_t first_link(std::size_t i) const {
        std::size_t link = i;
        while (node_below(link) != below_[i]) {
            link = node_below(link);
        }
        return link;
    }

    double needed(double length, double other, std::size_t i) const {
        return std::max(1.1 * forest_.clearance * std::min({length, other, wide_[i]}),
                        std::min(1.05 * forest_.min_spacing_m, 0.5 * wide_[i]));
    }

    /// Whether a link from a to b, in the place of the link i or a new one, keeps clear of what is no neighbour.
    bool clear(std::size_t i, Segment const& moved, std::size_t node, bool exists) const {
        double const length = distance(moved.a, moved.b);
        double const wide = wide_[i];
        if (length < 0.4 * wide && exists) {
            Segment const old = segment(i);
            if (length < distance(old.a, old.b)) {
                return false;
            }
        }
        double const margin = std::max(1.1 * forest_.clearance * std::min(length, wide),
                                       std::min(1.05 * forest_.min_spacing_m, 0.5 * wide));
        std::size_t const lower = below_[i];
        bool const at_mouth = lower >= links_;
        return grid_->near(moved, margin, [&](std::size_t other) {
            if (other == i) {
                return true;
            }
            Segment const& t = (*grid_)[other];
            if (other >= links_) {
                if (at_mouth && squared_distance(at_[lower], t) < 1e-18 * wide * wide) {
                    return squared_distance(moved.b, t) > 0.01 * margin * margin && forest_.inside(moved.b);
                }
            } else if (other == lower || below_[other] == lower || below_[other] == i || other == node ||
                       below_[other] == node) {
                return true; // neighbours: their angle counts
            }
            double const squared = squared_distance(moved, t);
            double const need = other >= links_ ? margin : needed(length, distance(t.a, t.b), i);
            if (squared >= need * need) {
                return true;
            }
            return exists && squared > 0.0 && squared >= squared_distance(segment(i), t);
        });
    }

    /// Whether two links that leave one place stand apart, or no less than before.
    static bool apart(Vec2 a, Vec2 b, Vec2 old_a, Vec2 old_b, bool exists) {
        double const cosine = dot(a, b);
        double const limit = sharpest_fork * norm(a) * norm(b);
        if (cosine < limit) {
            return true;
        }
        return exists && cosine * norm(old_a) * norm(old_b) <= dot(old_a, old_b) * norm(a) * norm(b);
    }

    /// Whether the angles in a node are wide enough when node `mover` lies at `to`.
    bool angles_fit(std::size_t node, std::size_t mover, Vec2 to, bool exists) const {
        std::array<std::size_t, 8> ends{};
        std::size_t count = 0;
        if (node < links_) {
            ends[count++] = below_[node];
        }
        for (std::size_t const u : up_[node]) {
            if ((grid_->holds(u) || u == mover) && count < ends.size()) {
                ends[count++] = u;
            }
        }
        Vec2 const here = node == mover ? to : at_[node];
        for (std::size_t k = 0; k < count; ++k) {
            for (std::size_t m = k + 1; m < count; ++m) {
                Vec2 const a = (ends[k] == mover ? to : at_[ends[k]]) - here;
                Vec2 const b = (ends[m] == mover ? to : at_[ends[m]]) - here;
                if (!apart(a, b, at_[ends[k]] - at_[node], at_[ends[m]] - at_[node], exists)) {
                    return false;
                }
            }
        }
        return true;
    }

    /// Whether node i may lie there.
    bool fits(std::size_t i, Vec2 to, bool exists) const {
        if (!angles_fit(below_[i], i, to, exists) || !angles_fit(i, i, to, exists)) {
            return false;
        }
        for (std::size_t const u : up_[i]) {
            if (grid_->holds(u) && !angles_fit(u, i, to, exists)) {
                return false;
            }
        }
        if (!clear(i, {below_at(i), to}, i, exists)) {
            return false;
        }
        for (std::size_t const u : up_[i]) {
            if (grid_->holds(u) && !clear(u, {to, at_[u]}, i, exists)) {
                return false;
            }
        }
        return true;
    }

    void move(std::size_t i, Vec2 to) {
        grid_->remove(i);
        for (std::size_t const u : up_[i]) {
            grid_->remove(u);
        }
        at_[i] = to;
        grid_->add(i, segment(i));
        for (std::size_t const u : up_[i]) {
            grid_->add(u, segment(u));
        }
    }

    /// The link that continues the stream above a node; none above a source or a fork.
    std::size_t straight(std::size_t node) const {
        for (std::size_t const u : up_[node]) {
            if (up_[node].size() == 1 || forest_.links[first_link(u)].turn == 0) {
                return u;
            }
        }
        return no_link;
    }

    void relax(int order, int sweep, int sweeps) {
        pull_.assign(links_, {});
        for (std::size_t t = 0; t < forest_.shares.size(); ++t) {
            pull_to_centres(t);
        }
        bool const early = 3 * sweep < sweeps;
        for (std::size_t i = 0; i < links_; ++i) {
            if (active_[i] == 0 || pinned(i)) {
                continue;
            }
            double const wide = wide_[i];
            Vec2 step = pull_[i];
            std::size_t const next = straight(i);
            if (next != no_link) {
                Vec2 const middle = 0.5 * (at_[next] + below_at(i));
                step = step + 0.25 * (middle - at_[i]);
            }
            step = step + guide(i);
            if (early) {
                auto const words = chance_block(forest_.seed, spread_stage, static_cast<std::uint64_t>(order) << 32 | i,
                                                static_cast<std::uint64_t>(sweep));
                double const shake = 0.12 * wide;
                step = step + Vec2{shake * (2.0 * thalweg::unit(words[0]) - 1.0),
                                   shake * (2.0 * thalweg::unit(words[1]) - 1.0)};
            }
            double const length = norm(step);
            if (length > 0.3 * wide) {
                step = (0.3 * wide / length) * step;
            }
            for (int attempt = 0; attempt < 3; ++attempt) {
                if (fits(i, at_[i] + step, true)) {
                    move(i, at_[i] + step);
                    break;
                }
                step = 0.4 * step;
            }
        }
    }

    /// Side branches and forks shall point upstream.
    Vec2 guide(std::size_t i) const {
        Vec2 sum{};
        double const wide = wide_[i];
        std::size_t const node = below_[i];
        if (node < links_ && straight(node) != i) {
            Vec2 const ahead = course_of(node);
            double const cosine = dot(unit_of(at_[i] - at_[node]), ahead);
            if (cosine < 0.6) {
                sum = sum + (0.25 * wide * (0.6 - cosine)) * ahead;
            }
        }
        if (up_[i].size() > 1) {
            Vec2 const ahead = course_of(i);
            std::size_t const main = straight(i);
            for (std::size_t const u : up_[i]) {
                double const cosine = dot(unit_of(at_[u] - at_[i]), ahead);
                if (u != main && cosine < 0.6) {
                    sum = sum - (0.15 * wide * (0.6 - cosine)) * ahead;
                }
            }
        }
        return sum;
    }

    Vec2 course_of(std::size_t node) const {
        Vec2 const below = unit_of(at_[node] - below_at(node));
        std::size_t const main = straight(node);
        return main == no_link ? below : unit_of(below + unit_of(at_[main] - at_[node]));
    }

    /// Adds to the pull on each node what its own places and those of its links ask for.
    void pull_to_centres(std::size_t tree) {
        sites_.clear();
        owners_.clear();
        for (std::size_t i = 0; i < links_; ++i) {
            if (active_[i] != 0 && forest_.links[i].tree == tree) {
                owners_.push_back(i);
                sites_.push_back(at_[i]);
                sites_.push_back(0.5 * (at_[i] + below_at(i)));
            }
        }
        if (sites_.empty() || samples_[tree].empty()) {
            return;
        }
        geometry::PointGrid const grid(sites_, 0.7 * spacing_[tree]);
        std::vector<Vec2> sum(sites_.size());
        std::vector<double> count(sites_.size(), 0.0);
        for (Vec2 const p : samples_[tree]) {
            std::size_t const s = grid.nearest(p);
            sum[s] = sum[s] + p;
            count[s] += 1.0;
        }
        std::vector<Vec2> off(sites_.size());
        for (std::size_t s = 0; s < sites_.size(); ++s) {
            if (count[s] > 0.0) {
                off[s] = (1.0 / count[s]) * sum[s] - sites_[s];
            }
        }
        std::vector<double>& weight = weight_;
        weight.assign(links_, 0.0);
        for (std::size_t k = 0; k < owners_.size(); ++k) {
            std::size_t const i = owners_[k];
            pull_[i] = pull_[i] + off[2 * k] + 0.6 * off[2 * k + 1];
            weight[i] += 1.6;
            std::size_t const lower = below_[i];
            if (lower < links_) {
                pull_[lower] = pull_[lower] + 0.6 * off[2 * k + 1];
                weight[lower] += 0.6;
            }
        }
        for (std::size_t const i : owners_) {
            pull_[i] = (1.5 / weight[i]) * pull_[i];
        }
    }

    Forest const& forest_;
    std::size_t links_;
    std::vector<Vec2> at_; ///< by node: the links' upper ends, then the mouths
    std::vector<std::vector<std::size_t>> up_;
    std::vector<std::size_t> below_;
    std::vector<std::uint8_t> active_;
    std::vector<double> wide_; ///< [m] by link: mean distance of the places of its tree now
    std::vector<double> spacing_;
    std::vector<std::vector<Vec2>> samples_;
    std::vector<std::uint8_t> divided_;
    std::vector<Vec2> pull_;
    std::vector<double> weight_;
    std::vector<Vec2> sites_;
    std::vector<std::size_t> owners_;
    std::optional<SegmentGrid> grid_;
    Vec2 low_;
    Vec2 high_;
    int highest_ = 1;
};

} // namespace

std::vector<Vec2> spread_forest(Forest const& forest, Run const& run) {
    return Spread(forest).spread(run);
}

} // namespace thalweg::network
