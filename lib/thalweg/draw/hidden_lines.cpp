// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>
#include <utility>

#include <thalweg/draw/internal/wireframe.hpp>

namespace thalweg::draw {
namespace {

// Ends of neighbouring sides agree bit for bit; cuts between them need not.
constexpr double rounding = 1e-7;

// Shorter parts, where a line dips below another, would appear as dots.
constexpr double shortest = 1e-3;

Vec2 between(Vec2 a, Vec2 b, double share) {
    return {a.x + (b.x - a.x) * share, a.y + (b.y - a.y) * share};
}

/// A share [0, 1] of a segment.
struct Part {
    double from = 0.0;
    double to = 0.0;
};

/// The highest line so far in every column of the sheet: pieces of lines by x, with gaps.
class Horizon {
public:
    /// The parts of a segment above the horizon or within tolerance below it.
    std::vector<Part> above(Vec2 a, Vec2 b, double tolerance) const {
        bool const turned = b.x < a.x;
        Vec2 const left = turned ? b : a;
        Vec2 const right = turned ? a : b;
        double const width = right.x - left.x;
        std::vector<Part> parts;
        auto const keep = [&](double x0, double x1) {
            Part part{(x0 - left.x) / width, (x1 - left.x) / width};
            if (!parts.empty() && part.from - parts.back().to <= 1e-12) {
                parts.back().to = part.to;
            } else if (part.to > part.from) {
                parts.push_back(part);
            }
        };
        if (width > 0.0) {
            double x = left.x;
            for (std::size_t k = first_after(left.x); k < pieces_.size() && pieces_[k].left.x < right.x; ++k) {
                Piece const& piece = pieces_[k];
                double const x0 = std::max(piece.left.x, left.x);
                double const x1 = std::min(piece.right.x, right.x);
                if (x0 > x) {
                    keep(x, x0);
                }
                double const over0 = height(left, right, x0) - piece.y(x0) + tolerance;
                double const over1 = height(left, right, x1) - piece.y(x1) + tolerance;
                double const cut = x0 + (x1 - x0) * over0 / (over0 - over1); // used only if the signs differ
                if (over0 >= 0.0 && over1 >= 0.0) {
                    keep(x0, x1);
                } else if (over0 >= 0.0) {
                    keep(x0, cut);
                } else if (over1 >= 0.0) {
                    keep(cut, x1);
                }
                x = x1;
            }
            if (x < right.x) {
                keep(x, right.x);
            }
        }
        if (turned) {
            std::reverse(parts.begin(), parts.end());
            for (Part& part : parts) {
                part = {1.0 - part.to, 1.0 - part.from};
            }
        }
        return parts;
    }

    /// Raises the horizon to a segment where the segment is higher.
    void raise(Vec2 a, Vec2 b) {
        Vec2 const left = b.x < a.x ? b : a;
        Vec2 const right = b.x < a.x ? a : b;
        if (!(right.x - left.x > 0.0)) {
            return; // a column without width hides nothing
        }
        std::size_t const first = first_after(left.x);
        std::size_t last = first;
        std::vector<Piece> fresh;
        double risen = left.x; // the segment is the highest from here on, except for the pieces stored in fresh
        auto const add = [&](Vec2 from, Vec2 to) {
            if (to.x > from.x) {
                fresh.push_back({from, to});
            }
        };
        auto const on_segment = [&](double x) { return Vec2{x, height(left, right, x)}; };
        for (; last < pieces_.size() && pieces_[last].left.x < right.x; ++last) {
            Piece const piece = pieces_[last];
            auto const on_piece = [&](double x) { return Vec2{x, piece.y(x)}; };
            double const x0 = std::max(piece.left.x, left.x);
            double const x1 = std::min(piece.right.x, right.x);
            if (piece.left.x < left.x) {
                add(piece.left, on_piece(left.x));
            }
            double const over0 = height(left, right, x0) - piece.y(x0);
            double const over1 = height(left, right, x1) - piece.y(x1);
            double stays_from = x0; // from where the piece remains the horizon
            double stays_to = x1;
            if (over0 > 0.0 && over1 > 0.0) {
                stays_to = x0;
            } else if (over0 > 0.0) {
                stays_from = std::clamp(x0 + (x1 - x0) * over0 / (over0 - over1), x0, x1);
            } else if (over1 > 0.0) {
                stays_to = std::clamp(x0 + (x1 - x0) * over0 / (over0 - over1), x0, x1);
            }
            if (stays_to > stays_from) {
                add(on_segment(risen), on_segment(stays_from));
                add(on_piece(stays_from), on_piece(stays_to));
                risen = stays_to;
            }
            if (piece.right.x > right.x) {
                add(on_segment(risen), right);
                risen = right.x;
                add(on_piece(right.x), piece.right);
            }
        }
        add(on_segment(risen), right);
        pieces_.erase(pieces_.begin() + static_cast<std::ptrdiff_t>(first),
                      pieces_.begin() + static_cast<std::ptrdiff_t>(last));
        pieces_.insert(pieces_.begin() + static_cast<std::ptrdiff_t>(first), fresh.begin(), fresh.end());
    }

private:
    struct Piece {
        Vec2 left;
        Vec2 right;
        double y(double x) const { return height(left, right, x); }
    };
    static double height(Vec2 left, Vec2 right, double x) {
        return x == left.x    ? left.y
               : x == right.x ? right.y
                              : left.y + (right.y - left.y) * ((x - left.x) / (right.x - left.x));
    }
    std::size_t first_after(double x) const {
        return static_cast<std::size_t>(
            std::partition_point(pieces_.begin(), pieces_.end(), [x](Piece const& p) { return p.right.x <= x; }) -
            pieces_.begin());
    }

