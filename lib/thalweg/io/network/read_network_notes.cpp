// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/network/internal/read_network_notes.hpp>

#include <utility>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>

namespace thalweg::io {

namespace {

constexpr std::size_t kept = 1000;

} // namespace

void Notes::add(std::string const& source, Finding finding) {
    if (strict_) {
        throw BadInput(source + ": " + finding.text);
    }
    if (++count_[finding.kind] <= kept) {
        findings_.push_back(std::move(finding));
    }
}

std::vector<Finding> Notes::take() {
    for (auto const& [kind, count] : count_) {
        if (count > kept) {
            std::size_t const more = count - kept;
            findings_.push_back({kind, 0, {}, static_cast<double>(more), fmt::format("{}: {} more", kind, more)});
        }
    }
    count_.clear();
    return std::exchange(findings_, {});
}

} // namespace thalweg::io
