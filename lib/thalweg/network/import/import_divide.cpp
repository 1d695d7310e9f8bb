// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <iterator>
#include <queue>
#include <string_view>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/network/import/internal/import_lines.hpp>

namespace thalweg::network::import_steps {
namespace {

bool arrives(Pieces const& p, DividedPieces const& divided, std::size_t k, std::size_t node) {
    auto const& piece = p.pieces[k];
    return divided.reason[k] == nullptr && piece.from != piece.to &&
           (divided.runs[k] > 0 ? piece.to : piece.from) == node;
}

bool departs(Pieces const& p, DividedPieces const& divided, std::size_t k, std::size_t node) {
    auto const& piece = p.pieces[k];
    return divided.reason[k] == nullptr && piece.from != piece.to &&
           (divided.runs[k] > 0 ? piece.from : piece.to) == node;
}

template <class Test> std::size_t count_if(Pieces const& p, std::size_t node, Test const& test) {
    return static_cast<std::size_t>(std::ranges::count_if(p.at_node[node], test));
}

/// The direction from a node to the point at a distance along a piece.
Vec2 chord(Piece const& piece, RiverLine const& line, std::size_t node, double length_m) {
    auto const at = [&](std::size_t i) {
        auto const& v = line.vertices[piece.from == node ? piece.first + i : piece.last - i];
        return Vec2{v.x, v.y};
    };
    Vec2 const begin = at(0);
    double left = length_m;
    Vec2 end = begin;
    for (std::size_t i = 1; i <= piece.last - piece.first && left > 0.0; ++i) {
        double const step = distance(at(i - 1), at(i));
        double const share = step > left ? left / step : 1.0;
        end = {at(i - 1).x + share * (at(i).x - at(i - 1).x), at(i - 1).y + share * (at(i).y - at(i - 1).y)};
        left -= step;
    }
    return {end.x - begin.x, end.y - begin.y};
}

/// 1: straight on, -1: straight back.
double straightness(Pieces const& p, std::vector<RiverLine> const& lines, std::size_t node, std::size_t in,
                    std::size_t out) {
    auto const& a = p.pieces[in];
    auto const& b = p.pieces[out];
    double const along_m = 0.5 * std::min(a.length_m, b.length_m);
    Vec2 const back = chord(a, lines[a.line], node, along_m);
    Vec2 const on = chord(b, lines[b.line], node, along_m);
    double const product = std::sqrt((back.x * back.x + back.y * back.y) * (on.x * on.x + on.y * on.y));
    return product > 0.0 ? -(back.x * on.x + back.y * on.y) / product : 0.0;
}

// [m] By node: total length of the pieces upstream, divided equally at bifurcations; without cycles.
std::vector<double> lengths_above(Pieces const& p, DividedPieces const& divided) {
    std::vector<double> above(p.nodes.size(), 0.0);
    std::vector<std::size_t> awaited(p.nodes.size(), 0);
    std::vector<std::size_t> ready;
    for (std::size_t n = 0; n < p.nodes.size(); ++n) {
        awaited[n] = count_if(p, n, [&](std::size_t k) { return arrives(p, divided, k, n); });
        if (awaited[n] == 0) {
            ready.push_back(n);
        }
    }
    for (std::size_t i = 0; i < ready.size(); ++i) {
        std::size_t const n = ready[i];
        auto const ways = static_cast<double>(count_if(p, n, [&](std::size_t k) { return departs(p, divided, k, n); }));
        for (std::size_t const k : p.at_node[n]) {
            if (departs(p, divided, k, n)) {
                std::size_t const below = other_end(p.pieces[k], n);
                above[below] += above[n] / ways + p.pieces[k].length_m;
                if (--awaited[below] == 0) {
                    ready.push_back(below);
                }
            }
        }
    }
    return above;
}

// Chooses the main branch among the pieces that leave a node: see import_lines. above: from lengths_above; branches: at
// least one, with known directions.
std::size_t main_of(Pieces const& p, std::vector<RiverLine> const& lines, DividedPieces const& divided,
                    std::vector<double> const& length_above, std::size_t node,
                    std::vector<std::size_t> const& branches) {
    if (branches.size() == 1) {
        return branches.front();
    }
    std::vector<std::size_t> in;
    std::ranges::copy_if(p.at_node[node], std::back_inserter(in),
                         [&](std::size_t k) { return arrives(p, divided, k, node); });
    auto const line = [&](std::size_t k) -> RiverLine const& { return lines[p.pieces[k].line]; };
    auto const greatest = std::ranges::max_element(in, {}, [&](std::size_t k) {
        return std::tuple(line(k).size, length_above[other_end(p.pieces[k], node)] + p.pieces[k].length_m);
    });
    auto const any_in = [&](auto const& test) {
        return std::ranges::any_of(in, [&](std::size_t k) { return test(line(k)); });
    };
    auto const key = [&](std::size_t k) {
        RiverLine const& own = line(k);
        int const marked = own.channel == Channel::main ? 1 : own.channel == Channel::minor ? -1 : 0;
        bool const named = any_in([&](RiverLine const& up) { return up.down == own.feature && own.feature != 0; });
        bool const goes_on = any_in([&](RiverLine const& up) { return &up == &own; });
        bool const same_name = any_in([&](RiverLine const& up) { return !own.name.empty() && up.name == own.name; });
        std::int64_t const low = own.rank == 0 ? std::numeric_limits<std::int64_t>::min() : -own.rank;
        double const straight = in.empty() ? 0.0 : straightness(p, lines, node, *greatest, k);
        Vec2 const end = p.nodes[other_end(p.pieces[k], node)];
        return std::tuple(marked, named, goes_on, own.size, same_name, low, straight, -end.x, -end.y);
    };
    return *std::ranges::max_element(branches, {}, key);
}

// Every node gets one main branch. These form trees except for cycles, which are opened; of the other branches those
// stay whose direction is uncertain and that close no loop: orient may reverse them.

constexpr char const* minor_channel = "minor channel";
constexpr char const* closes_loop = "closes a loop";
constexpr char const* circle = "runs in a circle";
constexpr char const* ring = "closed ring";

/// Connected pieces and nodes, both ascending.
struct Component {
    std::vector<std::size_t> pieces;
    std::vector<std::size_t> nodes;
    bool has_loops() const { return pieces.size() >= nodes.size(); }
};

std::vector<Component> components_of(Pieces const& p) {
    Sets sets(p.nodes.size());
    for (auto const& piece : p.pieces) {
        sets.join(piece.from, piece.to);
    }
    std::vector<Component> components;
    std::vector<std::size_t> number(p.nodes.size(), no_piece);
    for (std::size_t n = 0; n < p.nodes.size(); ++n) {
        std::size_t& of = number[sets.of(n)];
        if (of == no_piece) {
            of = components.size();
            components.emplace_back();
        }
        components[of].nodes.push_back(n);
    }
    for (std::size_t k = 0; k < p.pieces.size(); ++k) {
        components[number[sets.of(p.pieces[k].from)]].pieces.push_back(k);
    }
    return components;
}

class Divider {
public:
    Divider(Pieces& pieces, std::vector<RiverLine> const& lines, RiverLines const& file, Orientation orientation,
            std::vector<Evidence> const& evidence, Votes const& drawn)
        : p_(pieces), lines_(lines), file_(file), orientation_(orientation), evidence_(evidence),
          main_(pieces.nodes.size(), no_piece), drawn_(drawn), kept_(pieces.nodes.size()) {
        divided_.reason.assign(p_.pieces.size(), nullptr);
        divided_.runs.assign(p_.pieces.size(), 0);
        reached_.assign(p_.nodes.size(), 0);
        state_.assign(p_.nodes.size(), 0);
        border_m_ = border_distances(p_, lines);
        noise_m_ = noise_of(lines);
    }

