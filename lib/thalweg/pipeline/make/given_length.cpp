// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/make/given_length.hpp>

#include <thalweg/core/length_in_plan.hpp>
#include <thalweg/pipeline/plan/internal/append.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace thalweg::pipeline {

namespace {

struct Words {
    char const* key;
    char const* text;
};

/// By LeftOut.
constexpr std::array<Words, 8> words{{{"filter", "no natural watercourses"},
                                      {"coast", "coastlines"},
                                      {"grid", "beyond the grid"},
                                      {"duplicate", "duplicates"},
                                      {"too_short", "too short"},
                                      {"divergence", "divergences"},
                                      {"pruned", "pruned"},
                                      {"head", "cut at heads"}}};

double sum_of(std::vector<Finding> const& findings, std::initializer_list<char const*> kinds) {
    double sum = 0.0;
    for (Finding const& f : findings) {
        sum += std::ranges::count(kinds, f.kind) > 0 ? f.amount : 0.0;
    }
    return sum;
}

std::string km(double m) {
    constexpr double least_m = 50.0; // less would be 0.0 km
    return m < least_m ? fmt::format("{:.2g} m", m) : fmt::format("{:.1f} km", m / 1000.0);
}

} // namespace

char const* key_of(LeftOut cause) {
    return words[static_cast<std::size_t>(cause)].key;
}

char const* words_of(LeftOut cause) {
    return words[static_cast<std::size_t>(cause)].text;
}

std::optional<GivenLength> given_length(Plan const& plan, Rivers const& rivers, Terrain const& terrain) {
    if (!plan.recipe.network || plan.recipe.network->source != Source::lines) {
        return std::nullopt;
    }
    RiverFile const& file = rivers.file;
    GivenLength given;
    given.secondary = file.secondary;
    append(given.secondary, file.sources.missing(file.adopted, terrain.network.plan, LeftOut::head, "cut at its head"));
    double of_adopted_m = 0.0; // left out of the adopted network, and of the lines before it
    double of_file_m = 0.0;
    double of_import_m = 0.0;
    for (SecondaryLine const& line : given.secondary) {
        double m = length_in_plan(line.vertices);
        switch (line.cause) {
        case LeftOut::head: of_adopted_m += m /= file.lengthened; break;
        case LeftOut::filter:
        case LeftOut::coast:
        case LeftOut::grid: of_file_m += m; break;
        case LeftOut::pruned: break;
        case LeftOut::duplicate:
        case LeftOut::too_short:
        case LeftOut::divergence: of_import_m += m; break;
        }
        given.left_out_m[static_cast<std::size_t>(line.cause)] += m;
    }
    double const adopted_m = file.sources.length_m(file.adopted) / file.lengthened;
    given.kept_m = adopted_m - of_adopted_m;
    given.read_m = file.taken_m + of_file_m;
    given.closed_m = adopted_m + given.left_out(LeftOut::pruned) + of_import_m - file.taken_m;
    std::vector<Finding> const& repairs = rivers.story.repairs;
    given.carried_m = sum_of(repairs, {"carried_outlet", "joined_outlet"});
    given.turned_m = sum_of(repairs, {"reversed"});
    given.connector_m = sum_of(repairs, {"connector"});
    for (Finding const& f : repairs) {
        given.moved_m = std::max(given.moved_m, f.kind == "snapped" ? f.amount : 0.0);
    }
    return given;
}

std::string line_of(GivenLength const& given) {
    std::string line = fmt::format("{} read, {} kept", km(given.read_m), km(given.kept_m));
    line += given.connector_m > 0.0 ? fmt::format(", {} of it in artificial channels", km(given.connector_m)) : "";
    char const* before = "; left out: ";
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (given.left_out_m[i] > 0.0) {
            line += fmt::format("{}{} {}", std::exchange(before, ", "), km(given.left_out_m[i]), words[i].text);
        }
    }
    line += given.turned_m > 0.0 ? fmt::format("; {} reversed", km(given.turned_m)) : "";
    line += given.moved_m > 0.0 ? fmt::format("; ends moved by up to {:.3g} m", given.moved_m) : "";
    line += given.carried_m > 0.0 ? fmt::format("; outlets extended by {}", km(given.carried_m)) : "";
    return line;
}

} // namespace thalweg::pipeline
