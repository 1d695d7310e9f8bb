// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/same_grid.hpp>

#include <string>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>

namespace thalweg {
namespace {

std::string difference(Grid const& one, Grid const& other) {
    if (one.width != other.width || one.height != other.height) {
        return fmt::format("{} x {} cells and {} x {}", one.width, one.height, other.width, other.height);
    }
    if (one.cell_m != other.cell_m) {
        return fmt::format("cells of {:.12g} and {:.12g} m", one.cell_m, other.cell_m);
    }
    if (one.west != other.west || one.north != other.north) {
        return fmt::format("of equal sizes, with north-western corners at ({:.12g}, {:.12g}) and ({:.12g}, {:.12g})",
                           one.west, one.north, other.west, other.north);
    }
    auto const named = [](std::string const& crs) { return crs.empty() ? std::string("no CRS") : crs.substr(0, 60); };
    return fmt::format("of equal sizes, in {} and {}", named(one.crs), named(other.crs));
}

} // namespace

void require_same_grid(Grid const& one, Grid const& other, std::string_view where, std::string_view what,
                       std::string_view remedy) {
    if (one != other) {
        throw BadInput(std::string(where),
                       fmt::format("{} have different grids: {}; {}", what, difference(one, other), remedy));
    }
}

} // namespace thalweg
