// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/planform/carry_outlets.hpp>

#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <queue>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/geometry/segment_grid.hpp>
#include <thalweg/network/order/internal/require_trees.hpp>

namespace thalweg::network {
namespace {

// A vertex at which a river may be joined.
struct Confluence {
    Vec2 at;
    std::int64_t basin = 0;
};

constexpr double slack_cells = 1e-9; ///< closer lines count as meeting

bool goes_diagonally(Cell a, Cell b) {
    return a.col != b.col && a.row != b.row;
}

/// The cell whose south-east corner a diagonal step crosses.
Cell corner_cell(Cell a, Cell b) {
    return {std::min(a.col, b.col), std::min(a.row, b.row)};
}

/// The diagonal of a step: 1: north-west to south-east, 2: north-east to south-west.
std::uint8_t diagonal(Cell a, Cell b) {
    return (a.col < b.col) == (a.row < b.row) ? 1 : 2;
}

// A step into a cell d cells from a river costs 1 + repulsion / (d + 1/2)^2: an unconstrained river stays midway
// between others.
constexpr double repulsion = 10.0;
constexpr std::uint8_t beside_cells = 2; ///< within this distance water may leave for the other river

/// Whether two segments from one point meet only there; within slack: false.
bool fan_out(Vec2 from, Vec2 a, Vec2 b, double slack) {
    double const dot = (a.x - from.x) * (b.x - from.x) + (a.y - from.y) * (b.y - from.y);
    return dot < 0.0 || std::fabs(cross(from, a, b)) > slack * std::max(distance(from, a), distance(from, b));
}

bool apart(double a, double b, double c, double d, double slack) {
    return std::max(a, b) + slack < std::min(c, d) || std::max(c, d) + slack < std::min(a, b);
}

/// Whether a and b lie on one side of the line through s, farther from it than slack.
bool on_one_side(geometry::Segment s, Vec2 a, Vec2 b, double slack) {
    double const least = slack * distance(s.a, s.b);
    double const left = cross(s.a, s.b, a);
    double const right = cross(s.a, s.b, b);
    return (left > least && right > least) || (left < -least && right < -least);
}

/// Whether s and t do not meet; within slack [m]: false.
bool clear(geometry::Segment s, geometry::Segment t, double slack) {
    return apart(s.a.x, s.b.x, t.a.x, t.b.x, slack) || apart(s.a.y, s.b.y, t.a.y, t.b.y, slack) ||
           on_one_side(s, t.a, t.b, slack) || on_one_side(t, s.a, s.b, slack);
}

// The existing rivers: their cells, the corners they cross diagonally, and the segments near each cell.
class CarryGround {
public:
    CarryGround(Grid const& grid, CarryParams const& params)
        : grid_(grid), params_(params), slack_m_(slack_cells * grid.cell_m), distance_(grid, far), corner_(grid, 0) {}

    Grid const& grid() const { return grid_; }
    double cost_of_joining() const { return params_.join_cells; }

    // basin: number of the basin whose inner vertices may be joined.
    void add(std::vector<Vec2> const& line, std::int64_t basin, std::string const& what) {
        for (std::size_t i = 1; i + 1 < line.size(); ++i) {
            Cell const cell = cells_along({line[i]}, grid_, what).front();
            confluences_.try_emplace(grid_.index(cell), Confluence{line[i], basin});
        }
        std::vector<Cell> const cells = cells_along(line, grid_, what);
        std::vector<Cell> changed;
        for (std::size_t i = 0; i < cells.size(); ++i) {
            if (distance_[cells[i]] != 0) {
                distance_[cells[i]] = 0;
                changed.push_back(cells[i]);
            }
            if (i > 0 && goes_diagonally(cells[i - 1], cells[i])) {
                corner_[corner_cell(cells[i - 1], cells[i])] |= diagonal(cells[i - 1], cells[i]);
            }
        }
        spread(std::move(changed));
        for (std::size_t i = 1; i < line.size(); ++i) {
            touch({line[i - 1], line[i]});
        }
    }

