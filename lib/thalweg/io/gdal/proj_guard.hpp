// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

struct pj_ctx; // PROJ's PJ_CONTEXT

/// What PROJ may open.
namespace thalweg::io {

/// From now on a context of PROJ reads files in PROJ's own folders only (projinfo --searchpaths) and writes none,
/// wherever the name of a grid comes from.
/// \param context the context of PROJ
void confine_proj(pj_ctx* context);

} // namespace thalweg::io
