// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/report/internal/page.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>

namespace thalweg::pipeline {

namespace {

struct Place {
    std::size_t at;
    std::string_view marker;
    std::string const* part;
};

std::size_t find_once(std::string_view page, std::string_view marker) {
    std::size_t const at = page.find(marker);
    if (at == std::string_view::npos || page.find(marker, at + 1) != std::string_view::npos) {
        throw std::logic_error(fmt::format("pipeline.fill_page: the page holds {} {}; rebuild web/dist/report.html",
                                           at == std::string_view::npos ? "no" : "more than one", marker));
    }
    return at;
}

} // namespace

std::string fill_page(std::string_view page, PageParts const& parts) {
    std::array<Place, 4> places{{{0, "@@TITLE@@", &parts.title},
                                 {0, "@@DATA@@", &parts.data},
                                 {0, "@@HEIGHTS@@", &parts.heights},
                                 {0, "@@LINES@@", &parts.lines}}};
    std::size_t size = page.size();
    for (Place& place : places) {
        place.at = find_once(page, place.marker);
        size += place.part->size();
    }
    std::sort(places.begin(), places.end(), [](Place const& a, Place const& b) { return a.at < b.at; });
    std::string out;
    out.reserve(size);
    std::size_t done = 0;
    for (Place const& place : places) {
        out += page.substr(done, place.at - done);
        out += *place.part;
        done = place.at + place.marker.size();
    }
    out += page.substr(done);
    return out;
}

} // namespace thalweg::pipeline
