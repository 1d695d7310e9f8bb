// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \internal For the modules above this one.

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <thalweg/recipe/recipe.hpp>
#include <thalweg/recipe/recipe_fields.hpp>

namespace thalweg::recipe {

/// A condition on a recipe, made of questions to its sections and keys by &&, || and !. It can be asked, and it says
/// itself in words: `[network] and (surface.method = "tin" or "diffuse" or no skeleton.points)`, where "and" binds
/// closer than "or". Stages run and keys have an effect on conditions.
class Condition {
public:
    Condition() = default; ///< holds for every recipe

    bool operator()(Recipe const& recipe) const;
    /// In words; "" where it holds for every recipe.
    std::string text() const;
    /// What a recipe lacks for it to hold, and what it has instead; "" where it holds.
    std::string lacks(Recipe const& recipe) const;
    /// The same condition, which people are told in other words.
    Condition told_as(std::string words) const;

    friend Condition operator&&(Condition const& a, Condition const& b);
    friend Condition operator||(Condition const& a, Condition const& b);
    /// \pre a does not hold for every recipe, and was not told_as() other words, which say nothing of its opposite
    friend Condition operator!(Condition const& a);

    /// The field of a key; nothing where a recipe has not its section.
    using FieldOf = std::function<std::optional<Field>(Recipe&)>;
    enum class Question : std::uint8_t { section, given, one_of, above, below, lists };
    static Condition ask(Question question, FieldOf field, std::vector<double> numbers = {});
    static Condition ask_section(std::function<bool(Recipe const&)> is_there);

private:
    struct Node;
    explicit Condition(std::shared_ptr<Node const> node);
    static Condition join(bool all, Condition const& a, Condition const& b);

    std::shared_ptr<Node const> node_;
};

/// The part of a recipe that has a type; null where the recipe has not its section.
template <class Part> Part* part_of(Recipe& recipe);
template <> NetworkRecipe* part_of(Recipe& recipe);
template <> growth::DlaParams* part_of(Recipe& recipe);
template <> LinesRecipe* part_of(Recipe& recipe);
template <> TokunagaRecipe* part_of(Recipe& recipe);
template <> ForestRecipe* part_of(Recipe& recipe);
template <> SkeletonRecipe* part_of(Recipe& recipe);
template <> SurfaceRecipe* part_of(Recipe& recipe);
template <> EquilibriumRecipe* part_of(Recipe& recipe);
template <> surface::DilateParams* part_of(Recipe& recipe);
template <> surface::DiffuseParams* part_of(Recipe& recipe);
template <> StrataRecipe* part_of(Recipe& recipe);
template <> StatisticsRecipe* part_of(Recipe& recipe);
template <> DetailRecipe* part_of(Recipe& recipe);
template <> fractal::MidpointParams* part_of(Recipe& recipe);
template <> OutputRecipe* part_of(Recipe& recipe);

template <class Part, class T> Condition::FieldOf field_of(T Part::*key) {
    return [key](Recipe& recipe) {
        Part* const part = part_of<Part>(recipe);
        return part == nullptr ? std::optional<Field>() : std::optional<Field>(field_at(part->*key));
    };
}

// What conditions are made of.
namespace ask {

/// The recipe has this section; of an array, at least one.
template <class T> Condition has(T Recipe::*section) {
    return Condition::ask_section([section](Recipe const& recipe) {
        if constexpr (requires { (recipe.*section).has_value(); }) {
            return (recipe.*section).has_value();
        } else {
            return !(recipe.*section).empty();
        }
    });
}

/// A key has a value; a text that is not "".
template <class Part, class T> Condition given(T Part::*key) {
    return Condition::ask(Condition::Question::given, field_of(key));
}

/// A key is one of these.
template <class Part, class T> Condition is(T Part::*key, std::initializer_list<std::type_identity_t<T>> values) {
    std::vector<double> numbers;
    for (T value : values) {
        numbers.push_back(*number_in(field_at(value)));
    }
    return Condition::ask(Condition::Question::one_of, field_of(key), std::move(numbers));
}

template <class Part, class T> Condition above(T Part::*key, int limit) {
    return Condition::ask(Condition::Question::above, field_of(key), {static_cast<double>(limit)});
}

template <class Part, class T> Condition below(T Part::*key, int limit) {
    return Condition::ask(Condition::Question::below, field_of(key), {static_cast<double>(limit)});
}

/// These files are written where the recipe makes them.
Condition writes(OutputFiles files);

} // namespace ask

// Conditions that keys, stages and what they read share.

inline Condition const with_rivers = ask::has(&Recipe::network);
/// There is a surface: around rivers, or alone.
inline Condition const with_surface = not with_rivers or ask::has(&Recipe::surface);
/// There is a surface around rivers.
inline Condition const around_rivers = with_rivers and ask::has(&Recipe::surface);
/// The surface is in equilibrium with rivers.
inline Condition const in_equilibrium = with_rivers and ask::is(&SurfaceRecipe::method, {Method::equilibrium});
/// It is in layers of rock.
inline Condition const in_layers = in_equilibrium and ask::has(&Recipe::layers);
/// Rivers are grown for a surface in equilibrium with them.
inline Condition const grown_for_land = in_equilibrium and not ask::is(&NetworkRecipe::source, {Source::lines});
/// The surface is dilated from rivers.
inline Condition const by_dilation = with_rivers and ask::is(&SurfaceRecipe::method, {Method::dilate});
/// The surface is a DEM of a file.
inline Condition const on_raster = ask::is(&SurfaceRecipe::method, {Method::raster});
/// Rivers are lines of a file.
inline Condition const from_lines = ask::is(&NetworkRecipe::source, {Source::lines});
/// Rivers are a branch of a DLA cluster.
inline Condition const from_cluster = ask::is(&NetworkRecipe::source, {Source::dla});
/// Rivers grow by Tokunaga's law.
inline Condition const by_tokunaga = ask::is(&NetworkRecipe::source, {Source::tokunaga});
/// Along strokes of a file.
inline Condition const from_strokes = by_tokunaga and ask::given(&TokunagaRecipe::strokes);
/// Rivers are a forest of trees that grow inland.
inline Condition const from_forest = ask::is(&NetworkRecipe::source, {Source::forest});
/// Ridges lie midway between streams.
inline Condition const between_streams = ask::is(&SkeletonRecipe::ridges, {Ridges::voronoi, Ridges::segments});

} // namespace thalweg::recipe