    std::vector<Piece> pieces_;
};

/// A straight part of a thread within one mesh.
struct Stitch {
    std::size_t thread = 0;
    Vec2 from; ///< column and row
    Vec2 to;
};

/// Cuts threads where they pass between meshes.
std::vector<Stitch> stitches_of(std::vector<Thread> const& threads) {
    std::vector<Stitch> out;
    for (std::size_t t = 0; t < threads.size(); ++t) {
        for (std::size_t i = 1; i < threads[t].size(); ++i) {
            Vec2 const a = threads[t][i - 1];
            Vec2 const b = threads[t][i];
            std::vector<double> cuts{0.0, 1.0};
            auto const cut = [&](double from, double to) {
                for (double k = std::floor(std::min(from, to)) + 1.0; k < std::max(from, to); k += 1.0) {
                    cuts.push_back((k - from) / (to - from));
                }
            };
            cut(a.x, b.x);
            cut(a.y, b.y);
            std::sort(cuts.begin(), cuts.end());
            for (std::size_t k = 1; k < cuts.size(); ++k) {
                if (cuts[k] > cuts[k - 1]) {
                    out.push_back({t, between(a, b, cuts[k - 1]), between(a, b, cuts[k])});
                }
            }
        }
    }
    return out;
}

/// The mesh that contains a point, by its knot of lowest column and row; -1: outside the net.
std::int64_t mesh_of(Net const& net, Vec2 p) {
    auto const along = [](double where, std::int64_t knots) {
        bool const inside = where >= 0.0 && where <= static_cast<double>(knots - 1);
        return inside ? std::min(static_cast<std::int64_t>(where), knots - 2) : std::int64_t{-1};
    };
    std::int64_t const col = along(p.x, net.columns);
    std::int64_t const row = along(p.y, net.rows);
    return col < 0 || row < 0 ? -1 : row * net.columns + col;
}

Vec2 on_mesh(Net const& net, std::int64_t mesh, Vec2 p) {
    std::int64_t const col = mesh % net.columns;
    std::int64_t const row = mesh / net.columns;
    double const x = p.x - static_cast<double>(col);
    double const y = p.y - static_cast<double>(row);
    return between(between(net.knot(col, row), net.knot(col + 1, row), x),
                   between(net.knot(col, row + 1), net.knot(col + 1, row + 1), x), y);
}

/// Processes the net from front to back.
class Weaver {
public:
    Weaver(Net const& net, std::vector<Stitch> const& stitches, double tolerance)
        : net_(net), stitches_(stitches), tolerance_(tolerance), along_row_(net.at.size()), along_col_(net.at.size()),
          seen_stitches_(stitches.size()) {
        for (std::size_t i = 0; i < stitches.size(); ++i) {
            std::int64_t const mesh = mesh_of(net, between(stitches[i].from, stitches[i].to, 0.5));
            if (mesh >= 0) {
                in_mesh_[mesh].push_back(i);
            }
        }
    }