    DividedPieces divide(Run const& run) {
        auto const components = components_of(p_);
        for (Component const& component : components) {
            take_directions(component);
        }
        length_above_ = lengths_above(p_, divided_);
        for (Component const& component : components) {
            run.check();
            divide(component);
        }
        for (auto& at : p_.at_node) {
            std::erase_if(at, [&](std::size_t k) { return divided_.reason[k] != nullptr; });
        }
        return std::move(divided_);
    }

private:
    void take_directions(Component const& c) {
        Evidence const* const certain = evidence_for(c);
        for (std::size_t const k : c.pieces) {
            int const vote = certain == nullptr ? 0 : certain->votes[k];
            divided_.runs[k] = vote != 0 || orientation_ == Orientation::topology ? vote : drawn_[k];
            if (p_.pieces[k].from == p_.pieces[k].to) {
                leave_out(k, ring);
            }
        }
    }

    void divide(Component const& c) {
        Evidence const* const certain = evidence_for(c);
        if (certain == nullptr && !c.has_loops()) {
            return;
        }
        if (orientation_ == Orientation::topology) {
            span(c, outermost(c));
            return;
        }
        choose_mains(c);
        open_circles(c);
        keep_mains(c);
        remove_other_branches(c, certain);
        if (certain == nullptr) {
            doubt(c);
        }
    }

