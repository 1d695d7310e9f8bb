// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/ensemble/draw_ensemble.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <thalweg/core/run/messages.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/draw/contact_sheet.hpp>
#include <thalweg/ensemble/internal/ensemble_page.hpp>
#include <thalweg/io/raster/dem_derivatives.hpp>
#include <thalweg/io/raster/read_drawable.hpp>
#include <thalweg/make/laws.hpp>
#include <thalweg/make/relief.hpp>
#include <thalweg/recipe/recipe.hpp>

namespace thalweg::ensemble {
namespace {

namespace fs = std::filesystem;

/// What is known of an index by its key.
struct KnownIndex {
    std::string_view name;
    std::string_view unit;
    std::optional<std::pair<double, double>> range;
};

struct NamedIndex {
    std::string_view key;
    KnownIndex known;
};

std::vector<NamedIndex> known_laws() {
    std::vector<NamedIndex> known;
    for (make::LawRow const& row : make::law_rows({})) {
        KnownIndex one{row.name, row.unit, {}};
        if (row.nature != nullptr) {
            one.range = {row.nature->low, row.nature->high};
        }
        known.push_back({row.key, one});
    }
    return known;
}

std::vector<NamedIndex> known_counts() {
    return {{"arcs", {"reaches", "", {}}},
            {"outlets", {"outlets", "", {}}},
            {"strahler", {"highest Strahler order", "", {}}},
            {"length_m", {"length of all rivers", "m", {}}}};
}

std::vector<NamedIndex> known_relief() {
    std::vector<NamedIndex> known;
    make::TerrainRelief nothing;
    nothing.perched = 0; // it has a row where there are rivers
    for (make::ReliefRow const& row : make::relief_rows(nothing)) {
        KnownIndex one{row.name, row.unit, {}};
        if (row.range) {
            one.range = {row.range->low, row.range->high};
        }
        known.push_back({row.key, one});
    }
    return known;
}

std::vector<NamedIndex> known_statistics() {
    return {{"mean", {"mean height", "m", {}}},
            {"std", {"standard deviation of heights", "m", {}}},
            {"min", {"lowest cell", "m", {}}},
            {"max", {"highest cell", "m", {}}},
            {"slope_rad", {"slope on cells of 1 m, mean", "rad", {}}},
            {"slope_true_deg", {"slope, mean, central differences", "°", {}}},
            {"skew", {"skewness of heights", "", {}}},
            {"kurtosis", {"excess kurtosis of heights", "", {}}},
            {"roughness_m", {"difference of neighbours, mean", "m", {}}},
            {"lx_cells", {"correlation length along rows", "cells", {}}},
            {"lx_extrapolated", {"correlation length along rows extrapolated: 1", "", {}}},
            {"ly_cells", {"correlation length along columns", "cells", {}}},
            {"ly_extrapolated", {"correlation length along columns extrapolated: 1", "", {}}},
            {"dimension", {"fractal dimension, lags 1 to 5", "", {}}},
            {"dimension_dyadic", {"fractal dimension, lags doubled", "", {}}},
            {"hypsometric_integral", {"hypsometric integral", "", {}}},
            {"pit_cells", {"cells in pits", "", {}}},
            {"pit_volume_m3", {"volume of pits", "m³", {}}}};
}

struct Family {
    std::string_view prefix;
    char const* group;
    std::vector<NamedIndex> known;
};

bool has_numbers(std::vector<double> const& values) {
    return std::any_of(values.begin(), values.end(), [](double value) { return !std::isnan(value); });
}

bool are_equal(std::vector<double> const& values) {
    std::set<double> seen;
    for (double const value : values) {
        if (!std::isnan(value)) {
            seen.insert(value);
        }
    }
    return seen.size() == 1 && values.size() > 1;
}

/// The indices of a table by family, and notes on the columns left out.
void add_indices(EnsembleView& view) {
    std::vector<Family> const families = {{"rivers.", "Rivers as drawn", known_counts()},
                                          {"law.", "Rivers as drawn", known_laws()},
                                          {"dem_law.", "Rivers extracted from the DEM", known_laws()},
                                          {"relief.", "Relief", known_relief()},
                                          {"dem.", "Heights", known_statistics()}};
    std::vector<std::string> empty;
    std::vector<std::string> equal;
    for (Family const& family : families) {
        for (MeasureColumn const& column : view.table.measures) {
            if (!column.name.starts_with(family.prefix)) {
                continue;
            }
            std::string const key = column.name.substr(family.prefix.size());
            auto const known = std::find_if(family.known.begin(), family.known.end(),
                                            [&](NamedIndex const& index) { return index.key == key; });
            bool const is_known = known != family.known.end();
            bool const has_range = is_known && known->known.range;
            bool const twice = family.prefix == "dem." &&
                               std::any_of(view.table.measures.begin(), view.table.measures.end(),
                                           [&](MeasureColumn const& other) { return other.name == "relief." + key; });
            if (!has_numbers(column.values)) {
                empty.push_back(column.name);
            } else if (!has_range && are_equal(column.values)) {
                equal.push_back(column.name);
            } else if (!twice) {
                draw::Distribution index;
                index.name = is_known ? std::string(known->known.name) : key;
                index.unit = is_known ? std::string(known->known.unit) : "";
                index.values = column.values;
                index.group = family.group;
                if (has_range) {
                    index.low = known->known.range->first;
                    index.high = known->known.range->second;
                }
                view.indices.push_back(std::move(index));
            }
        }
    }
    if (!empty.empty()) {
        view.findings.push_back(
            {.kind = "columns_left_out",
             .amount = static_cast<double>(empty.size()),
             .text = fmt::format("left out, as no member has a number: {}", fmt::join(empty, ", "))});
    }
    if (!equal.empty()) {
        view.findings.push_back(
            {.kind = "columns_left_out",
             .amount = static_cast<double>(equal.size()),
             .text = fmt::format("left out, as all members have the same number: {}", fmt::join(equal, ", "))});
    }
}

/// A varied key; nothing: it has one value, or is one of many words.
std::optional<DrawnKey> varied_key(MembersTable const& table, std::size_t key) {
    constexpr std::size_t most_words = 8;
    DrawnKey found;
    std::vector<double> numbers;
    std::vector<double> words;
    bool are_numbers = true;
    for (DrawnMember const& member : table.members) {
        std::string const& text = member.values[key];
        numbers.push_back(plain_number(text));
        are_numbers = are_numbers && (text.empty() || !std::isnan(numbers.back()));
        auto const known = std::find(found.words.begin(), found.words.end(), text);
        words.push_back(text.empty() ? numbers.back() : static_cast<double>(known - found.words.begin()));
        if (!text.empty() && known == found.words.end() && found.words.size() <= most_words) {
            found.words.push_back(text);
        }
    }
    found.values.name = table.keys[key];
    found.values.unit = unit_of_key(table.keys[key]);
    found.values.values = are_numbers ? numbers : words;
    if (!has_numbers(found.values.values) || are_equal(found.values.values) ||
        (!are_numbers && found.words.size() > most_words)) {
        return std::nullopt;
    }
    if (are_numbers) {
        found.words.clear();
    }
    return found;
}

std::int64_t members_of_status(MembersTable const& table, DrawnStatus status) {
    return std::count_if(table.members.begin(), table.members.end(),
                         [&](DrawnMember const& member) { return member.status == status; });
}

std::string short_number(double value) {
    return fmt::format("{:.4g}", value);
}

EnsembleView view_of(MembersTable table, std::string title) {
    EnsembleView view;
    view.title = std::move(title);
    view.table = std::move(table);
    add_indices(view);
    std::int64_t const failed = members_of_status(view.table, DrawnStatus::failed);
    std::int64_t const doubtful = members_of_status(view.table, DrawnStatus::check_failed);
    std::size_t const all = view.table.members.size();
    view.summary = fmt::format("{} {}", all, all == 1 ? "member" : "members");
    if (doubtful > 0) {
        view.summary += fmt::format(", {} of them with failed checks", doubtful);
    }
    if (failed > 0) {
        view.summary += fmt::format(", {} not made", failed);
    }
    for (std::size_t k = 0; k < view.table.keys.size(); ++k) {
        view.summary += fmt::format(" · {} {}", view.table.keys[k], words_of_key(view.table, k));
        if (auto key = varied_key(view.table, k)) {
            view.parameters.push_back(std::move(*key));
        }
    }
    return view;
}

/// The folder of a member beside the table.
fs::path folder_of(fs::path const& folder, DrawnMember const& member) {
    return folder / fmt::format("member_{:05}", member.number);
}

constexpr std::size_t most_thumbnails = 60;
constexpr std::int64_t most_thumbnail_cells = 400; // a side

std::vector<std::size_t> chosen_members(MembersTable const& table) {
    std::size_t const all = table.members.size();
    std::size_t const count = std::min(all, most_thumbnails);
    std::vector<std::size_t> chosen;
    for (std::size_t i = 0; i < count; ++i) {
        chosen.push_back(count > 1 ? i * (all - 1) / (count - 1) : 0);
    }
    return chosen;
}

draw::Thumbnail thumbnail_of(MembersTable const& table, DrawnMember const& member, fs::path const& dem,
                             Run const& run) {
    draw::Thumbnail one;
    std::string name = fmt::format("{}", member.number);
    if (!member.seed.empty()) {
        name += fmt::format(" · seed {}", member.seed);
    }
    if (member.status == DrawnStatus::check_failed) {
        name += " · check failed";
    }
    one.words.push_back(std::move(name));
    for (std::size_t k = 0; k < table.keys.size(); ++k) {
        double const value = plain_number(member.values[k]);
        std::string const text = std::isnan(value) ? member.values[k] : short_number(value);
        one.words.push_back(fmt::format("{} {}", table.keys[k], text.empty() ? "unknown" : text));
    }
    if (member.status == DrawnStatus::failed) {
        one.missing = "failed";
    } else if (!fs::exists(dem)) {
        one.missing = "no dem.tif";
    } else {
        run.check();
        one.shade =
            io::hillshade(io::read_drawable(dem.string(), {.most_side = most_thumbnail_cells}, run.quiet()).dem);
    }
    return one;
}

/// The contact sheet of the members that have a DEM beside the table.
EnsembleSheet sheet_of_members(EnsembleView const& view, fs::path const& folder, report::Look const& look,
                               Run const& run) {
    MembersTable const& table = view.table;
    auto const dem_of = [&](DrawnMember const& member) { return folder_of(folder, member) / "dem.tif"; };
    std::vector<std::size_t> const chosen = chosen_members(table);
    bool const any = std::any_of(chosen.begin(), chosen.end(), [&](std::size_t m) {
        return table.members[m].status != DrawnStatus::failed && fs::exists(dem_of(table.members[m]));
    });
    EnsembleSheet sheet;
    if (!any) {
        bool const packed = fs::exists(folder / "shard-000000.tar");
        sheet.note = packed ? "there is no contact sheet: the members are in tar files, and it needs their folders"
                            : "there is no contact sheet: no folder member_00000, member_00001, ... beside the table "
                              "has a dem.tif";
        return sheet;
    }
    std::vector<draw::Thumbnail> thumbnails;
    std::int64_t failed = 0;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        run.at(0.9 * static_cast<double>(i) / static_cast<double>(chosen.size()), "contact_sheet");
        DrawnMember const& member = table.members[chosen[i]];
        failed += member.status == DrawnStatus::failed ? 1 : 0;
        thumbnails.push_back(thumbnail_of(table, member, dem_of(member), run));
    }
    std::string note = chosen.size() == table.members.size()
                           ? fmt::format("all {} members", chosen.size())
                           : fmt::format("{} of {} members, evenly chosen", chosen.size(), table.members.size());
    if (failed > 0) {
        note += fmt::format("; empty frames: {} failed", failed);
    }
    draw::ContactSheetParams params;
    params.title = view.title;
    params.note = "Hillshades of " + note;
    params.width_px = look.width_px > 0 ? look.width_px : params.width_px;
    sheet.png = draw::contact_sheet(thumbnails, params).bytes;
    sheet.note = "the contact sheet shows " + note;
    return sheet;
}

/// A key as a part of a file's name.
std::string in_file_name(std::string const& key) {
    std::string name = key;
    for (char& c : name) {
        bool const plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
                           c == '_' || c == '-';
        c = plain ? c : '_';
    }
    return name;
}

template <class Params> Params sheet_params(EnsembleView const& view, report::Look const& look, draw::Format format) {
    Params params;
    params.title = view.title;
    params.note = view.summary;
    params.width_px = look.width_px > 0 ? look.width_px : params.width_px;
    params.format = format;
    return params;
}

draw::Picture responses_to(DrawnKey const& key, EnsembleView const& view, report::Look const& look,
                           draw::Format format) {
    auto params = sheet_params<draw::ResponsesParams>(view, look, format);
    params.title += ": response to " + key.values.name + (key.values.unit.empty() ? "" : " [" + key.values.unit + "]");
    params.words = key.words;
    return draw::responses(key.values, view.indices, params);
}

} // namespace

