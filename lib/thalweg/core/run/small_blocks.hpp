// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace thalweg {

/// \internal
/// Gives the pages of small blocks that were released back to the system, if they are many: between others they stay
/// the process's, and lines (of growth, meanders, streams, contours) are many small blocks.
void return_small_blocks() noexcept;

} // namespace thalweg