    Evidence const* evidence_for(Component const& c) const {
        for (Evidence const& e : evidence_) {
            if (std::ranges::any_of(c.pieces, [&](std::size_t k) { return e.votes[k] != 0; })) {
                return &e;
            }
        }
        return nullptr;
    }

    void leave_out(std::size_t k, char const* reason) { divided_.reason[k] = reason; }
    bool is_out(std::size_t k) const { return divided_.reason[k] != nullptr; }
    bool leaves(std::size_t k, std::size_t node) const {
        auto const& piece = p_.pieces[k];
        return (divided_.runs[k] > 0 ? piece.from : piece.to) == node;
    }
    std::size_t below(std::size_t k) const {
        auto const& piece = p_.pieces[k];
        return divided_.runs[k] > 0 ? piece.to : piece.from;
    }
    std::size_t above(std::size_t k) const { return other_end(p_.pieces[k], below(k)); }
    std::vector<double> const& size_of(std::size_t k) const { return lines_[p_.pieces[k].line].size; }

    std::vector<std::size_t> branches(std::size_t node) const {
        std::vector<std::size_t> result;
        std::ranges::copy_if(p_.at_node[node], std::back_inserter(result),
                             [&](std::size_t k) { return !is_out(k) && leaves(k, node); });
        return result;
    }

    void choose_mains(Component const& c) {
        for (std::size_t const n : c.nodes) {
            auto const out = branches(n);
            main_[n] = out.empty() ? no_piece : main_of(p_, lines_, divided_, length_above_, n, out);
        }
    }

    /// The nodes of the cycle reached from a node along main branches; empty: there is none.
    std::vector<std::size_t> circle_from(std::size_t start) {
        std::vector<std::size_t> way;
        std::size_t n = start;
        while (main_[n] != no_piece && state_[n] == 0) {
            state_[n] = 1;
            way.push_back(n);
            n = below(main_[n]);
        }
        bool const closed = main_[n] != no_piece && state_[n] == 1;
        auto const begin = closed ? std::ranges::find(way, n) : way.end();
        std::vector<std::size_t> result(begin, way.end());
        for (std::size_t const m : way) {
            state_[m] = closed ? 0 : 2;
        }
        return result;
    }

    void open_circles(Component const& c) {
        for (std::size_t const start : c.nodes) {
            for (auto on = circle_from(start); !on.empty(); on = circle_from(start)) {
                open(on);
            }
        }
    }