std::string unit_of_key(std::string const& key) {
    std::vector<recipe::KeyHelp> const keys = recipe::recipe_keys();
    auto const found =
        std::find_if(keys.begin(), keys.end(), [&](recipe::KeyHelp const& help) { return help.path == key; });
    return found == keys.end() ? "" : found->unit;
}

std::string words_of_key(MembersTable const& table, std::size_t key) {
    constexpr std::size_t most_words = 6;
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    bool numbers = true;
    std::vector<std::string> words;
    for (DrawnMember const& member : table.members) {
        std::string const& text = member.values[key];
        double const value = plain_number(text);
        if (text.empty()) {
            continue;
        }
        numbers = numbers && !std::isnan(value);
        low = std::min(low, value);
        high = std::max(high, value);
        if (words.size() <= most_words && std::find(words.begin(), words.end(), text) == words.end()) {
            words.push_back(text);
        }
    }
    if (words.empty()) {
        return "unknown";
    }
    if (!numbers) {
        std::string const more = words.size() > most_words ? ", ..." : "";
        words.resize(std::min(words.size(), most_words));
        return fmt::format("{}{}", fmt::join(words, ", "), more);
    }
    std::string const unit = unit_of_key(table.keys[key]);
    return (low == high ? short_number(low) : fmt::format("{} to {}", short_number(low), short_number(high))) +
           (unit.empty() ? "" : " " + unit);
}