    // The cost of entering a cell: rivers repel.
    double cost(Cell c) const {
        double const d = static_cast<double>(distance_[c]) + 0.5;
        return 1.0 + repulsion / (d * d) + (distance_[c] <= beside_cells ? params_.beside_cells : 0.0);
    }

    // The confluence possible in a cell, or null.
    Confluence const* confluence_in(Cell c) const {
        auto const found = confluences_.find(grid_.index(c));
        return found == confluences_.end() ? nullptr : &found->second;
    }

    // Whether a river may run from p, a point of cell `from`, to the centre of its neighbour `to`. A river that ends at
    // p is no obstacle.
    bool open(Vec2 p, Cell from, Cell to) const {
        if (distance_[to] == 0 || cuts_a_corner(from, to)) {
            return false;
        }
        geometry::Segment const step{p, grid_.centre(to)};
        return all_near(from, to, [&](geometry::Segment s) {
            return s.a == p   ? fan_out(p, step.b, s.b, slack_m_)
                   : s.b == p ? fan_out(p, step.b, s.a, slack_m_)
                              : clear(step, s, slack_m_);
        });
    }

    // Whether a river may run from p, a point of cell `from`, to a vertex of the river in its neighbour `to`.
    bool opens_to(Confluence const& confluence, Vec2 p, Cell from, Cell to) const {
        if (cuts_a_corner(from, to)) {
            return false;
        }
        geometry::Segment const step{p, confluence.at};
        return all_near(from, to, [&](geometry::Segment s) {
            return s.a == step.b   ? fan_out(step.b, p, s.b, slack_m_)
                   : s.b == step.b ? fan_out(step.b, p, s.a, slack_m_)
                   : s.a == p      ? fan_out(p, step.b, s.b, slack_m_)
                   : s.b == p      ? fan_out(p, step.b, s.a, slack_m_)
                                   : clear(step, s, slack_m_);
        });
    }

private:
    static constexpr std::uint8_t far = 255;

    // Whether the step to a neighbour crosses a river that runs diagonally between the other two cells.
    bool cuts_a_corner(Cell from, Cell to) const {
        return goes_diagonally(from, to) && (corner_[corner_cell(from, to)] & ~diagonal(from, to)) != 0;
    }

    /// Whether a predicate holds for all segments that touch the cells around a step.
    template <class Holds> bool all_near(Cell from, Cell to, Holds const& holds) const {
        for (std::int64_t row = std::min(from.row, to.row); row <= std::max(from.row, to.row); ++row) {
            for (std::int64_t col = std::min(from.col, to.col); col <= std::max(from.col, to.col); ++col) {
                auto const near = touching_.find(grid_.index({col, row}));
                if (near != touching_.end() && !std::all_of(near->second.begin(), near->second.end(),
                                                            [&](std::size_t k) { return holds(segments_[k]); })) {
                    return false;
                }
            }
        }
        return true;
    }

    // Reduces the city-block distances around new river cells.
    void spread(std::vector<Cell> front) {
        for (std::uint8_t d = 1; d < far && !front.empty(); ++d) {
            std::vector<Cell> next;
            for (Cell const c : front) {
                for (Cell const n :
                     {Cell{c.col, c.row - 1}, Cell{c.col - 1, c.row}, Cell{c.col + 1, c.row}, Cell{c.col, c.row + 1}}) {
                    if (grid_.contains(n) && distance_[n] > d) {
                        distance_[n] = d;
                        next.push_back(n);
                    }
                }
            }
            front = std::move(next);
        }
    }