    /// Opens a cycle: takes another branch out of it if there is one, otherwise removes its smallest piece.
    void open(std::vector<std::size_t> on) {
        std::ranges::sort(on);
        std::size_t exit = no_piece;
        std::size_t at = no_piece;
        for (std::size_t const n : on) {
            auto out = branches(n);
            std::erase_if(out,
                          [&](std::size_t k) { return k == main_[n] || std::ranges::binary_search(on, below(k)); });
            if (out.empty()) {
                continue;
            }
            std::size_t const best = main_of(p_, lines_, divided_, length_above_, n, out);
            if (exit == no_piece || size_of(best) > size_of(exit)) {
                exit = best;
                at = n;
            }
        }
        if (exit != no_piece) {
            leave_out(main_[at], circle);
            main_[at] = exit;
            return;
        }
        auto const key = [&](std::size_t n) {
            return std::tuple(size_of(main_[n]), p_.pieces[main_[n]].length_m, main_[n]);
        };
        std::size_t const least = *std::ranges::min_element(on, {}, key);
        leave_out(main_[least], circle);
        auto const others = branches(least);
        main_[least] = others.empty() ? no_piece : main_of(p_, lines_, divided_, length_above_, least, others);
    }

    void keep_mains(Component const& c) {
        for (std::size_t const n : c.nodes) {
            if (main_[n] != no_piece) {
                kept_.join(n, below(main_[n]));
            }
        }
    }

    void remove_other_branches(Component const& c, Evidence const* certain) {
        std::vector<std::size_t> others;
        std::ranges::copy_if(c.pieces, std::back_inserter(others),
                             [&](std::size_t k) { return !is_out(k) && main_[above(k)] != k; });
        std::ranges::stable_sort(others, std::greater(), [&](std::size_t k) {
            return std::tuple<std::vector<double> const&, double>(size_of(k), p_.pieces[k].length_m);
        });
        for (std::size_t const k : others) {
            bool const is_certain = certain != nullptr && (certain->votes[k] != 0 || ends_the_links(k, *certain));
            if (is_certain && !leads_into_shallow_pit(k, *certain)) {
                leave_out(k, minor_channel);
            } else if (!kept_.join(p_.pieces[k].from, p_.pieces[k].to)) {
                leave_out(k, closes_loop);
            }
        }
    }

    /// Whether a piece is drawn away from others and has no link: not a tributary, which would name its receiver.
    bool ends_the_links(std::size_t k, Evidence const& by) const {
        return by.kind == Evidence::Kind::links && lines_[p_.pieces[k].line].down == 0;
    }

    /// Whether heights lead from one place into two pits, of which one is so shallow that they may be off by noise.
    /// Throws if such a pit is deep, or made by ranks: these are wrong.
    bool leads_into_shallow_pit(std::size_t k, Evidence const& by) {
        if (by.kind != Evidence::Kind::height && by.kind != Evidence::Kind::rank) {
            return false;
        }
        auto const end_of = [&](std::size_t n) {
            while (main_[n] != no_piece) {
                n = below(main_[n]);
            }
            return n;
        };
        std::size_t const own = end_of(below(k));
        std::size_t const other = end_of(above(k));
        bool const is_pit = own != other && p_.at_node[own].size() > 1;
        bool const other_is_pit = own != other && p_.at_node[other].size() > 1;
        if (!is_pit && !other_is_pit) {
            return false;
        }
        if (by.kind == Evidence::Kind::height) {
            double const depth_m = height_at(above(k)) - std::max(is_pit ? height_at(own) : height_at(other),
                                                                  other_is_pit ? height_at(other) : height_at(own));
            if (depth_m <= noise_m_) {
                return true;
            }
        }
        Vec2 const at = p_.nodes[above(k)];
        Vec2 const pit = p_.nodes[is_pit ? own : other];
        throw BadInput(
            "network.import_lines",
            fmt::format(
                "rivers {} and {} in {} both run away from ({:.6f}, {:.6f}) by {}, one of them into ({:.6f}, {:.6f}), "
                "which no river leaves: correct the {} there, or orient by something else (network.lines.orientation)",
                lines_[p_.pieces[k].line].number(), lines_[p_.pieces[main_[above(k)]].line].number(), file_.name, at.x,
                at.y, by.name, pit.x, pit.y, by.name));
    }

    double height_at(std::size_t n) const {
        Piece const& piece = p_.pieces[p_.at_node[n].front()];
        auto const& v = lines_[piece.line].vertices;
        return piece.from == n ? v[piece.first].z : v[piece.last].z;
    }

