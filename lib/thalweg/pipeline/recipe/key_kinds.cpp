// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/internal/key_kinds.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/suggest.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <sstream>
#include <string_view>

namespace thalweg::pipeline {

namespace {

/// The shortest text that reads back as the same number, and as one with a fraction.
std::string text_of(double x) {
    std::string text = fmt::format("{}", x);
    return text.find_first_not_of("-0123456789") == std::string::npos ? text + ".0" : text;
}

std::string text_of(bool b) {
    return b ? "true" : "false";
}

std::string text_of(std::int64_t i) {
    return fmt::format("{}", i);
}

std::string text_of(std::string const& s) {
    std::ostringstream out;
    out << toml::value<std::string>(s);
    return out.str();
}

template <std::size_t N> std::string text_of(std::array<double, N> const& list) {
    std::string out;
    for (double const x : list) {
        out += (out.empty() ? "" : ", ") + text_of(x);
    }
    return "[ " + out + " ]";
}

} // namespace

std::string toml_text(Value const& value) {
    return std::visit([](auto const& v) { return text_of(v); }, value);
}

std::string Range::text() const {
    if (most >= endless) {
        return fmt::format("{} {}", open ? ">" : ">=", least);
    }
    return fmt::format("{}{}, {}]", open ? "(" : "[", least, most);
}

void Range::require(double v) const {
    if (!holds(v)) {
        throw BadParameter(fmt::format("{} is outside its range {}", v, text()));
    }
}

void refuse(char const* wanted, Value const& v) {
    throw BadParameter(fmt::format("{} is required, not {}", wanted, toml_text(v)));
}

void refuse_word(std::string const& word, std::vector<std::string> const& words) {
    throw BadParameter(
        fmt::format("'{}' is not one of its values.{} ({})", word, did_you_mean(word, words), fmt::join(words, ", ")));
}

std::string alternatives(std::vector<std::string> const& words) {
    return fmt::format("{}", fmt::join(words, " | "));
}

double as_number(Value const& v) {
    if (auto const* i = std::get_if<std::int64_t>(&v)) {
        return static_cast<double>(*i);
    }
    if (auto const* d = std::get_if<double>(&v)) {
        return *d;
    }
    refuse("a number", v);
}

std::int64_t as_integer(Value const& v) {
    if (auto const* i = std::get_if<std::int64_t>(&v)) {
        return *i;
    }
    refuse("an integer", v);
}

std::string const& as_text(Value const& v) {
    if (auto const* s = std::get_if<std::string>(&v)) {
        return *s;
    }
    refuse("a text in quotes", v);
}

Key number(char const* path, char const* unit, Range range, char const* meaning, Field<double> field) {
    Key key;
    key.help = {path, "number", range.text(), unit, "", meaning};
    key.put = [range, field](Recipe& r, Value const& v) {
        double const x = as_number(v);
        range.require(x);
        field.make(r) = x;
    };
    key.take = taker<double>(field, [](double const& x) { return std::optional<Value>(x); });
    return key;
}

Key maybe(char const* path, char const* unit, Range range, char const* meaning, Field<std::optional<double>> field) {
    Key key;
    key.help = {path, "number", range.text(), unit, "", meaning};
    key.put = [range, field](Recipe& r, Value const& v) {
        double const x = as_number(v);
        range.require(x);
        field.make(r) = x;
    };
    key.take = taker<std::optional<double>>(
        field, [](std::optional<double> const& x) { return x ? std::optional<Value>(*x) : std::nullopt; });
    return key;
}

Key side(char const* path, char const* meaning, Field<std::int64_t> field) {
    Key key = integer<std::int64_t>(path, "cells", {1, 1e6}, meaning, field);
    key.take = taker<std::int64_t>(
        field, [](std::int64_t const& x) { return x > 0 ? std::optional<Value>(x) : std::nullopt; });
    return key;
}

Key text(char const* path, char const* range, char const* meaning, Field<std::string> field) {
    Key key;
    key.help = {path, "text", range, "", "", meaning};
    key.put = [field](Recipe& r, Value const& v) {
        std::string const& s = as_text(v);
        if (s.size() > 4096 || s.find('\0') != std::string::npos) {
            throw BadParameter("the text is too long or holds a null byte");
        }
        field.make(r) = s;
    };
    key.take = taker<std::string>(field, [](std::string const& s) { return std::optional<Value>(s); });
    return key;
}

Key file(char const* path, char const* meaning, Field<std::string> field) {
    Key key = text(path, "file name", meaning, std::move(field));
    key.help.is_file = true;
    return key;
}

Key yes_no(char const* path, char const* meaning, Field<bool> field) {
    Key key;
    key.help = {path, "yes/no", "true | false", "", "", meaning, {"true", "false"}};
    key.put = [field](Recipe& r, Value const& v) {
        auto const* b = std::get_if<bool>(&v);
        if (b == nullptr) {
            refuse("true or false", v);
        }
        field.make(r) = *b;
    };
    key.take = taker<bool>(field, [](bool const& b) { return std::optional<Value>(b); });
    return key;
}

} // namespace thalweg::pipeline
