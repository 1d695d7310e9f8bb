// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <thalweg/network/import/internal/import_lines.hpp>

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/geometry/nearby.hpp>

// Described in docs/algorithms/river_directions.md.

namespace thalweg::network {
namespace {

using import_steps::no_piece;
using import_steps::Piece;
using import_steps::PieceId;
using import_steps::Pieces;

void refuse_unusable(RiverLines const& file) {
    if (file.lines.empty()) {
        throw BadInput("network.import_lines", file.name + " holds no lines");
    }
    for (auto const& line : file.lines) {
        auto const& v = line.vertices;
        for (std::size_t i = 0; i < v.size(); ++i) {
            if (!std::isfinite(v[i].x) || !std::isfinite(v[i].y) || (file.has_z && !std::isfinite(v[i].z))) {
                throw BadInput("network.import_lines",
                               fmt::format("vertex {} of river {} in {} is not finite: ({}, {}, {}); correct the file",
                                           i + 1, line.number(), file.name, v[i].x, v[i].y, v[i].z));
            }
        }
        bool const is_point =
            std::ranges::all_of(v, [&](Vec3 const& p) { return p.x == v.front().x && p.y == v.front().y; });
        if (is_point) {
            throw BadInput(
                "network.import_lines",
                fmt::format("river {} in {} has no length{}; remove it", line.number(), file.name,
                            v.empty() ? std::string() : fmt::format(" at ({:.6f}, {:.6f})", v.front().x, v.front().y)));
        }
    }
}

// The pieces with their directions.
struct Flow {
    Pieces const& pieces;
    std::vector<RiverLine> const& lines;
    std::vector<PieceId> leaves; // by node: the piece that leaves it; no_piece: an outlet

