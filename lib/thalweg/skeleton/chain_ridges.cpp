// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/skeleton/internal/chain_ridges.hpp>

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

namespace thalweg::skeleton {
namespace {

/// What begins and ends at a node.
struct Meeting {
    std::vector<std::size_t> out;
    std::vector<std::size_t> in;
};

std::tuple<double, double> place(Vec3 const& p) {
    return {p.x, p.y};
}

class Chains {
public:
    explicit Chains(std::vector<RidgePiece> pieces) : pieces_(std::move(pieces)), used_(pieces_.size(), 0) {
        for (std::size_t i = 0; i < pieces_.size(); ++i) {
            auto& [from, to, ridge] = pieces_[i];
            if (ridge.left > ridge.right) {
                std::swap(from, to);
                std::swap(ridge.left, ridge.right);
                std::ranges::reverse(ridge.line);
            }
            meetings_[from].out.push_back(i);
            meetings_[to].in.push_back(i);
        }
    }

    RidgeLines take() {
        RidgeLines ridges;
        for (std::size_t i = 0; i < pieces_.size(); ++i) {
            if (!runs_through(pieces_[i].from)) {
                ridges.lines.push_back(from(i));
            }
        }
        // What is left are closed lines.
        std::vector<std::size_t> order(pieces_.size());
        for (std::size_t i = 0; i < order.size(); ++i) {
            order[i] = i;
        }
        std::ranges::sort(order, {}, [&](std::size_t i) { return place(pieces_[i].ridge.line.front()); });
        for (std::size_t const i : order) {
            if (used_[i] == 0) {
                ridges.lines.push_back(from(i));
            }
        }
        std::ranges::sort(ridges.lines, {}, [](RidgeLine const& r) {
            return std::tuple(r.left, r.right, place(r.line.front()), place(r.line[1]));
        });
        return ridges;
    }

private:
    bool runs_through(std::size_t node) const {
        auto const& [out, in] = meetings_.at(node);
        return out.size() == 1 && in.size() == 1 && pieces_[out.front()].ridge.left == pieces_[in.front()].ridge.left &&
               pieces_[out.front()].ridge.right == pieces_[in.front()].ridge.right;
    }

    RidgeLine from(std::size_t i) {
        RidgeLine line = pieces_[i].ridge;
        used_[i] = 1;
        while (runs_through(pieces_[i].to)) {
            i = meetings_.at(pieces_[i].to).out.front();
            if (used_[i] != 0) {
                break;
            }
            used_[i] = 1;
            auto const& more = pieces_[i].ridge.line;
            line.line.insert(line.line.end(), more.begin() + 1, more.end());
        }
        return line;
    }

    std::vector<RidgePiece> pieces_;
    std::vector<char> used_;
    std::map<std::size_t, Meeting> meetings_;
};

} // namespace

RidgeLines chain_ridges(std::vector<RidgePiece> pieces) {
    return Chains(std::move(pieces)).take();
}

} // namespace thalweg::skeleton
