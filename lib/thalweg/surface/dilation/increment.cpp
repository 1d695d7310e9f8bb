// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/dilation/increment.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numeric>
#include <string_view>

#include <fmt/format.h>
#include <muParser.h>

#include <thalweg/core/run/messages.hpp>
#include <thalweg/core/run/refuse.hpp>

namespace thalweg::surface {
namespace {

struct NamedIncrement {
    std::string_view name;
    double (*at)(double x);
};

// Hundredths are divided once, so that each value is the double nearest to the paper's.
constexpr std::array<NamedIncrement, 3> table_1{{
    {"uniform", [](double) { return 0.1; }},
    {"decreasing", [](double x) { return x < 300.0 ? (300.0 - x) / 100.0 : 0.0; }},
    {"rise_fall", [](double x) { return x <= 150.0 ? 3.0 * x / 100.0 : (600.0 - x) / 100.0; }},
}};

constexpr int halvings = 40;
constexpr double least_jump = 0.01; // of the greatest increment
constexpr std::size_t longest_expression = 1000;
std::string const choices =
    fmt::format("({}, or an expression in x such as 3-0.01*x)", fmt::join(increment_names(), ", "));

[[noreturn]] void refuse(std::string const& text, std::string_view why) {
    std::string hint = did_you_mean(text, increment_names());
    if (hint.empty() && !why.empty()) {
        hint = fmt::format(" As an expression: {}.", why);
    }
    throw BadParameter("surface.increments", fmt::format("'{}' is not an increment.{} {}", text, hint, choices));
}

bool assigns(std::string_view text) {
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '=') {
            continue;
        }
        if (i + 1 < text.size() && text[i + 1] == '=') {
            ++i;
        } else if (i == 0 || std::string_view("<>!").find(text[i - 1]) == std::string_view::npos) {
            return true;
        }
    }
    return false;
}

// libm inside muParser differs between machines in the last bits: rounding to 2^-32, but to at most 36 significant
// bits, hides this.
double tamed(double value) {
    double scale = 0x1p32;
    while (std::fabs(value) * scale >= 0x1p36) {
        scale *= 0.5;
    }
    return std::floor(value * scale + 0.5) / scale;
}

/// Evaluates x = 1 .. levels. at: the function; name, another: how messages name it and another of its kind.
template <class At>
std::vector<double> values_of(At const& at, std::string_view name, std::string_view another, std::int64_t levels) {
    std::vector<double> values(static_cast<std::size_t>(levels));
    for (std::size_t i = 0; i < values.size(); ++i) {
        double const value = at(static_cast<double>(i + 1));
        refuse_if<BadParameter>(!std::isfinite(value), "surface.increments",
                                "{} is not finite at x = {}; choose {} that is, for x = 1 to {}", name, i + 1, another,
                                levels);
        values[i] = tamed(value);
    }
    return values;
}

std::vector<double> tabulate(std::string const& text, std::int64_t levels) {
    refuse_if<BadParameter>(text.size() > longest_expression, "surface.increments",
                            "the expression has {} characters; write it in at most {}", text.size(),
                            longest_expression);
    auto const odd = std::find_if(text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; });
    if (odd != text.end()) {
        throw BadParameter("surface.increments",
                           fmt::format("character {} of the expression is not printable ASCII; use {}",
                                       odd - text.begin() + 1, choices));
    }
    if (assigns(text)) {
        refuse(text, "it assigns; compare with ==");
    }
    try {
        double x = 1.0;
        mu::Parser parser;
        parser.DefineVar("x", &x);
        parser.SetExpr(text);
        int results = 0;
        parser.Eval(results);
        if (results != 1) {
            refuse(text, "it has more than one value");
        }
        auto const at = [&](double where) {
            x = where;
            return parser.Eval();
        };
        return values_of(at, fmt::format("'{}'", text), "an expression", levels);
    } catch (mu::Parser::exception_type const& e) {
        refuse(text, e.GetMsg());
    }
}

NamedIncrement const* in_table_1(std::string const& name) {
    auto const named =
        std::find_if(table_1.begin(), table_1.end(), [&](NamedIncrement const& row) { return row.name == name; });
    return named == table_1.end() ? nullptr : &*named;
}

std::vector<double> signed_increments(std::int64_t levels, IncrementParams const& params) {
    if (params.function) {
        return values_of(params.function, "the function", "one", levels);
    }
    NamedIncrement const* const named = in_table_1(params.increment);
    if (named == nullptr) {
        return tabulate(params.increment, levels);
    }
    std::vector<double> values;
    values.reserve(static_cast<std::size_t>(levels));
    for (std::int64_t x = 1; x <= levels; ++x) {
        values.push_back(named->at(static_cast<double>(x)));
    }
    return values;
}

/// Returns the increments as a function of any x, from a function or from an expression that has already been parsed.
std::function<double(double)> anywhere(IncrementParams const& params) {
    if (params.function) {
        return params.function;
    }
    auto const x = std::make_shared<double>(1.0);
    auto const parser = std::make_shared<mu::Parser>();
    parser->DefineVar("x", x.get());
    parser->SetExpr(params.increment);
    return [x, parser](double where) {
        *x = where;
        return parser->Eval();
    };
}

} // namespace

std::vector<double> increments(std::int64_t levels, IncrementParams const& params) {
    refuse_if<BadParameter>(levels < 0, "surface.increments", "{} levels; ask for none or more", levels);
    std::vector<double> values = signed_increments(levels, params);
    if (!params.allow_negative) {
        for (double& value : values) {
            value = std::max(value, 0.0);
        }
    }
    return values;
}

std::vector<IncrementJump> increment_jumps(std::int64_t levels, IncrementParams const& params) {
    std::vector<double> const values = increments(levels, params);
    std::vector<IncrementJump> jumps;
    if ((!params.function && in_table_1(params.increment) != nullptr) ||
        values.size() < 2) { // the table's are continuous
        return jumps;
    }
    double greatest = 0.0;
    for (double const v : values) {
        greatest = std::max(greatest, std::fabs(v));
    }
    auto const value_at = anywhere(params);
    auto const at = [&](double where) {
        double const value = value_at(where);
        return params.allow_negative ? value : std::max(value, 0.0);
    };
    for (std::size_t i = 1; i < values.size(); ++i) {
        IncrementJump jump{static_cast<double>(i), values[i - 1], values[i]};
        double end = static_cast<double>(i + 1);
        for (int half = 0; half < halvings && std::fabs(jump.to - jump.from) > least_jump * greatest; ++half) {
            double const middle = 0.5 * (jump.x + end);
            double const value = at(middle);
            if (!(std::fabs(value - jump.from) <= std::fabs(jump.to - value))) {
                end = middle;
                jump.to = value;
            } else {
                jump.x = middle;
                jump.from = value;
            }
        }
        if (!(std::fabs(jump.to - jump.from) <= least_jump * greatest)) {
            jumps.push_back(jump);
        }
    }
    return jumps;
}

std::vector<double> heights_above_valley(std::vector<double> const& increments) {
    std::vector<double> sums(increments.size() + 1, 0.0);
    std::partial_sum(increments.begin(), increments.end(), sums.begin() + 1);
    return sums;
}

std::vector<std::string> increment_names() {
    std::vector<std::string> names;
    for (NamedIncrement const& named : table_1) {
        names.emplace_back(named.name);
    }
    return names;
}

} // namespace thalweg::surface
