// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/growth/tokunaga/internal/join_links.hpp>

#include <algorithm>
#include <utility>

#include <thalweg/core/numbers/index.hpp>

namespace thalweg::network {

namespace {} // namespace

KeptNetwork join_links(Forest const& forest, std::vector<Vec2> const& at, std::vector<std::uint8_t> const& stays) {
    std::size_t const links = at.size();
    std::vector<int> arrivals(links, 0);
    for (std::size_t i = 0; i < links; ++i) {
        if (stays[i] != 0 && forest.links[i].down >= 0) {
            ++arrivals[as_index(forest.links[i].down)];
        }
    }
    KeptNetwork kept;
    std::vector<NodeId> node(links);
    std::vector<NodeId> mouth(forest.shares.size());
    std::vector<std::uint8_t> has_mouth(forest.shares.size(), 0);
    struct Course {
        std::vector<Vec2> line; ///< upstream
        std::vector<std::int64_t> links;
        NodeId to = 0;
    };
    std::vector<Course> open(links); ///< by link: the course that has come up to its node
    for (std::size_t i = 0; i < links; ++i) {
        if (stays[i] == 0) {
            continue;
        }
        ForestLink const& link = forest.links[i];
        Course course;
        if (link.down >= 0 && arrivals[as_index(link.down)] == 1) {
            course = std::move(open[as_index(link.down)]);
        } else if (link.down >= 0) {
            course = {{at[as_index(link.down)]}, {}, node[as_index(link.down)]};
        } else {
            if (has_mouth[link.tree] == 0) {
                mouth[link.tree] = kept.network.add_node(forest.shares[link.tree].mouth);
                has_mouth[link.tree] = 1;
            }
            course = {{forest.shares[link.tree].mouth}, {}, mouth[link.tree]};
        }
        course.line.push_back(at[i]);
        course.links.push_back(static_cast<std::int64_t>(i));
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
