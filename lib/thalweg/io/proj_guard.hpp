// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// What PROJ may open. Private to this module.
namespace thalweg::io {

/// In a program that calls this PROJ reads files in its own folders only (projinfo --searchpaths) and writes none,
/// wherever the name of a grid comes from; see take_refusal. In a module that another program loads it does not obey.
void guard_proj();

} // namespace thalweg::io