    // Registers a segment with every cell it passes or touches.
    void touch(geometry::Segment s) {
        std::size_t const number = segments_.size();
        segments_.push_back(s);
        double const h = grid_.cell_m;
        double const eps = 1e-6 * h;
        auto const row_of = [&](double y) { return static_cast<std::int64_t>(std::floor((grid_.north - y) / h)); };
        auto const col_of = [&](double x) { return static_cast<std::int64_t>(std::floor((x - grid_.west) / h)); };
        for (std::int64_t row = row_of(std::max(s.a.y, s.b.y) + eps); row <= row_of(std::min(s.a.y, s.b.y) - eps);
             ++row) {
            double begin = 0.0;
            double end = 1.0;
            if (s.a.y != s.b.y) {
                double const top = grid_.north - static_cast<double>(row) * h + eps;
                double const t = (top - s.a.y) / (s.b.y - s.a.y);
                double const u = (top - h - 2.0 * eps - s.a.y) / (s.b.y - s.a.y);
                begin = std::clamp(std::min(t, u), 0.0, 1.0);
                end = std::clamp(std::max(t, u), 0.0, 1.0);
            }
            double const x0 = s.a.x + begin * (s.b.x - s.a.x);
            double const x1 = s.a.x + end * (s.b.x - s.a.x);
            for (std::int64_t col = col_of(std::min(x0, x1) - eps); col <= col_of(std::max(x0, x1) + eps); ++col) {
                if (grid_.contains({col, row})) {
                    touching_[grid_.index({col, row})].push_back(number);
                }
            }
        }
    }

    Grid grid_;
    CarryParams params_;
    double slack_m_;
    Raster<std::uint8_t> distance_; // [cells] city-block, to the nearest river cell; 255: that far or farther
    Raster<std::uint8_t> corner_;   // by cell, for its south-east corner: 1: a river runs NW-SE, 2: NE-SW
    std::vector<geometry::Segment> segments_;
    std::unordered_map<std::int64_t, Confluence> confluences_;            // by cell; only looked up, never iterated
    std::unordered_map<std::int64_t, std::vector<std::size_t>> touching_; // only looked up, never iterated
};

// Where rivers may end: on the grid's border and beside the sea.
class RiverEnds {
public:
    explicit RiverEnds(Grid grid) : grid_(std::move(grid)) {}
    explicit RiverEnds(Mask const& land) : grid_(land.grid()), land_(land), steps_(land.grid(), unreached) {
        std::vector<Cell> front;
        for (std::int64_t i = 0; i < land.cells(); ++i) {
            Cell const c = grid_.at(i);
            bool at_sea = false;
            cells_around(grid_, c, 1, [&](Cell n) { at_sea = at_sea || land[n] == 0; });
            if (at_sea || grid_.on_border(c)) {
                steps_[i] = 0;
                front.push_back(c);
            }
        }
        for (std::int32_t steps = 1; !front.empty(); ++steps) {
            std::vector<Cell> next;
            for (Cell const c : front) {
                cells_around(grid_, c, 1, [&](Cell n) {
                    if (steps_[n] == unreached) {
                        steps_[n] = steps;
                        next.push_back(n);
                    }
                });
            }
            front = std::move(next);
        }
    }

    // Chessboard distance to the nearest end.
    std::int64_t steps(Cell c) const {
        return steps_.cells() > 0 ? steps_[c]
                                  : std::min({c.col, c.row, grid_.width - 1 - c.col, grid_.height - 1 - c.row});
    }

    bool is_land(Cell c) const { return !grid_.contains(c) || land_.cells() == 0 || land_[c] != 0; }
    bool at_border(Cell c) const { return grid_.on_border(c); }

private:
    static constexpr std::int32_t unreached = -1;
    Grid grid_;
    Mask land_;
    Raster<std::int32_t> steps_;
};

// A path of cells, the river's own first; empty: none.
struct Way {
    std::vector<Cell> cells;
    Confluence const* into = nullptr; // at the last cell; null: it is a valid end
};

constexpr double root_of_two = 1.41421356237309504880;

class WaySearch {
public:
    WaySearch(Vec2 outlet, Cell start, CarryGround const& ground, RiverEnds const& ends,
              std::function<bool(Confluence const&)> const& may_join)
        : outlet_(outlet), start_(start), ground_(ground), grid_(ground.grid()), ends_(ends), may_join_(may_join) {}

