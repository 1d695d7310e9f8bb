// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/ensemble/ensemble.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <new>
#include <numeric>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/ensemble/internal/table.hpp>
#include <thalweg/recipe/recipe_keys.hpp>

namespace thalweg::ensemble {

namespace {

constexpr std::uint64_t vary_stage = 0x76617279; // "vary"

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && text.front() == ' ') {
        text.remove_prefix(1);
    }
    while (!text.empty() && text.back() == ' ') {
        text.remove_suffix(1);
    }
    return text;
}

std::optional<double> as_number(std::string_view text) {
    text = trimmed(text);
    double value = 0.0;
    auto const [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
    bool const all = fault == std::errc() && end == text.data() + text.size() && std::isfinite(value);
    return all ? std::optional(value) : std::nullopt;
}

/// Splits at commas outside brackets and quotes.
std::vector<std::string> listed(std::string_view text) {
    std::vector<std::string> values(1);
    int depth = 0;
    char quote = '\0';
    for (char const c : text) {
        if (quote != '\0') {
            quote = c == quote ? '\0' : quote;
        } else if (c == '"' || c == '\'') {
            quote = c;
        } else {
            depth += (c == '[') - (c == ']');
            if (c == ',' && depth == 0) {
                values.emplace_back();
                continue;
            }
        }
        values.back() += c;
    }
    for (std::string& value : values) {
        value = trimmed(value);
    }
    return values;
}

bool is_number(recipe::KeyKind kind) {
    return kind == recipe::KeyKind::number || kind == recipe::KeyKind::integer ||
           kind == recipe::KeyKind::integer_or_word;
}

/// "network.prune" of "network.prune", "patch.rotate" of "patch.2.rotate".
std::string without_item(std::string const& path) {
    std::string out;
    for (std::size_t begin = 0; begin <= path.size();) {
        std::size_t const end = std::min(path.find('.', begin), path.size());
        std::string const part = path.substr(begin, end - begin);
        if (part.empty() || part.find_first_not_of("0123456789") != std::string::npos) {
            out += (out.empty() ? "" : ".") + part;
        }
        begin = end + 1;
    }
    return out;
}

std::string value_for(VariedKey const& vary, Member const& member) {
    if (!vary.between) {
        return vary.values[static_cast<std::size_t>(member.number) % vary.values.size()];
    }
    auto const [low, high] = *vary.between;
    double const u = unit(random_word(member.seed, vary_stage, hash_of(vary.key)));
    double const value = low + (high - low) * u;
    return fmt::format("{}", vary.is_integer ? std::floor(value + 0.5) : value);
}

using Values = std::vector<std::pair<std::string, double>>;

void add_laws(Values& values, char const* prefix, measure::NetworkLaws const& laws) {
    for (make::LawRow const& law : make::law_rows(laws)) {
        values.emplace_back(fmt::format("{}.{}", prefix, law.key),
                            law.value.value_or(std::numeric_limits<double>::quiet_NaN()));
    }
}

void add_rivers(Values& values, make::Rivers const& rivers) {
    StreamNetwork const& plan = rivers.network.planform;
    auto const count = [](auto number) { return static_cast<double>(number); };
    int strahler = 0;
    for (int const order : rivers.orders.strahler) {
        strahler = std::max(strahler, order);
    }
    values.insert(values.end(),
                  {{"rivers.arcs", count(plan.arc_count())},
                   {"rivers.outlets", count(plan.outlets().size())},
                   {"rivers.strahler", count(strahler)},
                   {"rivers.length_m", std::accumulate(plan.length_m().begin(), plan.length_m().end(), 0.0)}});
}

void add_dem(Values& values, make::SurfaceMeasures const& measured) {
    measure::Statistics const& s = *measured.statistics;
    values.insert(values.end(), {{"dem.mean", s.mean},
                                 {"dem.std", s.std},
                                 {"dem.min", s.min.z},
                                 {"dem.max", s.max.z},
                                 {"dem.slope_true_deg", s.slope_true_deg},
                                 {"dem.skew", s.skew},
                                 {"dem.kurtosis", s.kurtosis},
                                 {"dem.roughness_m", s.roughness_m},
                                 {"dem.lx_cells", s.lx.cells},
                                 {"dem.ly_cells", s.ly.cells},
                                 {"dem.dimension", s.dimension},
                                 {"dem.hypsometric_integral", measured.hypsometry->integral}});
}

} // namespace

