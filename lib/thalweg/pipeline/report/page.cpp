// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/report/internal/page.hpp>

#include <thalweg/io/gdal/packed.hpp>
#include <thalweg/pipeline/report/internal/page_template.hpp>

#include <nlohmann/json.hpp>

namespace thalweg::pipeline {

namespace {

/// A text with all that is no UTF-8 replaced.
std::string as_utf8(std::string const& text) {
    using nlohmann::json;
    return json::parse(json(text).dump(-1, ' ', false, json::error_handler_t::replace)).get<std::string>();
}

std::string html_text(std::string const& text) {
    std::string out;
    for (char const c : text) {
        switch (c) {
        case '&': out += "&amp;"; break;
        case '<': out += "&lt;"; break;
        case '>': out += "&gt;"; break;
        case '"': out += "&quot;"; break;
        case '\'': out += "&#39;"; break;
        default: out += c;
        }
    }
    return out;
}

/// The arcs by number, then the ridges.
PageLines lines_of(StreamNetwork const& plan, RidgeLines const& ridges, Grid const& grid) {
    std::vector<std::vector<Vec2>> ridges_in_plan;
    for (RidgeLine const& ridge : ridges.lines) {
        auto& line = ridges_in_plan.emplace_back();
        for (Vec3 const& p : ridge.line) {
            line.push_back({p.x, p.y});
        }
    }
    std::vector<std::span<Vec2 const>> lines;
    for (ArcId arc = 0; arc < plan.arc_count(); ++arc) {
        lines.emplace_back(plan.arc(arc).line);
    }
    lines.insert(lines.end(), ridges_in_plan.begin(), ridges_in_plan.end());
    return page_lines(lines, grid);
}

} // namespace

std::string page(Made const& made, PageParams const& params, Run const& run) {
    std::optional<PageHeights> const heights =
        made.terrain.surface ? page_heights(made.terrain.surface->dem, run) : std::nullopt;
    run.check();
    PageLines const lines = lines_of(made.terrain.network.plan, made.terrain.ridges, made.terrain.grid);
    PageParts parts;
    parts.title = html_text(as_utf8(title_of(made.recipe)));
    parts.data = page_data(made, params, heights, lines);
    parts.heights = heights ? io::packed(heights->bytes) : "";
    parts.lines = io::packed(lines.bytes);
    return fill_page(page_template(), parts);
}

} // namespace thalweg::pipeline
