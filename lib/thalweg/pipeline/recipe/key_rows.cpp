// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/internal/key_rows.hpp>

#include <sstream>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <thalweg/core/run/messages.hpp>
#include <thalweg/core/run/refuse.hpp>

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

PartKey::PartKey() = default;
PartKey::PartKey(PartKey const& other) = default;
PartKey::PartKey(PartKey&& other) noexcept = default;
PartKey& PartKey::operator=(PartKey const& other) = default;
PartKey& PartKey::operator=(PartKey&& other) noexcept = default;
PartKey::~PartKey() = default;

PartKey const& PartKey::of(std::type_info const& type) const {
    if (holder == nullptr || *holder != type) {
        throw std::logic_error("recipe: the key " + help.path + " is in the table of another type");
    }
    return *this;
}

PartKey inside(std::string const& prefix, std::type_info const& whole, ToField const& to_part, PartKey const& row) {
    PartKey key = row;
    key.help.path = prefix + row.help.path;
    key.holder = &whole;
    key.store = [to_part, store = row.store](void* s, Value const& v) { store(to_part(s), v); };
    key.show = [to_part, show = row.show](void const* s) { return show(to_part(const_cast<void*>(s))); };
    if (row.layer) {
        key.layer = [to_part, layer = row.layer](void const* s) { return layer(to_part(const_cast<void*>(s))); };
    }
    return key;
}

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

void refuse(std::string const& wanted, Value const& v) {
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

// Not in the header: g++ 12 warns falsely of a variant that it has taken apart.
void remember(std::vector<Value>& values, double value) {
    values.emplace_back(value);
}

bool as_yes_no(Value const& v) {
    if (auto const* b = std::get_if<bool>(&v)) {
        return *b;
    }
    refuse("true or false", v);
}

std::string const& as_short_text(Value const& v) {
    std::string const& s = as_text(v);
    refuse_if<BadParameter>(s.size() > 4096 || s.find('\0') != std::string::npos,
                            "the text is too long or holds a null byte");
    return s;
}

Use source_is(char const* word) {
    return is("network.source", {word});
}

Use method_is(std::vector<std::string> const& words) {
    return with("network") && is("surface.method", words);
}

Use by_equilibrium() {
    return method_is({"equilibrium"});
}

Use has_surface() {
    return without("network") || with("surface");
}

} // namespace thalweg::pipeline