    /// Ignores drawn directions that contradict one another.
    void doubt(Component const& c) {
        constexpr std::int64_t share = 4; // a quarter
        std::int64_t total = 0;
        for (std::size_t const k : c.pieces) {
            total += is_out(k) ? 0 : weight(p_.pieces[k]);
        }
        auto const [outlet, turned] = least_turned(c);
        if (turned > total / share) {
            span(c, outlet);
        }
    }

    /// The end of the component's tree that reverses the least length, and that length.
    std::pair<std::size_t, std::int64_t> least_turned(Component const& c) {
        std::vector<std::vector<std::size_t>> whole;
        for (std::size_t const n : c.nodes) {
            whole.push_back(p_.at_node[n]);
            std::erase_if(p_.at_node[n], [&](std::size_t k) { return is_out(k); });
        }
        towards_.resize(p_.nodes.size(), no_piece);
        cost_.resize(p_.nodes.size(), 0);
        Tree tree{{}, towards_};
        root_at(p_, c.nodes.front(), tree);
        auto const turned = against(p_, tree, drawn_, cost_);
        auto const key = [&](std::size_t i) {
            std::size_t const n = tree.nodes[i];
            return std::tuple(turned[i], p_.at_node[n].size() > 1, border_m_[n], n);
        };
        std::size_t best = 0;
        for (std::size_t i = 1; i < tree.nodes.size(); ++i) {
            best = key(i) < key(best) ? i : best;
        }
        for (std::size_t i = 0; i < c.nodes.size(); ++i) {
            p_.at_node[c.nodes[i]] = std::move(whole[i]);
        }
        return {tree.nodes[best], turned[best]};
    }

    /// The outermost node: nearest to the border of the box, an end of a line if there is one.
    std::size_t outermost(Component const& c) const {
        return *std::ranges::min_element(
            c.nodes, {}, [&](std::size_t n) { return std::tuple(p_.at_node[n].size() > 1, border_m_[n], n); });
    }

    /// Keeps the tree of the largest, then shortest paths to an outlet (Prim 1957; Dijkstra 1959).
    void span(Component const& c, std::size_t outlet) {
        struct Step {
            std::vector<double> const* size;
            double way_m;
            std::size_t piece;
            std::size_t to;
            bool operator<(Step const& o) const { // the queue returns the greatest
                return std::forward_as_tuple(*size, -way_m, o.piece) < std::forward_as_tuple(*o.size, -o.way_m, piece);
            }
        };
        for (std::size_t const k : c.pieces) {
            divided_.runs[k] = 0;
            if (p_.pieces[k].from != p_.pieces[k].to) {
                leave_out(k, closes_loop);
            }
        }
        std::priority_queue<Step> queue;
        auto const reach = [&](std::size_t n, double way_m) {
            reached_[n] = 1;
            for (std::size_t const k : p_.at_node[n]) {
                auto const& piece = p_.pieces[k];
                if (reached_[other_end(piece, n)] == 0) {
                    queue.push({&size_of(k), way_m + piece.length_m, k, other_end(piece, n)});
                }
            }
        };
        reach(outlet, 0.0);
        while (!queue.empty()) {
            Step const next = queue.top();
            queue.pop();
            if (reached_[next.to] == 0) {
                divided_.reason[next.piece] = nullptr;
                reach(next.to, next.way_m);
            }
        }
    }