    // Its vertices, upstream first.
    std::vector<Vec3> vertices(std::size_t node) const {
        auto const& piece = pieces.pieces[leaves[node]];
        auto const& v = lines[piece.line].vertices;
        std::vector<Vec3> out(v.begin() + static_cast<std::ptrdiff_t>(piece.first),
                              v.begin() + static_cast<std::ptrdiff_t>(piece.last) + 1);
        if (piece.from != node) {
            std::ranges::reverse(out);
        }
        return out;
    }
    std::size_t downstream(std::size_t node) const {
        auto const& piece = pieces.pieces[leaves[node]];
        return piece.from == node ? piece.to : piece.from;
    }
    RiverLine const& line(std::size_t node) const { return lines[pieces.pieces[leaves[node]].line]; }
};

// Every node after the node downstream of it.
std::vector<std::size_t> upstream_order(Flow const& flow) {
    std::vector<std::vector<std::size_t>> above(flow.leaves.size());
    std::vector<std::size_t> order;
    for (std::size_t n = 0; n < flow.leaves.size(); ++n) {
        if (flow.leaves[n] == no_piece) {
            order.push_back(n);
        } else {
            above[flow.downstream(n)].push_back(n);
        }
    }
    for (std::size_t i = 0; i < order.size(); ++i) {
        auto const& up = above[order[i]];
        order.insert(order.end(), up.begin(), up.end());
    }
    return order;
}

// Chooses one height per node: the lowest of those that meet there, so that nothing rises into it, but not below the
// next vertex of the river that leaves it.
std::vector<double> node_heights(Flow const& flow, std::vector<Finding>& repairs) {
    std::vector<double> z(flow.leaves.size(), 0.0);
    for (std::size_t const n : upstream_order(flow)) {
        double low = std::numeric_limits<double>::infinity();
        double high = -low;
        for (std::size_t const k : flow.pieces.at_node[n]) {
            auto const& piece = flow.pieces.pieces[k];
            double const end = flow.lines[piece.line].vertices[piece.from == n ? piece.first : piece.last].z;
            low = std::min(low, end);
            high = std::max(high, end);
        }
        z[n] = low;
        if (flow.leaves[n] != no_piece) {
            auto const v = flow.vertices(n);
            z[n] = std::max(low, v.size() == 2 ? z[flow.downstream(n)] : v[1].z);
        }
        if (high - low > import_steps::same_point_m) {
            auto const& piece = flow.pieces.pieces[flow.pieces.at_node[n].front()];
            Vec2 const at = flow.pieces.nodes[n];
            repairs.push_back({"height", flow.lines[piece.line].number(), at, high - low,
                               fmt::format("rivers meet at ({:.6f}, {:.6f}) in heights from {:.7g} to {:.7g} m; "
                                           "{:.7g} m is taken",
                                           at.x, at.y, low, high, z[n])});
        } else if (z[n] - low > import_steps::same_point_m) {
            auto const& piece = flow.pieces.pieces[flow.pieces.at_node[n].front()];
            Vec2 const at = flow.pieces.nodes[n];
            repairs.push_back({"height", flow.lines[piece.line].number(), at, z[n] - low,
                               fmt::format("the river at ({:.6f}, {:.6f}) is {:.7g} m high and rises from there; "
                                           "{:.7g} m is taken",
                                           at.x, at.y, low, z[n])});
        }
    }
    return z;
}

// Nodes between two rivers end to end are removed, unless the type changes.
std::vector<char> vanishing(Flow const& flow, std::vector<Finding>& repairs) {
    std::size_t const nodes = flow.leaves.size();
    std::vector<std::size_t> above(nodes, 0);
    std::vector<int> arriving(nodes, 0);
    for (std::size_t n = 0; n < nodes; ++n) {
        if (flow.leaves[n] != no_piece) {
            above[flow.downstream(n)] = n;
            ++arriving[flow.downstream(n)];
        }
    }
    std::vector<char> result(nodes, 0);
    for (std::size_t n = 0; n < nodes; ++n) {
        if (arriving[n] != 1 || flow.leaves[n] == no_piece) {
            continue;
        }
        auto const& upper = flow.line(above[n]);
        auto const& lower = flow.line(n);
        if (upper.type != lower.type) {
            continue;
        }
        result[n] = 1;
        if (upper.feature != lower.feature && upper.feature != 0 && lower.feature != 0) {
            auto const& piece = flow.pieces.pieces[flow.leaves[n]];
            Vec2 const at = flow.pieces.nodes[n];
            repairs.push_back({"joined", upper.number(), at, piece.length_m,
                               fmt::format("river {} goes on as river {} at ({:.6f}, {:.6f}): one arc", upper.number(),
                                           lower.number(), at.x, at.y)});
        }
    }
    return result;
}

constexpr double slip_in_near = 20.0; // longer overshoots are not drawing errors

/// [m] What lines step back by, or run beside themselves, without meaning it.
struct Slips {
    double near_m;
    double most_m;
};

/// An arc under construction; spikes are removed, because nothing else meets it between its ends.
class Course {
public:
    Course(Slips const& slips, std::int64_t id_shift, import_steps::Left& left)
        : slips_(slips), id_shift_(id_shift), left_(left) {}