    Seen weave() {
        // A mesh can be hidden only by meshes before it in both directions.
        for (std::int64_t i = 0; i < net_.rows; ++i) {
            std::int64_t const row = net_.away_row > 0 ? i : net_.rows - 1 - i;
            for (std::int64_t k = 0; k < net_.columns; ++k) {
                std::int64_t const col = net_.away_col > 0 ? k : net_.columns - 1 - k;
                std::int64_t const next_row = row + net_.away_row;
                std::int64_t const next_col = col + net_.away_col;
                side({col, row}, {next_col, row});
                side({col, row}, {col, next_row});
                stitch(std::min(col, next_col), std::min(row, next_row));
                side({next_col, row}, {next_col, next_row});
                side({col, next_row}, {next_col, next_row});
            }
        }
        Seen seen;
        for (std::int64_t row = 0; row < net_.rows; ++row) {
            join(seen.net, {0, row}, {1, 0});
        }
        for (std::int64_t col = 0; col < net_.columns; ++col) {
            join(seen.net, {col, 0}, {0, 1});
        }
        join_threads(seen.threads);
        return seen;
    }

private:
    struct Place {
        std::int64_t col = 0;
        std::int64_t row = 0;
    };
    struct Side {
        bool done = false;
        std::vector<Part> parts; ///< from the knot of lower column or row
    };

    bool has(Place p) const {
        return p.col >= 0 && p.row >= 0 && p.col < net_.columns && p.row < net_.rows &&
               is_finite(net_.knot(p.col, p.row));
    }

    void side(Place p, Place q) {
        if (!has(p) || !has(q)) {
            return;
        }
        Place const low = p.col + p.row < q.col + q.row ? p : q;
        Place const high = p.col + p.row < q.col + q.row ? q : p;
        KnotId const number = low.row * net_.columns + low.col;
        Side& known = p.row == q.row ? along_row_[number] : along_col_[number];
        if (!std::exchange(known.done, true)) {
            Vec2 const from = net_.knot(low.col, low.row);
            Vec2 const to = net_.knot(high.col, high.row);
            known.parts = horizon_.above(from, to, rounding);
            double const least = shortest / distance(from, to);
            std::erase_if(known.parts, [least](Part const& part) { return part.to - part.from < least; });
            horizon_.raise(from, to);
        }
    }

    void stitch(std::int64_t col, std::int64_t row) {
        auto const found = in_mesh_.find(row * net_.columns + col);
        if (found == in_mesh_.end() || !has({col, row}) || !has({col + 1, row}) || !has({col, row + 1}) ||
            !has({col + 1, row + 1})) {
            return;
        }
        for (std::size_t const i : found->second) {
            Vec2 const from = on_mesh(net_, found->first, stitches_[i].from);
            Vec2 const to = on_mesh(net_, found->first, stitches_[i].to);
            for (Part const part : horizon_.above(from, to, tolerance_)) {
                seen_stitches_[i].push_back({between(from, to, part.from), between(from, to, part.to)});
            }
        }
    }

    void join(std::vector<std::vector<Vec2>>& lines, Place from, Place step) const {
        bool open = false; // the last line ends at the current knot
        for (Place p = from; has_room(p, step); p = {p.col + step.col, p.row + step.row}) {
            Side const& side = (step.col > 0 ? along_row_ : along_col_)[p.row * net_.columns + p.col];
            bool reached = false;
            for (Part const& part : side.parts) {
                Vec2 const a = net_.knot(p.col, p.row);
                Vec2 const b = net_.knot(p.col + step.col, p.row + step.row);
                if (!(open && part.from <= 0.0 && &part == side.parts.data())) {
                    lines.push_back({between(a, b, part.from)});
                }
                lines.back().push_back(part.to >= 1.0 ? b : between(a, b, part.to));
                reached = part.to >= 1.0;
            }
            open = reached;
        }
    }
    bool has_room(Place p, Place step) const { return p.col + step.col < net_.columns && p.row + step.row < net_.rows; }

    void join_threads(std::vector<SeenThread>& threads) const {
        for (std::size_t i = 0; i < stitches_.size(); ++i) {
            for (auto const& [from, to] : seen_stitches_[i]) {
                bool const goes_on = !threads.empty() && threads.back().thread == stitches_[i].thread &&
                                     distance(threads.back().line.back(), from) < 1e-6;
                if (!goes_on) {
                    threads.push_back({stitches_[i].thread, {from}});
                }
                threads.back().line.push_back(to);
            }
        }
    }

    Net const& net_;
    std::vector<Stitch> const& stitches_;
    double tolerance_;
    Horizon horizon_;
    std::vector<Side> along_row_; ///< the side to the next column
    std::vector<Side> along_col_; ///< the side to the next row
    std::unordered_map<std::int64_t, std::vector<std::size_t>> in_mesh_;
    std::vector<std::vector<std::array<Vec2, 2>>> seen_stitches_;
};

} // namespace

Seen hidden_lines(Net const& net, std::vector<Thread> const& threads, double tolerance) {
    std::vector<Stitch> const stitches = stitches_of(threads);
    return Weaver(net, stitches, tolerance).weave();
}

} // namespace thalweg::draw