    Way find() {
        reached_[grid_.index(start_)] = {};
        queue_.emplace(static_cast<double>(ends_.steps(start_)), grid_.index(start_));
        while (!queue_.empty()) {
            std::int64_t const at = queue_.top().second;
            queue_.pop();
            if (reached_[at].settled) {
                continue;
            }
            reached_[at].settled = true;
            if (reached_[at].into != nullptr || ends_.steps(grid_.at(at)) == 0) {
                return way_to(at);
            }
            go_on_from(at);
        }
        return {};
    }

private:
    struct Reached {
        double cost = 0.0;
        std::int64_t from = -1;
        bool settled = false;
        Confluence const* into = nullptr;
    };

    Way way_to(std::int64_t at) {
        Way way{{}, reached_[at].into};
        for (std::int64_t i = at; i >= 0; i = reached_[i].from) {
            way.cells.push_back(grid_.at(i));
        }
        std::reverse(way.cells.begin(), way.cells.end());
        return way;
    }

    void go_on_from(std::int64_t at) {
        Cell const c = grid_.at(at);
        Vec2 const here = c == start_ ? outlet_ : grid_.centre(c);
        for (std::int64_t dr = -1; dr <= 1; ++dr) {
            for (std::int64_t dc = -1; dc <= 1; ++dc) {
                Cell const next{c.col + dc, c.row + dr};
                if ((dr == 0 && dc == 0) || !grid_.contains(next) || !ends_.is_land(next)) {
                    continue;
                }
                Confluence const* const into = ground_.confluence_in(next);
                if (into != nullptr && may_join_(*into) && ground_.opens_to(*into, here, c, next)) {
                    join(at, next, into);
                } else if (ground_.open(here, c, next)) {
                    step(at, next, dr != 0 && dc != 0 ? root_of_two : 1.0);
                }
            }
        }
    }

    void join(std::int64_t at, Cell next, Confluence const* into) {
        std::int64_t const to = grid_.index(next);
        double const cost = reached_[at].cost + ground_.cost_of_joining();
        auto const [known, is_new] = reached_.try_emplace(to);
        if (is_new || cost < known->second.cost) {
            known->second = {cost, at, false, into};
            queue_.emplace(cost, to); // beside the border the actual cost may exceed the estimate
        }
    }

    void step(std::int64_t at, Cell next, double length) {
        std::int64_t const to = grid_.index(next);
        Reached const here = reached_[at]; // a copy: insertion moves entries
        double const cost = here.cost + ground_.cost(next) * length;
        auto const [known, is_new] = reached_.try_emplace(to);
        bool const straight = here.from >= 0 && to - at == at - here.from;
        if (is_new || cost < known->second.cost || (straight && cost == known->second.cost && !known->second.settled)) {
            known->second = {cost, at, false, nullptr};
            queue_.emplace(cost + static_cast<double>(ends_.steps(next)), to);
        }
    }

    using Entry = std::pair<double, std::int64_t>; // the least cost of a path through this cell, the cell

    Vec2 outlet_;
    Cell start_;
    CarryGround const& ground_;
    Grid const& grid_;
    RiverEnds const& ends_;
    std::function<bool(Confluence const&)> const& may_join_;
    std::unordered_map<std::int64_t, Reached> reached_; // only looked up, never iterated
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
};

// The least-cost path from a river's end, in the cell start, to a valid end or into a river that it may join; of equal
// paths the straightest. Source: A*, Hart, Nilsson and Raphael 1968: each step costs at least one and comes at most one
// cell closer; a joined river counts as the end.
Way least_cost_path(Vec2 outlet, Cell start, CarryGround const& ground, RiverEnds const& ends,
                    std::function<bool(Confluence const&)> const& may_join) {
    return WaySearch(outlet, start, ground, ends, may_join).find();
}

/// Union-find of basins.
class Basins {
public:
    explicit Basins(std::size_t count) : into_(count) { std::iota(into_.begin(), into_.end(), std::int64_t{0}); }

