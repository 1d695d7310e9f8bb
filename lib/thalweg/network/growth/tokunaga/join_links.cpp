// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/growth/tokunaga/internal/embed_tree.hpp>

#include <algorithm>
#include <utility>

namespace thalweg::network {

namespace {} // namespace

KeptNetwork join_links(Forest const& forest, Indexed<LinkId, Vec2> const& at,
                       Indexed<LinkId, std::uint8_t> const& stays) {
    std::size_t const links = at.size();
    Indexed<LinkId, int> arrivals(links, 0);
    for (std::size_t i = 0; i < links; ++i) {
        if (stays[i] != 0 && forest.links[i].down >= 0) {
            ++arrivals[forest.links[i].down];
        }
    }
    KeptNetwork kept;
    Indexed<LinkId, NodeId> node(links);
    std::vector<NodeId> mouth(forest.shares.size());
    std::vector<std::uint8_t> has_mouth(forest.shares.size(), 0);
    struct Course {
        std::vector<Vec2> line; ///< upstream
        std::vector<LinkId> links;
        NodeId to = 0;
    };
    Indexed<LinkId, Course> open(links); ///< the course that has come up to its node
    for (std::size_t i = 0; i < links; ++i) {
        if (stays[i] == 0) {
            continue;
        }
        ForestLink const& link = forest.links[i];
        Course course;
        if (link.down >= 0 && arrivals[link.down] == 1) {
            course = std::move(open[link.down]);
        } else if (link.down >= 0) {
            course = {{at[link.down]}, {}, node[link.down]};
        } else {
            if (has_mouth[link.tree] == 0) {
                mouth[link.tree] = kept.network.add_node(forest.shares[link.tree].mouth);
                has_mouth[link.tree] = 1;
            }
            course = {{forest.shares[link.tree].mouth}, {}, mouth[link.tree]};
        }
        course.line.push_back(at[i]);
        course.links.push_back(static_cast<LinkId>(i));
        if (arrivals[i] == 1) {
            open[i] = std::move(course);
            continue;
        }
        node[i] = kept.network.add_node(at[i]);
        std::reverse(course.line.begin(), course.line.end());
        std::reverse(course.links.begin(), course.links.end());
        Arc arc;
        arc.line = std::move(course.line);
        kept.network.add_arc(node[i], course.to, std::move(arc));
        kept.links_of_arc.push_back(std::move(course.links));
    }
    return kept;
}

} // namespace thalweg::network
