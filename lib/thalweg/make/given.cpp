// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/make/given.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string_view>

#include <fmt/format.h>

#include <thalweg/core/append.hpp>
#include <thalweg/core/vec.hpp>

namespace thalweg::make {
namespace {

/// The doubts of a kind, the largest first.
std::vector<Finding const*> doubts_of(network::Directions const& directions, FindingKind kind) {
    std::vector<Finding const*> result;
    for (Finding const& doubt : directions.doubts) {
        if (doubt.kind == kind) {
            result.push_back(&doubt);
        }
    }
    std::ranges::stable_sort(result, [](Finding const* a, Finding const* b) { return a->amount > b->amount; });
    return result;
}

std::string groups(std::size_t count) {
    return count == 1 ? "1 group of lines" : fmt::format("{} groups of lines", count);
}

// A length for readers: "12.3 km", or metres below 50 m.
std::string in_km(double m) {
    constexpr double least_m = 50.0; // less would be 0.0 km
    return m < least_m ? fmt::format("{:.2g} m", m) : fmt::format("{:.1f} km", m / 1000.0);
}

/// "12.3 km reversed: 10.1 km by angles at confluences, 2.2 km by the file's links".
std::vector<Finding> turned_lengths(network::Directions const& directions) {
    double sum_m = 0.0;
    std::string parts;
    for (network::Directions::Turned const& turned : directions.turned) {
        sum_m += turned.length_m;
        parts += fmt::format("{}{} by {}", parts.empty() ? "" : ", ", in_km(turned.length_m), turned.by);
    }
    if (parts.empty()) {
        return {};
    }
    std::string const text = directions.turned.size() == 1
                                 ? fmt::format("{} reversed by {}", in_km(sum_m), directions.turned.front().by)
                                 : fmt::format("{} reversed: {}", in_km(sum_m), parts);
    return {{.kind = "directions", .amount = sum_m, .text = text}};
}

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

double sum_of(std::vector<Finding> const& findings, std::initializer_list<FindingKind> kinds) {
    double sum = 0.0;
    for (Finding const& f : findings) {
        sum += std::ranges::count(kinds, f.kind) > 0 ? f.amount : 0.0;
    }
    return sum;
}

/// Differences at a river's vertices.
RiverOff off_of(std::int64_t feature, std::vector<double>& off_m) {
    std::ranges::sort(off_m);
    std::size_t const last = off_m.size() - 1;
    return {feature, std::ssize(off_m), off_m[last / 2], off_m[last * 99 / 100], off_m[last]};
}

/// The feature at a length along an arc; 0: none.
std::int64_t feature_at(std::vector<Stretch> const& stretches, double along_m) {
    for (Stretch const& stretch : stretches) {
        if (along_m <= stretch.to_m) {
            return stretch.feature;
        }
    }
    return stretches.empty() ? 0 : stretches.back().feature;
}

/// Sums up differences by feature, and sorts them.
void sum_up(std::map<std::int64_t, std::vector<double>>& off_m, GivenHeights& given) {
    constexpr std::size_t most = 1000;
    std::vector<double> all;
    for (auto& [feature, some] : off_m) {
        all.insert(all.end(), some.begin(), some.end());
        given.rivers.push_back(off_of(feature, some));
    }
    if (all.empty()) {
        return;
    }
    RiverOff const whole = off_of(0, all);
    given.median_off_m = whole.median_off_m;
    given.p99_off_m = whole.p99_off_m;
    given.most_off_m = whole.most_off_m;
    std::ranges::stable_sort(given.rivers, std::greater<>(), &RiverOff::most_off_m);
    given.rivers.resize(std::min(most, given.rivers.size()));
}

} // namespace

std::vector<Finding> direction_findings(network::Directions const& directions, std::string const& by_dem,
                                        std::string const& by_rule) {
    std::vector<Finding> found = turned_lengths(directions);
    auto const doubt = [&](Vec2 at, double amount_m, std::string text, std::string const& by) {
        found.push_back({.kind = "doubtful_directions",
                         .where = at,
                         .amount = amount_m,
                         .text = std::move(text),
                         .remedy = by.empty() ? "" : fmt::format("{} decides", by),
                         .key = "network.lines.orientation"});
    };
    std::string const either = by_dem.empty() ? by_rule : by_rule.empty() ? by_dem : by_dem + " or " + by_rule;
    if (auto const uncertain = doubts_of(directions, "uncertain_direction"); !uncertain.empty()) {
        doubt(uncertain.front()->where, directions.uncertain_m,
              fmt::format("the flow direction of {} ({}) is uncertain: {:.0f} % of that length is expected to run the "
                          "wrong way, the first group at ({:.0f}, {:.0f})",
                          groups(uncertain.size()), in_km(directions.uncertain_m),
                          100.0 * directions.expected_wrong_m / directions.uncertain_m, uncertain.front()->where.x,
                          uncertain.front()->where.y),
              either);
    }
    if (auto const second = doubts_of(directions, "second_outlet"); !second.empty()) {
        doubt(second.front()->where, 0.0,
              fmt::format("{} may have a second outlet, the likeliest at ({:.0f}, {:.0f}): {}", groups(second.size()),
                          second.front()->where.x, second.front()->where.y, second.front()->text),
              either);
    }
    for (FindingKind const kind : {FindingKind("conflicting_direction"), FindingKind("contradicted_direction")}) {
        if (auto const doubts = doubts_of(directions, kind); !doubts.empty()) {
            std::string const more = doubts.size() == 1 ? "" : fmt::format(" (and {} more)", doubts.size() - 1);
            doubt(doubts.front()->where, 0.0, doubts.front()->text + more, by_rule);
        }
    }
    return found;
}

char const* key_of(LeftOut cause) {
    return words[static_cast<std::size_t>(cause)].key;
}

char const* words_of(LeftOut cause) {
    return words[static_cast<std::size_t>(cause)].text;
}

GivenLength given_length(std::vector<Finding> const& of_plan, Planform const& planform, Terrain const& terrain) {
    RiverFile const& file = planform.file;
    GivenLength given;
    given.secondary = file.secondary;
    append(given.secondary,
           file.sources.missing(file.imported, terrain.rivers.network.planform, LeftOut::head, "cut at its head"));
    double of_imported_m = 0.0; // left out of the adopted network, and of the lines before it
    double of_file_m = 0.0;
    double of_import_m = 0.0;
    for (SecondaryLine const& line : given.secondary) {
        double m = length_in_plan(line.vertices);
        switch (line.cause) {
        case LeftOut::head: of_imported_m += m /= file.lengthened; break;
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
    double const imported_m = file.sources.length_m(file.imported) / file.lengthened;
    given.kept_m = imported_m - of_imported_m;
    given.read_m = file.taken_m + of_file_m;
    given.closed_m = imported_m + given.left_out(LeftOut::pruned) + of_import_m - file.taken_m;
    std::vector<Finding> repairs = of_plan;
    append(repairs, planform.findings);
    given.carried_m = sum_of(repairs, {"carried_outlet", "joined_outlet"});
    given.turned_m = sum_of(repairs, {"reversed"});
    given.connector_m = sum_of(repairs, {"connector"});
    for (Finding const& f : repairs) {
        given.moved_m = std::max(given.moved_m, f.kind == FindingKind("snapped") ? f.amount : 0.0);
    }
    return given;
}

std::optional<GivenHeights> given_heights(recipe::NetworkRecipe const& wanted, RiverLines const& lines,
                                          Planform const& planform, Terrain const& terrain) {
    bool const taken = wanted.heights == recipe::Heights::file || wanted.heights == recipe::Heights::soft ||
                       wanted.heights == recipe::Heights::fixed;
    if (!taken || !lines.has_z || !planform.file_heights || !terrain.has_surface()) {
        return std::nullopt;
    }
    std::set<std::pair<double, double>> of_file; // without those of outlets that were carried on
    for (ArcId a = 0; a < planform.file.imported.arc_count(); ++a) {
        for (Vec2 const v : planform.file.imported.arc(a).line) {
            of_file.insert({v.x, v.y});
        }
    }
    Raster<float> const& dem = terrain.ground.dem;
    double const cell_m = dem.grid().cell_m;
    GivenHeights given;
    given.tolerance_m = wanted.heights_tolerance_m;
    double sum_m = 0.0;
    ElevatedNetwork const& asked = *planform.file_heights;
    std::vector<std::vector<Stretch>> const stretches = planform.file.sources.of(asked.planform);
    std::map<std::int64_t, std::vector<double>> off_by_feature;
    for (ArcId a = 0; a < asked.planform.arc_count(); ++a) {
        std::vector<Vec2> const& line = asked.planform.arc(a).line;
        std::vector<double> const& z = asked.arc_z[a];
        auto const fall_in_cell = [&](std::size_t i) { // between vertices i and i + 1
            double const way_m = distance(line[i], line[i + 1]);
            return std::fabs(z[i] - z[i + 1]) * std::min(1.0, cell_m / std::max(way_m, 1e-9));
        };
        double along_m = 0.0;
        for (std::size_t i = 0; i < line.size(); ++i) {
            along_m += i > 0 ? distance(line[i - 1], line[i]) : 0.0;
            Cell const cell = dem.grid().cell_of(line[i]);
            if (!of_file.contains({line[i].x, line[i].y}) || !dem.grid().contains(cell) || std::isnan(dem[cell])) {
                continue;
            }
            double const fall_m =
                std::max(i > 0 ? fall_in_cell(i - 1) : 0.0, i + 1 < line.size() ? fall_in_cell(i) : 0.0);
            double const off_m = std::fabs(static_cast<double>(dem[cell]) - z[i]);
            ++given.vertices;
            off_by_feature[feature_at(stretches[a], along_m)].push_back(off_m);
            if (off_m > given.tolerance_m + fall_m) {
                ++given.missed;
                sum_m += off_m;
                given.largest_m = std::max(given.largest_m, off_m);
            }
        }
    }
    given.mean_m = given.missed > 0 ? sum_m / static_cast<double>(given.missed) : 0.0;
    sum_up(off_by_feature, given);
    return given;
}

std::optional<GivenAreas> given_areas(RiverLines const& of_file, Planform const& planform, Terrain const& terrain) {
    std::map<std::int64_t, double> area_of; // by feature
    for (auto const* lines : {&of_file.lines, &of_file.channels}) {
        for (RiverLine const& line : *lines) {
            if (line.area_m2 > 0.0) {
                area_of.try_emplace(line.feature, line.area_m2);
            }
        }
    }
    if (area_of.empty()) {
        return std::nullopt;
    }
    StreamNetwork const& network = terrain.rivers.network.planform;
    std::vector<std::vector<Stretch>> const stretches = planform.file.sources.of(network);
    std::vector<double> ratios;
    for (ArcId a = 0; a < network.arc_count(); ++a) {
        if (stretches[a].empty() || network.length_m(a) - stretches[a].back().to_m > terrain.grid.cell_m) {
            continue; // extended beyond the line
        }
        std::int64_t const feature = stretches[a].back().feature;
        ArcId const below = network.out(network.to(a));
        bool const goes_on =
            below != no_arc && !stretches[below].empty() && stretches[below].front().feature == feature;
        if (auto const area = area_of.find(feature); area != area_of.end() && !goes_on) {
            ratios.push_back(terrain.water.areas.ds_area_m2[a] / area->second);
        }
    }
    if (ratios.empty()) {
        return std::nullopt;
    }
    std::ranges::sort(ratios);
    auto const at = [&](double share) {
        return ratios[static_cast<std::size_t>(share * static_cast<double>(ratios.size() - 1) + 0.5)];
    };
    auto const near = std::ranges::count_if(ratios, [](double r) { return r >= 0.5 && r <= 2.0; });
    return GivenAreas{static_cast<std::int64_t>(ratios.size()), at(0.5), at(0.05), at(0.95),
                      static_cast<double>(near) / static_cast<double>(ratios.size())};
}

std::string line_of(GivenAreas const& given) {
    return fmt::format("{} arcs drain {:.2f} of the file's areas (median; {:.2f} to {:.2f} from 5 to 95 %), {:.0f} % "
                       "within a factor of 2",
                       given.arcs, given.median, given.low, given.high, 100.0 * given.within_factor_2);
}

std::string line_of(GivenHeights const& given) {
    return fmt::format("{} given at vertices; dem.tif is {:.2g} m off (median), {:.2g} m at 99 %, {:.2g} m at most",
                       given.vertices, given.median_off_m, given.p99_off_m, given.most_off_m);
}

std::string line_of(GivenLength const& given) {
    std::string line = fmt::format("{} read, {} kept", in_km(given.read_m), in_km(given.kept_m));
    line += given.connector_m > 0.0 ? fmt::format(", {} of it in artificial channels", in_km(given.connector_m)) : "";
    char const* before = "; left out: ";
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (given.left_out_m[i] > 0.0) {
            line += fmt::format("{}{} {}", std::exchange(before, ", "), in_km(given.left_out_m[i]), words[i].text);
        }
    }
    line += given.turned_m > 0.0 ? fmt::format("; {} reversed", in_km(given.turned_m)) : "";
    line += given.moved_m > 0.0 ? fmt::format("; ends moved by up to {:.3g} m", given.moved_m) : "";
    line += given.carried_m > 0.0 ? fmt::format("; outlets extended by {}", in_km(given.carried_m)) : "";
    return line;
}

} // namespace thalweg::make
