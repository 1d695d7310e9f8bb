// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/geometry/crossings.hpp>

#include <algorithm>
#include <tuple>

#include <thalweg/geometry/internal/exact_segments.hpp>
#include <thalweg/geometry/internal/segment_pairs.hpp>

namespace thalweg::geometry {
namespace {

using Lines = std::vector<std::vector<Vec2>>;

// Whether the two follow one another in their line: nothing but repeated vertices lies between.
bool are_neighbours(Lines const& lines, LineSegment s, LineSegment t) {
    if (s.line != t.line) {
        return false;
    }
    auto const& line = lines[s.line];
    std::size_t const last = std::max(s.segment, t.segment);
    std::size_t v = std::min(s.segment, t.segment) + std::size_t{1};
    while (v < last && line[v] == line[v + 1]) {
        ++v;
    }
    return v == last;
}

class Meetings {
public:
    explicit Meetings(Lines const& lines) : lines_(lines) {}

    void add(LineSegment s, LineSegment t) {
        Vec2 const a = lines_[s.line][s.segment];
        Vec2 const b = lines_[s.line][s.segment + 1];
        Vec2 const c = lines_[t.line][t.segment];
        Vec2 const d = lines_[t.line][t.segment + 1];
        SegmentMeeting const meeting = meeting_of(a, b, c, d);
        switch (meeting.kind) {
        case SegmentMeeting::Kind::none: break;
        case SegmentMeeting::Kind::vertex:
            if (!are_neighbours(lines_, s, t)) {
                add_vertex(s, t, meeting.first);
            }
            break;
        case SegmentMeeting::Kind::stretch:
            add_vertex(s, t, meeting.first);
            add_vertex(s, t, meeting.last);
            break;
        case SegmentMeeting::Kind::proper:
            ProperCrossing const crossing = crossing_of(a, b, c, d);
            found_.push_back({s.line, s.segment, crossing.on_ab, crossing.at});
            found_.push_back({t.line, t.segment, crossing.on_cd, crossing.at});
            break;
        }
    }

    std::vector<Crossing> sorted() {
        // Places that round alike are told apart by how far along the segment's own direction they lie.
        auto const key = [&](Crossing const& c) {
            Vec2 const a = lines_[c.line][c.segment];
            Vec2 const b = lines_[c.line][c.segment + 1];
            return std::tuple(c.line, c.segment, c.along, b.x < a.x ? -c.at.x : c.at.x, b.y < a.y ? -c.at.y : c.at.y);
        };
        std::ranges::sort(found_, {}, key);
        found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
        return std::move(found_);
    }

private:
    void add_vertex(LineSegment s, LineSegment t, Vec2 p) {
        for (LineSegment const of : {s, t}) {
            auto const& line = lines_[of.line];
            found_.push_back({of.line, of.segment, place_on(line[of.segment], line[of.segment + 1], p), p});
        }
    }

    Lines const& lines_;
    std::vector<Crossing> found_;
};

} // namespace

std::vector<Crossing> crossings(Lines const& lines, Run const& run) {
    Meetings meetings(lines);
    each_close_pair(
        lines, [&](LineSegment s, LineSegment t) { meetings.add(s, t); }, run);
    return meetings.sorted();
}

} // namespace thalweg::geometry
