// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <utility>

namespace thalweg {

/// A parameter without a default: code that leaves it out does not compile. Converts to its value.
template <class T> class Required {
public:
    constexpr Required(T value) : value_(std::move(value)) {} // implicit: {.cell_m = 30.0}
    constexpr operator T const&() const noexcept { return value_; }

private:
    T value_;
};

} // namespace thalweg