DrawnEnsemble draw_ensemble(DrawEnsembleParams const& params, Run const& run) {
    fs::path const source(params.source);
    fs::path const file = fs::is_directory(source) ? source / "table.csv" : source;
    run.at(0.0, "table");
    MembersTable table = read_members_table(file.string());
    fs::path const folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    std::string const name = as_utf8(folder.lexically_normal().filename().string());
    bool const named = !name.empty() && name != "." && name != "..";
    EnsembleView const view = view_of(std::move(table), !params.title.empty() ? params.title
                                                        : named               ? "Ensemble " + name
                                                                              : "Ensemble");

    std::vector<std::string> names;
    if (!params.single.empty()) {
        names.push_back(params.single);
    } else {
        for (NamedFormat const& format : params.formats) {
            names.push_back(fmt::format("distributions.{}", format.name));
            for (DrawnKey const& key : view.parameters) {
                names.push_back(fmt::format("responses_{}.{}", in_file_name(key.values.name), format.name));
            }
        }
        names.insert(names.end(), {"contact_sheet.png", "ensemble.html"});
    }
    io::OutputFolder out(params.folder, io::Existing::add, io::files_there(params.folder, names, params.existing));
    DrawnEnsemble drawn{{}, view.findings};
    auto const write = [&](std::string const& file_name, std::string const& bytes) {
        io::write_text(out.path(file_name), bytes);
        drawn.files.push_back(params.folder == "." && !params.single.empty()
                                  ? file_name
                                  : (fs::path(params.folder) / file_name).string());
    };
    bool const wants_page = params.single.empty() || params.page;
    if (!params.page) {
        for (NamedFormat const& format : params.formats) {
            run.at(0.1, "distributions");
            write(params.single.empty() ? fmt::format("distributions.{}", format.name) : params.single,
                  draw::distributions(view.indices,
                                      sheet_params<draw::DistributionsParams>(view, params.look, format.format))
                      .bytes);
            for (DrawnKey const& key : view.parameters) {
                run.check();
                if (params.single.empty()) {
                    write(fmt::format("responses_{}.{}", in_file_name(key.values.name), format.name),
                          responses_to(key, view, params.look, format.format).bytes);
                }
            }
        }
    }
    if (wants_page) {
        EnsembleSheet const sheet = sheet_of_members(view, folder, params.look, run);
        drawn.findings.push_back({.kind = "contact_sheet", .text = sheet.note});
        if (!sheet.png.empty() && params.single.empty()) {
            write("contact_sheet.png", sheet.png);
        }
        run.at(0.95, "page");
        write(params.page ? params.single : "ensemble.html", ensemble_page(view, sheet, params.command, run));
    }
    run.at(1.0, "draw");
    out.commit();
    run.report(drawn.findings);
    return drawn;
}

} // namespace thalweg::ensemble
