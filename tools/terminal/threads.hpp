// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace thalweg::tools {

/// Whether the system lets a run with so many threads (0: one a core) start all that it needs: those of oneTBB, and as
/// many again of GDAL. GDAL waits for ever for one that could not be started.
bool can_start_threads(int wanted);

} // namespace thalweg::tools