    Pieces& p_;
    std::vector<RiverLine> const& lines_;
    RiverLines const& file_;
    Orientation orientation_;
    std::vector<Evidence> const& evidence_;
    std::vector<std::size_t> main_; ///< by node: the remaining piece that leaves it
    std::vector<char> state_ = {};  ///< by node: 1: on the current path, 2: known to lead out
    std::vector<double> length_above_ = {};
    std::vector<double> border_m_ = {};
    std::vector<char> reached_ = {};      ///< by node, for the current component
    std::vector<PieceId> towards_ = {};   ///< buffer for a tree
    std::vector<std::int64_t> cost_ = {}; ///< buffer for a tree
    Votes const& drawn_;                  ///< or estimated
    double noise_m_ = 0.0;                ///< of heights
    Sets kept_;
    DividedPieces divided_ = {};
};

constexpr char const* unfed = "goes on from a minor channel";

/// By node: the pieces outside the network that touch it, without rings.
std::vector<std::vector<std::size_t>> outside_at(Pieces const& p, DividedPieces const& divided) {
    std::vector<std::vector<std::size_t>> at(p.nodes.size());
    for (std::size_t k = 0; k < p.pieces.size(); ++k) {
        if (divided.reason[k] != nullptr && p.pieces[k].from != p.pieces[k].to) {
            at[p.pieces[k].from].push_back(k);
            at[p.pieces[k].to].push_back(k);
        }
    }
    return at;
}

} // namespace

DividedPieces divide(Pieces& pieces, std::vector<RiverLine> const& lines, RiverLines const& file,
                     Orientation orientation, std::vector<Evidence> const& evidence, Votes const& drawn,
                     Run const& run) {
    return Divider(pieces, lines, file, orientation, evidence, drawn).divide(run);
}

void drop_unfed(Pieces& p, DividedPieces& divided, std::vector<PieceId>& leaves) {
    auto const outside = outside_at(p, divided);
    std::vector<int> arriving(p.nodes.size(), 0);
    auto const below = [&](std::size_t n) { return other_end(p.pieces[leaves[n]], n); };
    for (std::size_t n = 0; n < p.nodes.size(); ++n) {
        if (leaves[n] != no_piece) {
            ++arriving[below(n)];
        }
    }
    auto const runs_from = [&](std::size_t k, std::size_t n) {
        return divided.runs[k] != 0 && (divided.runs[k] > 0 ? p.pieces[k].from : p.pieces[k].to) == n;
    };
    for (std::size_t start = 0; start < p.nodes.size(); ++start) {
        bool const is_spring = leaves[start] != no_piece && runs_from(leaves[start], start) &&
                               std::ranges::all_of(outside[start], [&](std::size_t k) { return runs_from(k, start); });
        if (arriving[start] > 0 || outside[start].empty() || is_spring) {
            continue;
        }
        for (std::size_t n = start; leaves[n] != no_piece && arriving[n] == 0;) {
            PieceId const k = leaves[n];
            std::size_t const next = below(n);
            divided.reason[k] = unfed;
            leaves[n] = no_piece;
            std::erase(p.at_node[n], k);
            std::erase(p.at_node[next], k);
            --arriving[next];
            n = next;
        }
    }
}

std::vector<SecondaryLine> secondary_lines(Pieces const& p, DividedPieces const& divided,
                                           std::vector<RiverLine> const& lines, std::vector<Finding>& repairs) {
    std::vector<SecondaryLine> secondary;
    for (std::size_t k = 0; k < p.pieces.size(); ++k) {
        if (divided.reason[k] == nullptr) {
            continue;
        }
        auto const& first = p.pieces[k];
        double length_m = first.length_m;
        std::size_t end = k;
        auto const goes_on = [&] {
            return end + 1 < p.pieces.size() && divided.reason[end + 1] != nullptr &&
                   std::string_view(divided.reason[end + 1]) == divided.reason[k] &&
                   p.pieces[end + 1].line == first.line && p.pieces[end + 1].first == p.pieces[end].last;
        };
        while (goes_on()) {
            length_m += p.pieces[++end].length_m;
        }
        auto const& line = lines[first.line];
        SecondaryLine one{line.feature, {}, divided.reason[k], line.feature};
        one.vertices.assign(line.vertices.begin() + static_cast<std::ptrdiff_t>(first.first),
                            line.vertices.begin() + static_cast<std::ptrdiff_t>(p.pieces[end].last) + 1);
        Vec2 const at{one.vertices.front().x, one.vertices.front().y};
        repairs.push_back({"secondary", line.number(), at, length_m,
                           fmt::format("river {} is secondary for {:.6g} m from ({:.6f}, {:.6f}): {}", line.number(),
                                       length_m, at.x, at.y, one.reason)});
        secondary.push_back(std::move(one));
        k = end;
    }
    return secondary;
}

} // namespace thalweg::network::import_steps
