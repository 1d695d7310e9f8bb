// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/growth/tokunaga/lsystem.hpp>

#include <algorithm>
#include <cstdlib>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/indexed.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/parameters.hpp>

namespace thalweg::network {

namespace {

/// Reads a word sign by sign.
class Reader {
public:
    explicit Reader(std::string_view word) : word_(word) {}

    TokunagaTree read() {
        for (at_ = 0; at_ < word_.size(); ++at_) {
            take(word_[at_]);
        }
        if (!open_.empty()) {
            refuse(open_.back().at, "this [ is not closed; add a ]");
        }
        finish_stream();
        return {.links = ordered(), .link_length = 1.0};
    }

private:
    struct Open {
        std::size_t at; ///< of its [
        LinkId link;    ///< at whose upper end it stands
    };

    [[noreturn]] static void refuse(std::size_t at, std::string const& what) {
        throw BadInput(fmt::format("network.read_lsystem: at position {}: {}", at + 1, what));
    }

    void take(char sign) {
        switch (sign) {
        case ' ':
        case '\t':
        case '\n':
        case '\r': return;
        case '+':
        case '-':
            turn_ += sign == '+' ? 1 : -1;
            if (turn_ < -2 || turn_ > 2) {
                refuse(at_, "a turn of more than two; write at most ++ or --");
            }
            return;
        case 'F':
        case 'G': draw(sign); return;
        case '[':
            if (here_ < 0 || here_is_new_ || turn_ != 0) {
                refuse(at_, "[ must stand behind a link; write F or G before it");
            }
            open_.push_back({at_, here_});
            here_is_new_ = true;
            return;
        case ']':
            if (open_.empty()) {
                refuse(at_, "] without a [; remove it");
            }
            finish_stream();
            here_ = open_.back().link;
            here_is_new_ = false;
            open_.pop_back();
            return;
        default: refuse(at_, fmt::format("'{}' is not one of F G + - [ ]", sign));
        }
    }

    void draw(char sign) {
        bool const branch = here_is_new_ && here_ >= 0;
        if (here_ < 0 && !links_.empty()) {
            refuse(at_, "a second network; write one word");
        }
        if (here_ < 0 && turn_ != 0) {
            refuse(at_, "the first link cannot turn; remove + and -");
        }
        if (here_ >= 0) {
            auto& [link, source, branches, place] = links_[here_];
            if (source) {
                refuse(at_, "nothing can stand above a G; write F");
            }
            if (branches == 2) {
                refuse(at_, "a third link above the same F; a junction joins two");
            }
            if (!branch && branches == 0) {
                refuse(at_, "a link straight above another; give the lower one a branch");
            }
            if (branch == (turn_ == 0)) {
                refuse(at_,
                       branch ? "a branch must turn; write + or - before it" : "only a branch can turn; put it in [ ]");
            }
            link.up[branches++] = links_.count();
        }
        links_.push_back({{.down = here_, .turn = turn_}, sign == 'G', 0, at_});
        here_ = links_.count() - 1;
        here_is_new_ = false;
        turn_ = 0;
    }

    void finish_stream() const {
        if (here_ < 0 || here_is_new_) {
            refuse(at_, "a link is missing; write F or G");
        }
        if (turn_ != 0) {
            refuse(at_ - 1, "a turn without a link behind it");
        }
        if (!links_[here_].source && links_[here_].branches != 2) {
            refuse(links_[here_].at, "above this F are not two links; write G for a source");
        }
    }

    Indexed<LinkId, TreeLink> ordered() const {
        Indexed<LinkId, TreeLink> out;
        for (Drawn const& drawn : links_) {
            out.push_back(drawn.link);
        }
        for (std::size_t i = out.size(); i-- > 0;) {
            TreeLink& link = out[i];
            if (link.up[0] >= 0) {
                TreeLink const& first = out[link.up[0]];
                TreeLink const& second = out[link.up[1]];
                link.order = std::max({first.order, second.order, std::min(first.order, second.order) + 1});
                if (second.order > first.order || (second.order == first.order && second.turn == 0)) {
                    std::swap(link.up[0], link.up[1]);
                }
            }
        }
        return out;
    }

    struct Drawn {
        TreeLink link;
        bool source = false;
        std::size_t branches = 0;
        std::size_t at = 0;
    };

    std::string_view word_;
    std::size_t at_ = 0;
    Indexed<LinkId, Drawn> links_;
    std::vector<Open> open_;
    LinkId here_ = -1;
    bool here_is_new_ = true; ///< a branch has been opened here and has no link yet
    int turn_ = 0;
};

} // namespace

std::string write_lsystem(TokunagaTree const& tree) {
    std::string word;
    // What is still to be written, the next last: a link, or -1 for the end of a branch.
    std::vector<LinkId> ahead{0};
    while (!ahead.empty()) {
        LinkId const number = ahead.back();
        ahead.pop_back();
        if (number < 0) {
            word += ']';
            continue;
        }
        TreeLink const& link = tree.links[number];
        if (link.turn != 0) {
            word += '[';
            word.append(static_cast<std::size_t>(std::abs(link.turn)), link.turn > 0 ? '+' : '-');
        }
        word += link.up[0] < 0 ? 'G' : 'F';
        if (link.turn != 0) {
            ahead.push_back(-1);
        }
        if (link.up[0] >= 0) {
            auto [first, second] = link.up;
            if (tree.links[first].turn == 0 || (tree.links[second].turn != 0 && second < first)) {
                std::swap(first, second);
            }
            ahead.push_back(second);
            ahead.push_back(first);
        }
    }
    return word;
}

std::string lsystem(TokunagaParams const& params, Run const& run) {
    return write_lsystem(grow_tokunaga(params, run));
}

TokunagaTree read_lsystem(std::string_view word) {
    return Reader(word).read();
}

std::vector<std::vector<Vec2>> draw_turtle(TokunagaTree const& tree, TurtleParams const& params) {
    require_in("network.draw_turtle", "delta_deg", params.delta_deg, Range::between(0.0, 90.0));
    if (!(params.link_m > 0.0)) {
        throw BadParameter(fmt::format("network.draw_turtle: link_m is {}, it must be above 0", double{params.link_m}));
    }
    double const delta = params.delta_deg / 180.0 * portable::pi;
    Indexed<LinkId, int> turns(tree.links.size(), 0);
    Indexed<LinkId, std::vector<Vec2>> lines;
    for (std::size_t i = 0; i < tree.links.size(); ++i) {
        TreeLink const& link = tree.links[i];
        Vec2 const from = link.down < 0 ? Vec2{} : lines[link.down].back();
        turns[i] = link.turn + (link.down < 0 ? 0 : turns[link.down]);
        double const angle = delta * turns[i];
        lines.push_back(
            {from, {from.x - params.link_m * portable::sin(angle), from.y + params.link_m * portable::cos(angle)}});
    }
    return lines;
}

} // namespace thalweg::network
