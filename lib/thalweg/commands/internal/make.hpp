// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/commands/make.hpp>

namespace thalweg::commands {

/// The recipe that make uses, with what the options set.
recipe::Recipe recipe_asked(MakeParams const& params);

} // namespace thalweg::commands
