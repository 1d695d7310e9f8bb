// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/vec.hpp>

class OGRGeometry;

/// What is drawn as an arc. Private to this module.
namespace thalweg::io {

/// Counts the shapes of a layer that are not lines.
class OtherShapes {
public:
    void add(OGRGeometry const& shape, std::int64_t feature);
    /// How many there are.
    std::int64_t count() const;
    /// One for each type of shape: not_a_line [shapes], at the first of them.
    std::vector<Finding> findings() const;

private:
    struct Type {
        std::int64_t count = 0;
        std::int64_t first = 0; ///< feature
        Vec2 where;
    };
    std::map<std::string, Type> types_;
};

struct DrawnLine {
    bool is_line = true;                  ///< else the rest is empty
    std::vector<std::vector<Vec3>> parts; ///< one when they join end to end; z is NaN without heights
    int drawn_parts = 0;                  ///< as they stand in the file
    bool has_z = false;
    bool has_m = false;
    bool curved = false;
};

/// Takes: any geometry, or none (nullptr), which is a line without vertices. Shapes in it that are not lines go to
/// others; is_line is false where there is nothing else.
DrawnLine drawn_line(OGRGeometry const* shape, std::int64_t feature, OtherShapes& others);

} // namespace thalweg::io
