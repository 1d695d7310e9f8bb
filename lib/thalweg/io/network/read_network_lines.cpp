// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/network/internal/read_network_lines.hpp>

#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <ogr_geometry.h>

namespace thalweg::io {

namespace {

std::vector<Vec3> vertices_of(OGRLineString const& line) {
    bool const has_z = line.Is3D() != 0;
    std::vector<Vec3> vertices;
    vertices.reserve(static_cast<std::size_t>(line.getNumPoints()));
    for (int i = 0; i < line.getNumPoints(); ++i) {
        vertices.push_back(
            {line.getX(i), line.getY(i), has_z ? line.getZ(i) : std::numeric_limits<double>::quiet_NaN()});
    }
    return vertices;
}

// Adds the parts that are lines.
void add_parts(OGRGeometry const& shape, std::int64_t feature, std::vector<std::vector<Vec3>>& parts,
               OtherShapes& others) {
    auto const flat = wkbFlatten(shape.getGeometryType());
    if (flat == wkbLineString) {
        if (shape.IsEmpty() == 0) {
            parts.push_back(vertices_of(*shape.toLineString()));
        }
        return;
    }
    if (flat != wkbMultiLineString && flat != wkbGeometryCollection) {
        others.add(shape, feature);
        return;
    }
    for (auto const* const part : *shape.toGeometryCollection()) {
        add_parts(*part, feature, parts, others);
    }
}

using Place = std::pair<double, double>;

Place begin_of(std::vector<Vec3> const& part) {
    return {part.front().x, part.front().y};
}

Place end_of(std::vector<Vec3> const& part) {
    return {part.back().x, part.back().y};
}

// The parts one after the other, each beginning where the last ends; empty when there is no such order, or several.
std::vector<std::size_t> order_of(std::vector<std::vector<Vec3>> const& parts) {
    std::map<Place, std::size_t> begins;
    std::map<Place, std::size_t> ends;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        bool const placed = std::isfinite(begin_of(parts[i]).first) && std::isfinite(begin_of(parts[i]).second) &&
                            std::isfinite(end_of(parts[i]).first) && std::isfinite(end_of(parts[i]).second);
        if (!placed || !begins.emplace(begin_of(parts[i]), i).second || !ends.emplace(end_of(parts[i]), i).second) {
            return {};
        }
    }
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < parts.size() && order.empty(); ++i) {
        if (!ends.contains(begin_of(parts[i]))) {
            order.push_back(i);
        }
    }
    while (!order.empty() && order.size() < parts.size()) {
        auto const next = begins.find(end_of(parts[order.back()]));
        if (next == begins.end()) {
            return {};
        }
        order.push_back(next->second);
    }
    return order;
}

void join(std::vector<std::vector<Vec3>>& parts) {
    auto const order = order_of(parts);
    if (order.empty()) {
        return;
    }
    std::vector<Vec3> line = std::move(parts[order.front()]);
    for (std::size_t k = 1; k < order.size(); ++k) {
        auto const& part = parts[order[k]];
        line.insert(line.end(), part.begin() + 1, part.end());
    }
    parts.clear();
    parts.push_back(std::move(line));
}

} // namespace

void OtherShapes::add(OGRGeometry const& shape, std::int64_t feature) {
    Type& type = types_[OGRGeometryTypeToName(wkbFlatten(shape.getGeometryType()))];
    if (type.count++ == 0) {
        OGREnvelope box;
        shape.getEnvelope(&box);
        type.first = feature;
        type.where = box.IsInit() != 0 ? Vec2{box.MinX, box.MinY} : Vec2{};
    }
}

std::int64_t OtherShapes::count() const {
    std::int64_t count = 0;
    for (auto const& [name, type] : types_) {
        count += type.count;
    }
    return count;
}

std::vector<Finding> OtherShapes::findings() const {
    std::vector<Finding> findings;
    for (auto const& [name, type] : types_) {
        findings.push_back(
            {"not_a_line", 0, type.where, static_cast<double>(type.count),
             type.count == 1
                 ? fmt::format("1 shape of type {} is not a line and is skipped; it is in feature {}", name, type.first)
                 : fmt::format("{} shapes of type {} are not lines and are skipped; the first is in feature {}",
                               type.count, name, type.first)});
    }
    return findings;
}

DrawnLine drawn_line(OGRGeometry const* shape, std::int64_t feature, OtherShapes& others) {
    DrawnLine line;
    if (shape == nullptr) {
        line.parts.emplace_back();
        return line;
    }
    std::unique_ptr<OGRGeometry> straight;
    line.curved = shape->hasCurveGeometry(TRUE) != 0;
    if (shape->hasCurveGeometry(FALSE) != 0) { // also of types for curves that hold straight parts alone
        straight.reset(shape->getLinearGeometry());
        shape = straight.get();
    }
    std::int64_t const before = others.count();
    add_parts(*shape, feature, line.parts, others);
    line.is_line = !line.parts.empty() || others.count() == before;
    if (!line.is_line) {
        return line;
    }
    line.has_z = shape->Is3D() != 0 && !line.parts.empty();
    line.has_m = shape->IsMeasured() != 0;
    line.drawn_parts = static_cast<int>(line.parts.size());
    if (line.parts.size() > 1) {
        join(line.parts);
    }
    if (line.parts.empty()) {
        line.parts.emplace_back();
    }
    return line;
}

} // namespace thalweg::io