VariedKey read_varied_key(std::string const& text) {
    constexpr char const* form = "write KEY=A..B for a number between A and B, or KEY=VALUE,VALUE for values in turn";
    std::size_t const equals = text.find('=');
    refuse_if<BadParameter>(equals == std::string::npos || equals == 0, "ensemble.read_varied_key", "--vary {}: {}",
                            text, form);
    VariedKey vary{.key = std::string(trimmed(std::string_view(text).substr(0, equals)))};
    std::string_view const value = trimmed(std::string_view(text).substr(equals + 1));
    recipe::Key const* const key = recipe::find_key(without_item(vary.key));
    refuse_if<BadParameter>(key == nullptr, "ensemble.read_varied_key", "--vary {}: {}", text,
                            recipe::unknown_key(vary.key));
    refuse_if<BadParameter>(vary.key == "seed", "ensemble.read_varied_key",
                            "--vary {}: every member has a seed of its own: use --seeds A-B", text);
    refuse_if<BadParameter>(value.empty(), "ensemble.read_varied_key", "--vary {}: {}", text, form);
    std::size_t const dots = value.find("..");
    auto const low = dots == std::string_view::npos ? std::nullopt : as_number(value.substr(0, dots));
    auto const high = dots == std::string_view::npos ? std::nullopt : as_number(value.substr(dots + 2));
    if (low && high) {
        refuse_if<BadParameter>(!is_number(key->row->kind), "ensemble.read_varied_key",
                                "--vary {}: {} is not a number: list its values, {}=A,B", text, vary.key, vary.key);
        refuse_if<BadParameter>(*low > *high, "ensemble.read_varied_key", "--vary {}: {} is above {}", text, *low,
                                *high);
        vary.between = {*low, *high};
        vary.is_integer = key->row->kind != recipe::KeyKind::number;
        return vary;
    }
    refuse_if<BadParameter>(dots != std::string_view::npos && is_number(key->row->kind), "ensemble.read_varied_key",
                            "--vary {}: A and B in A..B are numbers", text);
    vary.values = listed(value);
    refuse_if<BadParameter>(std::ranges::any_of(vary.values, &std::string::empty), "ensemble.read_varied_key",
                            "--vary {}: a value is empty", text);
    return vary;
}

Member member_of(Ensemble const& ensemble, std::int64_t number) {
    Member member{.number = number, .seed = ensemble.recipe.seed + static_cast<std::uint64_t>(number)};
    for (VariedKey const& vary : ensemble.vary) {
        member.keys.emplace_back(vary.key, value_for(vary, member));
    }
    return member;
}

recipe::Recipe recipe_of(Ensemble const& ensemble, Member const& member) {
    recipe::Recipe recipe = ensemble.recipe;
    recipe.seed = member.seed;
    for (auto const& [key, value] : member.keys) {
        try {
            recipe::set_key(recipe, key, value);
        } catch (BadParameter const& fault) {
            throw BadParameter(fault.where(), fmt::format("{} = {}: {}", key, value, fault.what()));
        }
    }
    return recipe;
}

char const* name_of(MemberState state) {
    return state == MemberState::ok ? "ok" : state == MemberState::failed ? "failed" : "check_failed";
}

MemberRow row_of(Member const& member, make::MakeResult const& made) {
    MemberRow row{.member = member};
    for (Check const& check : made.assessment.checks) {
        if (!check.ok) {
            row.state = MemberState::check_failed;
            row.reason +=
                fmt::format("{}{} is {:.6g}, {} {:.6g}", row.reason.empty() ? "" : "; ", check.name, check.value,
                            check.bound == Bound::at_least ? "at least" : "at most", check.limit);
        }
    }
    Values& values = row.values;
    for (Check const& check : made.assessment.checks) {
        values.emplace_back("check." + check.name, check.value);
    }
    if (made.recipe.network) {
        add_rivers(values, made.terrain.rivers);
    }
    if (made.assessment.statistics) {
        add_dem(values, made.assessment);
    }
    if (made.assessment.laws.network) {
        add_laws(values, "law", *made.assessment.laws.network);
    }
    if (made.assessment.laws.dem) {
        add_laws(values, "dem_law", made.assessment.laws.dem->laws);
    }
    if (made.assessment.relief) {
        for (make::ReliefRow const& index : make::relief_rows(*made.assessment.relief)) {
            values.emplace_back(fmt::format("relief.{}", index.key),
                                index.value.value_or(std::numeric_limits<double>::quiet_NaN()));
        }
    }
    row.timings_s = make::timings_of(made);
    std::vector<Finding> const findings = make::findings_of(made);
    row.warnings = warnings_in(findings);
    if (row.warnings > 0) {
        row.first_warning = std::ranges::find(findings, Severity::warning, &Finding::severity)->text;
    }
    return row;
}

MadeMember make_member(Ensemble const& ensemble, std::int64_t number, Run const& run) {
    Member const member = member_of(ensemble, number);
    auto const failed = [&](std::string const& reason) {
        return MadeMember{{.member = member, .state = MemberState::failed, .reason = reason}, {}};
    };
    try {
        MadeMember out;
        out.made = make::make(recipe_of(ensemble, member), run.quiet());
        out.row = row_of(member, *out.made);
        return out;
    } catch (Cancelled const&) {
        throw;
    } catch (Error const& error) {
        return failed(error.what());
    } catch (std::bad_alloc const&) {
        return failed("out of memory: make the grid smaller or the cell larger, or use fewer threads");
    }
}

} // namespace thalweg::ensemble
