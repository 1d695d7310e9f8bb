// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/geometry/meetings.hpp>

#include <algorithm>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/geometry/internal/exact_segments.hpp>
#include <thalweg/geometry/internal/segment_pairs.hpp>

namespace thalweg::geometry {
namespace {

using Lines = std::vector<std::vector<Vec2>>;

bool share_node(Lines const& lines, std::vector<EndNodes> const& nodes, std::size_t line, std::size_t other, Vec2 at) {
    for (std::size_t const end : {0U, 1U}) {
        Vec2 const here = end == 0 ? lines[line].front() : lines[line].back();
        for (std::size_t const other_end : {0U, 1U}) {
            Vec2 const there = other_end == 0 ? lines[other].front() : lines[other].back();
            if (here == at && there == at && nodes[line][end] == nodes[other][other_end]) {
                return true;
            }
        }
    }
    return false;
}

} // namespace

std::vector<Meeting> meetings(Lines const& lines, std::vector<EndNodes> const& nodes, Run const& run) {
    if (nodes.size() != lines.size()) {
        throw BadInput(fmt::format("geometry.meetings: {} polylines but nodes of {}", lines.size(), nodes.size()));
    }
    std::vector<Meeting> found;
    auto const add = [&](LineSegment s, LineSegment t) {
        if (std::tie(t.line, t.segment) < std::tie(s.line, s.segment)) {
            std::swap(s, t);
        }
        Vec2 const a = lines[s.line][s.segment];
        Vec2 const b = lines[s.line][s.segment + 1];
        Vec2 const c = lines[t.line][t.segment];
        Vec2 const d = lines[t.line][t.segment + 1];
        SegmentMeeting meeting = meeting_of(a, b, c, d);
        switch (meeting.kind) {
        case SegmentMeeting::Kind::none: return;
        case SegmentMeeting::Kind::vertex:
            if (s.line == t.line ? s.segment + 1 == t.segment
                                 : share_node(lines, nodes, s.line, t.line, meeting.first)) {
                return;
            }
            break;
        case SegmentMeeting::Kind::proper: meeting.first = meeting.last = crossing_of(a, b, c, d).at; break;
        case SegmentMeeting::Kind::stretch: break;
        }
        found.push_back({s.line, t.line, s.segment, t.segment, meeting.first, meeting.last});
    };
    each_close_pair(lines, add, run);
    std::ranges::sort(found, {},
                      [](Meeting const& m) { return std::tie(m.line, m.other, m.segment, m.other_segment); });
    return found;
}

} // namespace thalweg::geometry
