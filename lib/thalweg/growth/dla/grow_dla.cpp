// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/growth/dla/grow_dla.hpp>

#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/growth/dla/internal/walk.hpp>

namespace thalweg::growth {
namespace {

constexpr std::uint8_t no_parent = 4;

/// Numbers the occupied cells row by row, to find a cell's particle: one bit per cell and one count per word.
class Register {
public:
    explicit Register(std::vector<Cell> const& cells) {
        Cell high = cells.front();
        low_ = cells.front();
        for (Cell const c : cells) {
            low_ = {std::min(low_.col, c.col), std::min(low_.row, c.row)};
            high = {std::max(high.col, c.col), std::max(high.row, c.row)};
        }
        width_ = high.col - low_.col + 1;
        std::int64_t const area = width_ * (high.row - low_.row + 1);
        words_.resize(static_cast<std::size_t>(area / 64 + 1));
        for (Cell const c : cells) {
            std::size_t const i = index(c);
            words_[i / 64].bits |= std::uint64_t{1} << i % 64;
        }
        std::int64_t count = 0;
        for (Word& word : words_) {
            word.before = count;
            count += std::popcount(word.bits);
        }
        particles_.resize(cells.size());
        for (std::size_t p = 0; p < cells.size(); ++p) {
            particles_[rank(cells[p])] = static_cast<std::int64_t>(p);
        }
    }

    std::int64_t particle(Cell c) const { return particles_[rank(c)]; }

private:
    struct Word {
        std::uint64_t bits = 0;
        std::int64_t before = 0;
    };

    std::size_t index(Cell c) const {
        return static_cast<std::size_t>((c.row - low_.row) * width_ + (c.col - low_.col));
    }
    std::size_t rank(Cell c) const {
        std::size_t const i = index(c);
        Word const& word = words_[i / 64];
        std::uint64_t const below = word.bits & ((std::uint64_t{1} << i % 64) - 1);
        return static_cast<std::size_t>(word.before + std::popcount(below));
    }

    Cell low_;
    std::int64_t width_ = 0;
    std::vector<Word> words_;
    std::vector<std::int64_t> particles_;
};

std::vector<std::int64_t> find_parents(std::vector<Cell> const& cells, std::vector<std::uint8_t> const& direction) {
    Register const reg(cells);
    std::vector<std::int64_t> parent(cells.size(), -1);
    for (std::size_t p = 1; p < cells.size(); ++p) {
        Site const offset = neighbour_offsets[direction[p]];
        parent[p] = reg.particle({cells[p].col + offset.x, cells[p].row + offset.y});
    }
    return parent;
}

/// Picks one of the set bits with equal probability.
std::uint8_t pick(unsigned mask, RandomStream& random) {
    int const count = std::popcount(mask);
    int skip = count == 1 ? 0 : static_cast<int>(random.real() * count);
    for (; skip > 0; --skip) {
        mask &= mask - 1;
    }
    return static_cast<std::uint8_t>(std::countr_zero(mask));
}

enum class Fate : std::uint8_t { sticks, walks_on, is_removed };

/// Decides about arrivals: noise-reduction counts and the stick test.
class Gate {
public:
    explicit Gate(DlaParams const& params)
        : rule_(params.rule), visits_(params.visits),
          holds_{0.0, params.sticking * params.sticking, params.sticking, 1.0} {}

    void reach(std::int32_t half) {
        if (visits_ > 1 && half > counts_.half()) {
            counts_.widen(half);
        }
    }

    Fate arrive(Walker& walker, unsigned mask) {
        double const hold = holds_[std::popcount(mask)];
        if (rule_ == VisitRule::stick_then_count) {
            return !stick(hold, walker) ? Fate::walks_on : count(walker.at) ? Fate::sticks : Fate::is_removed;
        }
        return !count(walker.at) ? Fate::is_removed : stick(hold, walker) ? Fate::sticks : Fate::walks_on;
    }

private:
    static bool stick(double hold, Walker& walker) { return hold >= 1.0 || walker.random.real() < hold; }

    /// Counts an arrival; returns whether the count is reached.
    bool count(Site site) {
        if (visits_ == 1) {
            return true;
        }
        std::uint8_t& seen = counts_[site];
        if (seen < visits_) {
            ++seen;
        }
        return seen >= visits_;
    }