    std::int64_t root(std::int64_t basin) const {
        while (into_[basin] != basin) {
            basin = into_[basin];
        }
        return basin;
    }
    void join(std::int64_t basin, std::int64_t into) { into_[root(basin)] = root(into); }

private:
    std::vector<std::int64_t> into_;
};

/// Turns vertices at which other rivers end into nodes. ends: nodes that lie on such a vertex.
NetworkDraft joined(StreamNetwork const& network, std::vector<NodeId> const& ends) {
    std::map<std::pair<double, double>, NodeId> node_at;
    std::vector<std::uint8_t> is_end(network.node_count(), 0);
    for (NodeId const n : ends) {
        is_end[n] = 1;
    }
    NetworkDraft out;
    std::vector<NodeId> node(is_end.size());
    for (NodeId n = 0; n < node.size(); ++n) {
        auto const place = std::pair(network.node(n).at.x, network.node(n).at.y);
        auto const known = is_end[n] != 0 ? node_at.find(place) : node_at.end();
        node[n] = known != node_at.end() ? known->second : out.add_node(network.node(n).at);
        if (is_end[n] != 0) {
            node_at.emplace(place, node[n]);
        }
    }
    for (ArcId arc = 0; arc < network.arc_count(); ++arc) {
        Arc piece = network.arc(arc);
        std::vector<Vec2> const line = std::move(piece.line);
        NodeId from = node[network.from(arc)];
        piece.line = {line.front()};
        for (std::size_t i = 1; i < line.size(); ++i) {
            piece.line.push_back(line[i]);
            auto const known = node_at.find({line[i].x, line[i].y});
            if (i + 1 < line.size() && known != node_at.end()) {
                out.add_arc(from, known->second, piece);
                from = known->second;
                piece.line = {line[i]};
            }
        }
        out.add_arc(from, node[network.to(arc)], piece);
    }
    return out;
}

/// Outlets inside the grid, within reach of an end. The nearest to an end come first: their short paths leave the most
/// space to the others.
std::vector<NodeId> outlets_inside(StreamNetwork const& network, Grid const& grid, RiverEnds const& ends,
                                   std::int64_t reach_cells) {
    std::vector<std::pair<std::int64_t, NodeId>> inside;
    for (NodeId const outlet : network.outlets()) {
        Cell const cell = cells_along({network.node(outlet).at}, grid).front();
        if (std::int64_t const steps = ends.steps(cell); steps > 0 && steps <= reach_cells) {
            inside.emplace_back(steps, outlet);
        }
    }
    std::sort(inside.begin(), inside.end());
    std::vector<NodeId> outlets;
    for (auto const& [steps, outlet] : inside) {
        outlets.push_back(outlet);
    }
    return outlets;
}

/// A network under extension.
class Carrying {
public:
    Carrying(StreamNetwork const& network, Grid const& grid, RiverEnds const& ends, CarryParams const& params)
        : network_(network), ends_(ends), params_(params), ground_(grid, params), basins_(network.outlets().size() + 1),
          longer_(network.draft()) {
        for (std::size_t a = 0; a < network.arc_count(); ++a) {
            ground_.add(network.arc(a).line, network.basin(network.from(a)), fmt::format("arc {}", a + 1));
        }
    }