    /// Adds the vertex at which a segment of a feature begins.
    void add(Vec2 at, double z, std::int64_t feature) {
        while (line_.size() > 1 && geometry::is_spike(line_[line_.size() - 2], line_.back(), at, slips_.near_m)) {
            Vec2 const tip = line_.back();
            Vec2 const before = line_[line_.size() - 2];
            bool const comes_back = distance(tip, at) <= distance(tip, before); // otherwise it has already turned back
            Vec2 const base = comes_back ? at : before;
            double const back_m = distance(tip, base);
            if (back_m > slips_.most_m) {
                break;
            }
            std::int64_t& of_before = features_[features_.size() - 2]; // of the segment that leads to the tip
            std::int64_t const of_step = comes_back ? features_.back() : of_before;
            of_before = comes_back ? of_before : features_.back();
            std::int64_t const number = of_step - id_shift_;
            left_.repairs.push_back(
                {"cut", number, tip, back_m,
                 fmt::format("river {} steps back by {:.3g} m at ({:.6f}, {:.6f}); the step is removed", number, back_m,
                             tip.x, tip.y)});
            left_.secondary.push_back({of_step,
                                       {{tip.x, tip.y, z_.back()}, {base.x, base.y, z_.back()}},
                                       "steps back",
                                       of_step,
                                       LeftOut::too_short});
            line_.pop_back();
            z_.pop_back();
            features_.pop_back();
        }
        if (!line_.empty() && line_.back() == at) {
            features_.back() = feature;
            return;
        }
        line_.push_back(at);
        z_.push_back(z);
        features_.push_back(feature);
    }
    std::vector<Vec2> const& line() const { return line_; }
    std::vector<double> const& z() const { return z_; }
    std::vector<Stretch> stretches() const {
        std::vector<Stretch> stretches;
        double along_m = 0.0;
        for (std::size_t i = 1; i < line_.size(); ++i) {
            double const from_m = along_m;
            along_m += distance(line_[i - 1], line_[i]);
            if (features_[i - 1] == 0) { // through a lake
                continue;
            }
            if (stretches.empty() || stretches.back().feature != features_[i - 1] || stretches.back().to_m != from_m) {
                stretches.push_back({features_[i - 1], from_m, from_m});
            }
            stretches.back().to_m = along_m;
        }
        return stretches;
    }

private:
    Slips slips_;
    std::int64_t id_shift_;
    import_steps::Left& left_;
    std::vector<Vec2> line_;
    std::vector<double> z_;
    std::vector<std::int64_t> features_;
};

// The longest; of several the most upstream. 0: none.
std::int64_t longest_of(std::vector<Stretch> const& stretches) {
    if (stretches.empty()) {
        return 0;
    }
    return std::ranges::max_element(stretches, {}, [](Stretch const& s) { return s.to_m - s.from_m; })->feature;
}

void add_arcs(ImportedNetwork& imported, Flow const& flow, std::vector<double> const& node_z, bool join,
              Slips const& slips, import_steps::Left& left) {
    auto const inner = join ? vanishing(flow, imported.repairs) : std::vector<char>(flow.leaves.size(), 0);
    auto const heads = [&] {
        std::vector<std::size_t> by_piece; // arcs are numbered in the file's order
        for (std::size_t n = 0; n < flow.leaves.size(); ++n) {
            if (flow.leaves[n] != no_piece && inner[n] == 0) {
                by_piece.push_back(n);
            }
        }
        std::ranges::sort(by_piece, {}, [&](std::size_t n) { return flow.leaves[n]; });
        return by_piece;
    }();
    constexpr NodeId none = std::numeric_limits<NodeId>::max();
    NetworkDraft network;
    std::vector<NodeId> ids(flow.leaves.size(), none);
    auto const node = [&](std::size_t n) {
        if (ids[n] == none) {
            ids[n] = network.add_node(flow.pieces.nodes[n]);
        }
        return ids[n];
    };
    for (std::size_t const head : heads) {
        Arc arc;
        Course course(slips, flow.line(head).id_shift, left);
        std::size_t n = head;
        do {
            arc.type = flow.line(n).type;
            auto const vertices = flow.vertices(n);
            for (std::size_t i = 0; i + 1 < vertices.size(); ++i) {
                course.add({vertices[i].x, vertices[i].y}, i == 0 && !node_z.empty() ? node_z[n] : vertices[i].z,
                           flow.line(n).feature);
            }
            n = flow.downstream(n);
        } while (inner[n] != 0);
        course.add(flow.pieces.nodes[n], node_z.empty() ? 0.0 : node_z[n], 0);
        arc.line = course.line();
        auto stretches = course.stretches();
        arc.feature = longest_of(stretches);
        imported.stretches.push_back(std::move(stretches));
        NodeId const from = node(head);
        network.add_arc(from, node(n), std::move(arc));
        if (!node_z.empty()) {
            imported.arc_z.push_back(course.z());
        }
    }
    imported.network = std::move(network);
}

/// Lines through lakes are not the file's: what is done to them is no repair, and what is left of them no river.
void forget_lake_lines(ImportedNetwork& imported, std::int64_t number) {
    std::erase_if(imported.secondary, [](SecondaryLine const& line) { return line.feature == 0; });
    std::erase_if(imported.repairs, [&](Finding const& f) {
        return f.feature == number && (f.kind == FindingKind("split") || f.kind == FindingKind("reversed") ||
                                       f.kind == FindingKind("secondary") || f.kind == FindingKind("duplicate") ||
                                       f.kind == FindingKind("cut") || f.kind == FindingKind("height"));
    });
}

ImportedNetwork imported_with_lakes(RiverLines const& file, ImportParams const& params, Run const& run) {
    refuse_if<BadParameter>(!(params.snap_m >= 0.0) || !std::isfinite(params.snap_m), "network.import_lines",
                            "snap_m = {}, it is a distance [m] >= 0", params.snap_m);
    refuse_if<BadParameter>(!(params.cell_m >= 0.0) || !std::isfinite(params.cell_m), "network.import_lines",
                            "cell_m = {}, it is a distance [m] >= 0", params.cell_m);
    refuse_unusable(file);
    auto lines = file.lines;
    ImportedNetwork imported;
    auto& repairs = imported.repairs;
    auto const repeats = import_steps::drop_repeats(lines);
    for (std::size_t l = 0; l < lines.size(); ++l) {
        if (repeats[l] > 0) {
            auto const& first = lines[l].vertices.front();
            repairs.push_back(
                {"removed",
                 lines[l].number(),
                 {first.x, first.y},
                 static_cast<double>(repeats[l]),
                 fmt::format("{} repeated vertices of river {} are left out", repeats[l], lines[l].number())});
        }
    }
    double const snap_m = params.snap_m > 0.0 ? params.snap_m : 1e-6 * import_steps::diagonal_of(lines);
    import_steps::Left left{repairs, imported.secondary};
    bool const open = params.snapped == SnappedEnds::open;
    double const same_m = open ? std::min(snap_m, 1e-6 * import_steps::diagonal_of(lines)) : snap_m;
    import_steps::drop_copies(lines, same_m, left, run);
    import_steps::snap(lines, same_m, SnappedEnds::all, left, run);
    if (open && snap_m > same_m) {
        import_steps::snap(lines, snap_m, SnappedEnds::open, left, run);
    }
    refuse_if<BadInput>(lines.empty(), "network.import_lines",
                        "every river in {} is shorter than the snapping distance {} m", file.name, snap_m);
    if (params.cell_m > 0.0) {
        import_steps::drop_near_copies(lines, params.cell_m, left, run);
    }
    run.at(0.2, "adopt");
    import_steps::split(lines, run);
    if (params.cell_m > 0.0 && import_steps::close_gaps(lines, file, params, left, run)) {
        import_steps::split(lines, run);
    }
    bool const crosses_lakes = import_steps::cross_lakes(lines, file, params, left, run);
    if (crosses_lakes) {
        import_steps::split(lines, run);
    }
    run.at(0.7, "adopt");
    double const near_m = std::min(snap_m, 1e-6 * import_steps::diagonal_of(file.lines));
    import_steps::drop_overshoots(lines, slip_in_near * near_m, left);
    auto pieces = import_steps::cut(lines, left);
    auto evidence = import_steps::evidence_of(pieces, lines, file, params.orientation, repairs);
    auto const found = import_steps::find_directions(pieces, lines, params, evidence, run);
    std::vector<PieceId> leaves;
    if (params.divergences == Divergences::error) {
        import_steps::refuse_cycles(pieces, lines, file.name);
        leaves = import_steps::orient(pieces, lines, file, params, evidence, found.runs);
    } else {
        auto divided = import_steps::divide(pieces, lines, file, params.orientation, evidence, found.runs, run);
        leaves = import_steps::orient(pieces, lines, file, params, evidence, found.runs);
        import_steps::drop_unfed(pieces, divided, leaves);
        auto const branches = import_steps::secondary_lines(pieces, divided, lines, repairs);
        imported.secondary.insert(imported.secondary.end(), branches.begin(), branches.end());
    }
    imported.directions = import_steps::review_directions(pieces, lines, found, leaves);
    import_steps::report_turned(pieces, lines, leaves, repairs);
    Flow const flow{pieces, lines, std::move(leaves)};
    if (std::ranges::all_of(flow.leaves, [](PieceId k) { return k == no_piece; })) {
        throw BadInput("network.import_lines",
                       fmt::format("the lines of {} are closed rings: no river runs anywhere", file.name));
    }
    add_arcs(imported, flow, file.has_z ? node_heights(flow, repairs) : std::vector<double>(), params.join,
             {near_m, std::max(slip_in_near * near_m, params.cell_m)}, left);
    if (crosses_lakes) {
        forget_lake_lines(imported, -lines.front().id_shift);
    }
    run.at(1.0, "adopt");
    return imported;
}

// Describes where in the file segment ab of an arc, drawn downstream, rises from za to zb.
std::string uphill(RiverLines const& file, Vec2 a, Vec2 b, double za, double zb) {
    Vec2 const middle{0.5 * (a.x + b.x), 0.5 * (a.y + b.y)};
    double least = INFINITY;
    RiverLine const* river = nullptr;
    std::size_t upper = 0; // vertices of the river, upstream first
    std::size_t lower = 0;
    for (auto const& line : file.lines) {
        for (std::size_t i = 0; i + 1 < line.vertices.size(); ++i) {
            auto const& p = line.vertices[i];
            auto const& q = line.vertices[i + 1];
            double const d = distance(middle, geometry::foot_on({p.x, p.y}, {q.x, q.y}, middle).at);
            if (d < least) {
                least = d;
                river = &line;
                bool const as_drawn = (q.x - p.x) * (b.x - a.x) + (q.y - p.y) * (b.y - a.y) >= 0.0;
                upper = as_drawn ? i : i + 1;
                lower = as_drawn ? i + 1 : i;
            }
        }
    }
    if (river == nullptr) {
        throw BadInput("network.take_file_heights", file.name + " holds no lines");
    }
    double const drawn_upper = river->vertices[upper].z;
    double const drawn_lower = river->vertices[lower].z;
    if (drawn_upper < drawn_lower) { // otherwise the common height of meeting rivers causes the rise
        za = drawn_upper;
        zb = drawn_lower;
    }
    bool const alike = fmt::format("{:.6g}", za) == fmt::format("{:.6g}", zb);
    auto const say = [&](double z) { return alike ? fmt::format("{}", z) : fmt::format("{:.6g}", z); };
    return fmt::format("river {} in {} runs uphill between vertex {} ({} m) and {} ({} m). "
                       "Reverse the line, or leave heights to [network] heights.",
                       river->feature, file.name, upper + 1, say(za), lower + 1, say(zb));
}

} // namespace

ImportedNetwork import_lines(RiverLines const& file, ImportParams const& params, Run const& run) {
    if (file.lakes.empty()) {
        return imported_with_lakes(file, params, run);
    }
    try {
        return imported_with_lakes(file, params, run);
    } catch (BadInput const& cannot) { // by heights, say, a lake that rivers run through has two outflows
        RiverLines bare = file;
        bare.lakes.clear();
        ImportedNetwork imported = imported_with_lakes(bare, params, run);
        imported.repairs.push_back({"lake_left_out", file.lakes.front().feature,
                                    file.lakes.front().rings.front().front(), 0.0,
                                    fmt::format("no river runs through a lake: {}", cannot.what())});
        return imported;
    }
}

ElevatedNetwork take_file_heights(ImportedNetwork const& imported, RiverLines const& file) {
    if (imported.arc_z.size() != imported.network.arc_count()) {
        throw BadInput("network.take_file_heights",
                       "the rivers of " + file.name + " carry no heights; leave heights to [network] heights");
    }
    ElevatedNetwork raised{imported.network, std::vector<double>(imported.network.node_count(), 0.0), imported.arc_z};
    for (std::size_t i = 0; i < imported.network.arc_count(); ++i) {
        auto const& line = imported.network.arc(i).line;
        auto const& z = imported.arc_z[i];
        for (std::size_t v = 0; v + 1 < z.size(); ++v) {
            if (z[v] < z[v + 1]) {
                throw BadInput("network.take_file_heights", uphill(file, line[v], line[v + 1], z[v], z[v + 1]));
            }
        }
        raised.node_z[imported.network.from(i)] = z.front();
        raised.node_z[imported.network.to(i)] = z.back();
    }
    return raised;
}

} // namespace thalweg::network
