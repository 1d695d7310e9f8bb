// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <thalweg/core/finding.hpp>

/// What reading a network has to say. Private to this module.
namespace thalweg::io {

class Notes {
public:
    /// Strict notes throw what they are given as BadInput.
    explicit Notes(bool strict) : strict_(strict) {}

    /// source: the file and layer for the message of a strict note.
    void add(std::string const& source, Finding finding);
    /// The first thousand of each kind, and one more that counts the rest.
    std::vector<Finding> take();

private:
    bool strict_;
    std::vector<Finding> findings_;
    std::map<std::string, std::size_t> count_;
};

} // namespace thalweg::io