    /// Extends the river of an outlet.
    /// \return a note on it, or on a missing path
    Finding carry(NodeId outlet) {
        Vec2 const at = network_.node(outlet).at;
        std::int64_t const basin = network_.basin(outlet);
        Way const way =
            least_cost_path(at, cells_along({at}, ground_.grid()).front(), ground_, ends_, [&](Confluence const& into) {
                return params_.join && basins_.root(into.basin) != basins_.root(basin);
            });
        Finding note{"closed_basin"};
        auto const last = network_.in(outlet).front();
        std::int64_t const feature = network_.arc(last).feature;
        note.feature = feature != 0 ? feature : static_cast<std::int64_t>(last) + 1;
        note.where = at;
        if (way.cells.empty()) {
            note.text = fmt::format("the outlet at ({:.3f}, {:.3f}) stays inside the grid: every way to its border "
                                    "meets a river",
                                    at.x, at.y);
            return note;
        }
        bool const joins = way.into != nullptr;
        std::vector<Vec2> line = line_of(way, at);
        if (joins) {
            basins_.join(basin, way.into->basin);
        }
        char const* const to = joins ? "river" : ends_.at_border(way.cells.back()) ? "border" : "coast";
        ground_.add(line, basin, "a carried outlet"); // invalidates pointers: the path is no longer used
        note.kind = joins ? FindingKind("joined_outlet") : "carried_outlet";
        note.amount = length_of(line);
        note.text = fmt::format("the outlet at ({:.3f}, {:.3f}) was carried {:.3f} m to the {} at ({:.3f}, {:.3f})",
                                at.x, at.y, note.amount, to, line.back().x, line.back().y);
        NodeId const end = draw_on(outlet, std::move(line));
        if (joins) {
            confluences_.push_back(end);
        }
        return note;
    }

    /// The extended network; joined arcs are split in two.
    StreamNetwork take() {
        if (confluences_.empty()) {
            return std::move(longer_);
        }
        return joined(std::move(longer_), confluences_);
    }

private:
    std::vector<Vec2> line_of(Way const& way, Vec2 from) const {
        std::vector<Vec2> line{from};
        for (std::size_t i = 1; i < way.cells.size(); ++i) {
            line.push_back(ground_.grid().centre(way.cells[i]));
        }
        if (way.into != nullptr) {
            line.back() = way.into->at;
        }
        return line;
    }

    /// Extends the arc that ends in an outlet, or adds one if there are several.
    /// \return node at the end
    NodeId draw_on(NodeId outlet, std::vector<Vec2> line) {
        auto const arriving = network_.in(outlet);
        if (arriving.size() == 1) {
            std::vector<Vec2>& drawn = longer_.arcs[arriving.front()].arc.line;
            drawn.insert(drawn.end(), line.begin() + 1, line.end());
            longer_.nodes[outlet].at = line.back();
            return outlet;
        }
        Arc trunk;
        trunk.persistence = 0.0;
        for (ArcId const a : arriving) {
            trunk.persistence = std::max(trunk.persistence, network_.arc(a).persistence);
        }
        NodeId const mouth = longer_.add_node(line.back());
        trunk.line = std::move(line);
        longer_.add_arc(outlet, mouth, std::move(trunk));
        return mouth;
    }

    StreamNetwork const& network_;
    RiverEnds const& ends_;
    CarryParams const& params_;
    CarryGround ground_;
    Basins basins_; // 0: none
    NetworkDraft longer_;
    std::vector<NodeId> confluences_;
};

CarriedNetwork carry(StreamNetwork const& network, Grid const& grid, RiverEnds const& ends, std::int64_t reach_cells,
                     CarryParams const& params) {
    require_trees(network, "network.carry_outlets");
    refuse_if<BadParameter>(!(params.join_cells >= 0.0 && params.beside_cells >= 0.0), "network.carry_outlets",
                            "joining costs {} cells, a cell beside a river {}; give 0 or more", params.join_cells,
                            params.beside_cells);
    Carrying carrying(network, grid, ends, params);
    CarriedNetwork carried;
    for (NodeId const outlet : outlets_inside(network, grid, ends, reach_cells)) {
        carried.notes.push_back(carrying.carry(outlet));
    }
    carried.network = carrying.take();
    return carried;
}

} // namespace

CarriedNetwork carry_outlets(StreamNetwork const& network, Grid const& grid, CarryParams const& params) {
    return carry(network, grid, RiverEnds(grid), std::numeric_limits<std::int64_t>::max(), params);
}

CarriedNetwork carry_outlets(StreamNetwork const& network, Mask const& land, std::int64_t reach_cells,
                             CarryParams const& params) {
    return carry(network, land.grid(), RiverEnds(land), reach_cells, params);
}

} // namespace thalweg::network
