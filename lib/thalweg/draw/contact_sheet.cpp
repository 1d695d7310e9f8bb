// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/draw/contact_sheet.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <cairo.h>

#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/draw/internal/canvas.hpp>
#include <thalweg/draw/internal/map.hpp>

namespace thalweg::draw {
namespace {

constexpr Colour empty_frame{0.955, 0.955, 0.96};
constexpr Colour frame_line{0.62, 0.62, 0.65};
constexpr double tallest_px = 32000.0;

Relief grey_pixels(Raster<std::uint8_t> const& shade) {
    Relief relief;
    relief.width = static_cast<int>(shade.width());
    relief.height = static_cast<int>(shade.height());
    relief.pixels.reserve(static_cast<std::size_t>(shade.cells()));
    for (std::uint8_t const light : shade.values()) {
        double const grey = light > 0 ? static_cast<double>(light) / 255.0 : no_data.red;
        relief.pixels.push_back(packed(grey, grey, grey, 1.0));
    }
    return relief;
}

/// Height over width of the frames: that of the tallest terrain.
double aspect_of(std::vector<Thumbnail> const& thumbnails) {
    double aspect = 0.0;
    for (Thumbnail const& one : thumbnails) {
        if (one.shade.cells() > 0) {
            aspect = std::max(aspect, static_cast<double>(one.shade.height()) / static_cast<double>(one.shade.width()));
        }
    }
    return aspect > 0.0 ? std::clamp(aspect, 0.2, 2.0) : 1.0;
}

void draw_thumbnail(Cairo* canvas, Box frame, Thumbnail const& one, double unit) {
    fill_box(canvas, frame, empty_frame);
    if (one.shade.cells() > 0) {
        auto const cells_wide = static_cast<double>(one.shade.width());
        auto const cells_high = static_cast<double>(one.shade.height());
        double const scale = std::min(frame.width / cells_wide, frame.height / cells_high);
        Box const where{frame.x + 0.5 * (frame.width - scale * cells_wide),
                        frame.y + 0.5 * (frame.height - scale * cells_high), scale * cells_wide, scale * cells_high};
        draw_relief(canvas, grey_pixels(one.shade), where, scale);
    } else {
        draw_text_within(canvas, {frame.x + 0.5 * frame.width, frame.y + 0.5 * frame.height + 0.35 * unit}, one.missing,
                         {1.1 * unit, faint_ink, Weight::normal, 0.0, Slant::italic}, frame.width - unit,
                         Anchor::middle);
    }
    frame_box(canvas, frame, 0.07 * unit, frame_line);
    double y = frame.bottom();
    for (std::size_t i = 0; i < one.words.size(); ++i) {
        y += 1.35 * unit;
        draw_text_within(canvas, {frame.x, y}, one.words[i],
                         {unit, i == 0 ? ink : faint_ink, i == 0 ? Weight::bold : Weight::normal}, frame.width);
    }
}

} // namespace

Picture contact_sheet(std::vector<Thumbnail> const& thumbnails, ContactSheetParams const& params) {
    require_in("draw.contact_sheet", "width_px", params.width_px, Range::between(200, 8000), "pixels");
    auto const count = static_cast<double>(thumbnails.size());
    auto const columns = static_cast<std::size_t>(std::clamp(std::ceil(std::sqrt(1.2 * count)), 4.0, 8.0));
    auto const across = static_cast<double>(columns);
    double const width = params.width_px;
    double const unit = width * (columns > 6 ? 0.0068 : 0.0075);
    double const margin = 1.8 * unit;
    double const gap = 1.4 * unit;
    double const wide = (width - 2.0 * margin - (across - 1.0) * gap) / across;
    double const high = wide * aspect_of(thumbnails);
    std::size_t lines = 0;
    for (Thumbnail const& one : thumbnails) {
        lines = std::max(lines, one.words.size());
    }
    double const row = high + (1.35 * static_cast<double>(lines) + 1.9) * unit;
    double const top = ((params.title.empty() ? 0.0 : 3.6) + (params.note.empty() ? 0.0 : 2.0) + 1.6) * unit;
    std::size_t const rows = (thumbnails.size() + columns - 1) / columns;
    double const height = std::ceil(top + std::max(static_cast<double>(rows) * row, 4.0 * unit));
    refuse_if<BadInput>(height > tallest_px, "draw.contact_sheet",
                        "{} thumbnails make a picture of {:.0f} pixels in height, more than 32000: draw fewer",
                        thumbnails.size(), height);
    return paint(width, height, params.format, [&](Cairo* canvas) {
        double y = 0.0;
        if (!params.title.empty()) {
            y = 2.9 * unit;
            draw_text_within(canvas, {margin, y}, params.title, {1.6 * unit, ink, Weight::bold}, width - 2.0 * margin);
        }
        if (!params.note.empty()) {
            y += 2.0 * unit;
            draw_text_within(canvas, {margin, y}, params.note, {1.1 * unit, faint_ink}, width - 2.0 * margin);
        }
        if (thumbnails.empty()) {
            draw_text(canvas, {margin, top + unit}, "no terrain", {unit, faint_ink});
        }
        for (std::size_t i = 0; i < thumbnails.size(); ++i) {
            std::size_t const rows_above = i / columns;
            double const left = margin + static_cast<double>(i % columns) * (wide + gap);
            double const upper = top + static_cast<double>(rows_above) * row;
            draw_thumbnail(canvas, {left, upper, wide, high}, thumbnails[i], unit);
        }
    });
}

} // namespace thalweg::draw
