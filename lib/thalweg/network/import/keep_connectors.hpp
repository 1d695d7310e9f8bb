// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/river_files.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::network {

/// Keeps the artificial channels that rivers need: where a river ends at one, the shortest way through `channels` to
/// another river (against the drawn direction three times as long). Lines flow by their heights where these differ,
/// else as drawn; rivers with more ends than sources are drawn upstream.
/// \param rivers lines [m], with channels
/// \param snap_m [m] >= 0, ends closer than this meet; 0: 1e-6 of the box's diagonal
/// \param run progress, log, stop token and number of threads
/// \return needed parts of channels are in `lines`, with a finding "connector" [m] each; all other parts are in
/// `secondary` by their reason; `channels` is empty
/// \throws Cancelled
RiverLines keep_connectors(RiverLines rivers, double snap_m, Run const& run = {});

} // namespace thalweg::network
