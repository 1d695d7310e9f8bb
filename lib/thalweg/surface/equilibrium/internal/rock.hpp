// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <thalweg/core/run/memory.hpp>

// What slopes depend on. See docs/algorithms/equilibrium_levels.md.

namespace thalweg::surface {

/// The steepest slope that uplift maintains at mean erodibility.
inline constexpr float steepest_tangent = 0.3F;

/// Numbers of some cells, which lie in runs of sixteen.
class SomeCells {
public:
    bool empty() const { return run_.empty(); }

    /// \return NaN: none
    float at(std::size_t cell) const {
        std::uint32_t const run = run_.empty() ? 0 : run_[cell / length];
        return run == 0 ? none : values_[(run - 1) * length + cell % length];
    }

    float or_zero(std::size_t cell) const {
        float const value = at(cell);
        return std::isnan(value) ? 0.0F : value;
    }

    /// \param cells of the level
    void set(std::size_t cell, float value, std::size_t cells) {
        run_.resize(cells / length + 1, 0);
        std::uint32_t& run = run_[cell / length];
        if (run == 0) {
            if (values_.size() == values_.capacity()) {
                values_.reserve(values_.size() / 4 * 5 + 64 * length);
            }
            values_.resize(values_.size() + length, none);
            run = static_cast<std::uint32_t>(values_.size() / length);
        }
        values_[(run - 1) * length + cell % length] = value;
    }

    /// Writes the numbers of some cells over those of a row.
    /// \param first of the row
    void write(std::size_t first, std::vector<float>& row) const {
        for (std::size_t c = 0; c < row.size() && !run_.empty();) {
            std::size_t const next = (first + c) / length * length + length - first;
            for (bool const some = run_[(first + c) / length] != 0; c < std::min(next, row.size()); ++c) {
                if (float const value = some ? at(first + c) : none; !std::isnan(value)) {
                    row[c] = value;
                }
            }
        }
    }

private:
    static constexpr std::size_t length = 16;
    static constexpr float none = std::numeric_limits<float>::quiet_NaN();
    std::vector<std::uint32_t> run_; ///< by sixteen cells: number of their run from 1; 0: they have none
    std::vector<float> values_;
};

/// Erodibility of a level's cells, and the cap on their slopes: the largest tangent towards a receiver. Both follow
/// from one number a cell, but where they have been set.
class Rock {
public:
    enum class Cap : std::uint8_t {
        fourth_fifths, ///< 0.3 erodibility ^ -4/5
        half           ///< a tangent times erodibility ^ -1/2
    };

    Rock() = default;
    /// \param fifth_root of erodibility, by cell
    explicit Rock(std::vector<float, LargePages<float>> fifth_root) : root_(std::move(fifth_root)) {}

    std::size_t cells() const { return root_.size(); }
    void limit_by_half(float tangent) {
        law_ = Cap::half;
        tangent_ = tangent;
    }

    float erodibility(std::size_t cell) const {
        float const set = erodibility_.at(cell);
        return std::isnan(set) ? erodibility_of(root_[cell]) : set;
    }
    float cap(std::size_t cell) const {
        float const set = cap_.at(cell);
        return std::isnan(set) ? cap_of(root_[cell]) : set;
    }
    /// Asks for what cap() reads.
    void fetch_cap(std::size_t cell) const { __builtin_prefetch(&root_[cell]); }
    void set_erodibility(std::size_t cell, float value) { erodibility_.set(cell, value, root_.size()); }
    void set_cap(std::size_t cell, float value) { cap_.set(cell, value, root_.size()); }

    /// Reads a row of cells.
    void erodibilities(std::size_t first, std::vector<float>& row) const {
        for (std::size_t c = 0; c < row.size(); ++c) {
            row[c] = erodibility_of(root_[first + c]);
        }
        erodibility_.write(first, row);
    }
    void caps(std::size_t first, std::vector<float>& row) const {
        for (std::size_t c = 0; c < row.size(); ++c) {
            row[c] = cap_of(root_[first + c]);
        }
        cap_.write(first, row);
    }

private:
    static float fourth(float root) { return (root * root) * (root * root); }
    static float erodibility_of(float root) { return fourth(root) * root; }
    float cap_of(float root) const {
        return law_ == Cap::half ? tangent_ / std::sqrt(erodibility_of(root)) : steepest_tangent / fourth(root);
    }

    std::vector<float, LargePages<float>> root_;
    SomeCells erodibility_;
    SomeCells cap_;
    Cap law_ = Cap::fourth_fifths;
    float tangent_ = steepest_tangent;
};

} // namespace thalweg::surface