    VisitRule rule_;
    int visits_;
    std::array<double, 4> holds_; ///< by the number of occupied neighbours
    TiledBytes counts_{TiledBytes::tile};
};

/// Grows all of a cluster but its parents.
/// \return by particle: the direction of its parent
std::vector<std::uint8_t> grow(DlaParams const& params, Cluster& cluster, Run const& run) {
    std::vector<std::uint8_t> direction;
    Walk walk;
    Gate gate(params);
    auto const add = [&](Site site, std::uint8_t parent) {
        walk.occupy(site);
        gate.reach(walk.half());
        cluster.cells.push_back({site.x, site.y});
        direction.push_back(parent);
    };
    auto const size = [&] { return static_cast<std::int64_t>(cluster.cells.size()); };
    auto const wide = [&] { return params.max_radius > 0 && walk.radius() >= static_cast<double>(params.max_radius); };

    add({0, 0}, no_parent);
    std::int64_t arrivals = 0;
    while (size() < params.particles && !wide()) {
        Walker w = walker(params.seed, cluster.walkers++);
        walk.release(w);
        for (;;) {
            unsigned const mask = walk.approach(w);
            if (++arrivals % 4096 == 0) {
                run.at(static_cast<double>(size()) / static_cast<double>(params.particles), "grow");
            }
            Fate const fate = gate.arrive(w, mask);
            if (fate == Fate::sticks) {
                add(w.at, pick(mask, w.random));
            }
            if (fate != Fate::walks_on) {
                break;
            }
            walk.step(w);
        }
    }
    cluster.radius = walk.radius();
    cluster.stop = wide() ? GrowthStop::radius : GrowthStop::particles;
    return direction;
}

/// The share of an arm that must lie in its direction's quadrant, in quarters.
constexpr std::int64_t of_four = 3;

void check(Cluster const& cluster, BranchParams const& params) {
    refuse_if<BadParameter>(params.max_width < 0 || params.max_height < 0, "growth.pick_branch",
                            "max_width is {} and max_height {}, they must be at least 1, or 0 for no limit",
                            params.max_width, params.max_height);
    require_in("growth.pick_branch", "turn_deg", params.turn_deg, Range::between(-180.0, 180.0));
    refuse_if<BadInput>(cluster.cells.empty() || cluster.parent.size() != cluster.cells.size() ||
                            cluster.parent[0] != -1,
                        "growth.pick_branch", "the cluster needs a seed and a parent for every other particle");
    for (std::size_t p = 1; p < cluster.parent.size(); ++p) {
        refuse_if<BadInput>(cluster.parent[p] < 0 || cluster.parent[p] >= static_cast<std::int64_t>(p),
                            "growth.pick_branch", "particle {} hangs on {}, it must hang on one that arrived before it",
                            p, cluster.parent[p]);
    }
}

/// By particle: whether it descends from the root, or is it.
std::vector<std::uint8_t> descendants(Cluster const& cluster, std::size_t root) {
    std::vector<std::uint8_t> descends(cluster.cells.size(), 0);
    descends[root] = 1;
    for (std::size_t p = root + 1; p < descends.size(); ++p) {
        descends[p] = descends[cluster.parent[p]];
    }
    return descends;
}

/// Whether a cell lies in the quadrant around a direction from the seed.
bool lies(Cell c, BranchChoice direction) {
    switch (direction) {
    case BranchChoice::north: return -c.row > 0 && std::abs(c.col) <= -c.row;
    case BranchChoice::east: return c.col > 0 && std::abs(c.row) <= c.col;
    case BranchChoice::south: return c.row > 0 && std::abs(c.col) <= c.row;
    case BranchChoice::west: return -c.col > 0 && std::abs(c.row) <= -c.col;
    case BranchChoice::largest:
    case BranchChoice::all: break;
    }
    return true;
}

/// The particle whose descendants form the arm; 0: none.
std::size_t root_of(Cluster const& cluster, BranchChoice choice) {
    std::size_t const count = cluster.cells.size();
    std::vector<std::int64_t> size(count, 1);
    std::vector<std::int64_t> inside(count, 0);
    Cell const seed = cluster.cells.front();
    for (std::size_t p = count - 1; p > 0; --p) { // children arrive after their parents
        Cell const c{cluster.cells[p].col - seed.col, cluster.cells[p].row - seed.row};
        inside[p] += lies(c, choice) ? 1 : 0;
        ParticleId const up = cluster.parent[p];
        size[up] += size[p];
        inside[up] += inside[p];
    }
    std::size_t best = 0;
    std::int64_t most = 0;
    for (std::size_t p = 1; p < count; ++p) {
        bool const is_arm =
            choice == BranchChoice::largest ? cluster.parent[p] == 0 : 4 * inside[p] >= of_four * size[p];
        if (is_arm && inside[p] > most) {
            most = inside[p];
            best = p;
        }
    }
    return best;
}

std::vector<std::uint8_t> choose(Cluster const& cluster, BranchChoice choice) {
    std::size_t const root = root_of(cluster, choice);
    refuse_if<BadInput>(root == 0, "growth.pick_branch",
                        "the cluster of {} particles has no arm there, choose another or grow more particles",
                        cluster.cells.size());
    return descendants(cluster, root);
}

} // namespace

double least_arrivals(DlaParams const& params) {
    constexpr double rows_of_a_side = 2.5; // measured at S = 0.001 to 0.01 with 100 to 10 000 particles
    auto const radius = static_cast<double>(params.max_radius);
    double const within = params.max_radius > 0 ? 4.0 * radius * radius : std::numeric_limits<double>::infinity();
    double const particles = std::min(static_cast<double>(params.particles), within);
    return particles + rows_of_a_side * std::sqrt(particles) / params.sticking / params.sticking;
}

void require_growth(DlaParams const& params) {
    require_in("growth.grow_dla", "particles", params.particles, Range::at_least(1));
    require_in("growth.grow_dla", "sticking", params.sticking, Range{0.0, 1.0, false, true});
    require_in("growth.grow_dla", "visits", params.visits, Range::between(1, 255));
    refuse_if<BadParameter>(params.max_radius < 0, "growth.grow_dla",
                            "max_radius is {}, it must be at least 1, or 0 for no limit", params.max_radius);
    constexpr double most_arrivals = 1e12;
    double const arrivals = params.particles > 1 ? least_arrivals(params) : 0.0; // one of them is the seed
    refuse_if<BadParameter>(arrivals > most_arrivals, "growth.grow_dla",
                            "{} particles with sticking {} need more than {:.0e} arrivals of walkers and would not end "
                            "in a day: set sticking nearer to 1, or fewer particles",
                            params.particles, params.sticking, most_arrivals);
}

Cluster grow_dla(DlaParams const& params, Run const& run) {
    require_growth(params);
    Cluster cluster;
    std::vector<std::uint8_t> const direction = grow(params, cluster, run); // the walk's memory is free again
    cluster.parent = find_parents(cluster.cells, direction);
    return cluster;
}

Branch pick_branch(Cluster const& cluster, BranchParams const& params) {
    check(cluster, params);
    auto const chosen = params.choice == BranchChoice::all ? std::vector<std::uint8_t>(cluster.cells.size(), 1)
                                                           : choose(cluster, params.choice);
    Branch branch;
    double const turn = params.turn_deg / 180.0 * portable::pi;
    double const c = params.turn_deg == 0.0 ? 1.0 : portable::cos(turn);
    double const s = params.turn_deg == 0.0 ? 0.0 : portable::sin(turn);
    Vec2 low;
    Vec2 high;
    for (std::size_t p = 0; p < chosen.size(); ++p) {
        if (chosen[p] == 0) {
            continue;
        }
        Cell const cell = cluster.cells[p];
        auto const col = static_cast<double>(cell.col);
        auto const row = static_cast<double>(cell.row);
        Vec2 const at{c * col + s * row, c * row - s * col}; // rows grow to the south
        bool const first = branch.cells.empty();
        Vec2 const wider_low = first ? at : Vec2{std::min(low.x, at.x), std::min(low.y, at.y)};
        Vec2 const wider_high = first ? at : Vec2{std::max(high.x, at.x), std::max(high.y, at.y)};
        bool const too_wide =
            params.max_width > 0 && wider_high.x - wider_low.x > static_cast<double>(params.max_width - 1);
        bool const too_high =
            params.max_height > 0 && wider_high.y - wider_low.y > static_cast<double>(params.max_height - 1);
        if (too_wide || too_high) {
            branch.cut = true;
            break;
        }
        low = wider_low;
        high = wider_high;
        branch.cells.push_back(cell);
    }
    return branch;
}

} // namespace thalweg::growth
