// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// A recipe and the files that it names → a Plan: everything known before rivers are drawn.
#include <thalweg/recipe/check_recipe.hpp>
#include <thalweg/recipe/condition.hpp>
#include <thalweg/recipe/frame.hpp>
#include <thalweg/recipe/make_input.hpp>
#include <thalweg/recipe/plan.hpp>
#include <thalweg/recipe/presets.hpp>
#include <thalweg/recipe/read_inputs.hpp>
#include <thalweg/recipe/recipe.hpp>
#include <thalweg/recipe/recipe_fields.hpp>
#include <thalweg/recipe/recipe_files.hpp>
#include <thalweg/recipe/recipe_keys.hpp>
#include <thalweg/recipe/recipe_of_dem.hpp>
#include <thalweg/recipe/stage_recipes.hpp>
#include <thalweg/recipe/stages.hpp>
