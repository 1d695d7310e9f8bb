// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/make/make.hpp>
#include <thalweg/recipe/plan.hpp>
#include <thalweg/recipe/recipe.hpp>

namespace thalweg::ensemble {

/// A key of the recipe that differs between the members of an ensemble: uniformly distributed, or one of several
/// values in turn.
struct VariedKey {
    std::string key;                                   ///< "surface.mean_slope"
    std::optional<std::array<double, 2>> between = {}; ///< [unit of the key] lowest and highest value
    std::vector<std::string> values = {};              ///< as set_key() takes them; empty where between is set
    bool is_integer = false;                           ///< numbers are rounded to whole ones
};

/// Reads "KEY=A..B" (a number between A and B) or "KEY=VALUE,VALUE,…" (values in turn; commas in brackets and quotes
/// do not separate).
/// \param text as the option --vary has it
/// \return the key and its values
/// \throws BadParameter when there is no such key, it is the seed, A..B is given for a key that is no number, or A > B
VariedKey read_varied_key(std::string const& text);

/// Terrains by one recipe, which differ in the seed and in what varies.
struct Ensemble {
    recipe::Recipe recipe;    ///< of member 0, without what varies
    std::int64_t members = 1; ///< [1, ...]
    std::vector<VariedKey> vary = {};
};

/// A member of an ensemble.
struct Member {
    std::int64_t number = 0;                                    ///< [0, members)
    std::uint64_t seed = 0;                                     ///< that of the ensemble's recipe + number
    std::vector<std::pair<std::string, std::string>> keys = {}; ///< what varies, with this member's value
};

/// \param number [0, ensemble.members)
/// \return the member: of a key between A and B the value is A + (B - A) u, where u in [0, 1) is a hash of the member's
/// seed and the key's name; of a list it is the value number modulo the length of the list
Member member_of(Ensemble const& ensemble, std::int64_t number);

/// \return the recipe of a member
/// \throws BadParameter when a value is not one that its key may have
recipe::Recipe recipe_of(Ensemble const& ensemble, Member const& member);

/// What became of a member.
enum class MemberState : std::uint8_t {
    ok,
    check_failed, ///< made, and a check failed
    failed        ///< not made
};

/// \return "ok", "check_failed", "failed"
char const* name_of(MemberState state);

/// What is known of a member: a row of the table.
struct MemberRow {
    Member member;
    MemberState state = MemberState::ok;
    std::string reason = {};        ///< "" for ok
    std::int64_t warnings = 0;      ///< given while it was made
    std::string first_warning = {}; ///< "" for none
    /// by column: rivers.*, check.*, dem.*, law.* (rivers as drawn), dem_law.* (rivers of the DEM), relief.*; NaN:
    /// unknown
    std::vector<std::pair<std::string, double>> values = {};
    Timings timings_s = {};
};

/// Measures a member.
/// \param member which one
/// \param made its terrain
/// \return the row
MemberRow row_of(Member const& member, make::MakeResult const& made);

/// A member with its terrain.
struct MadeMember {
    MemberRow row;
    std::optional<make::MakeResult> made = {}; ///< nothing: the member failed, and the row says why
};

/// Makes a member of an ensemble, as make() does.
/// \return the member; when its recipe is impossible, its input cannot be used, or a stage does not converge, a row
/// with the reason
/// \throws Cancelled when the work must stop
MadeMember make_member(Ensemble const& ensemble, std::int64_t number, Run const& run = {});

} // namespace thalweg::ensemble
