// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/run/run.hpp>
#include <thalweg/core/tin.hpp>

namespace thalweg::blend {

/// Two meshes become one.
struct FusedTin {
    Tin tin;
    std::int64_t removed = 0; ///< vertices of the target inside the patch's outline
    std::int64_t inner = 0;   ///< vertices of the patch inside its outline
    std::int64_t added = 0;   ///< vertices on the outline that the target does not have
    double lift_max_m = 0.0;  ///< greatest distance by which an edge vertex of the patch is raised or lowered
    double residual = 0.0;    ///< as PastedTin
};

/// Pastes a mesh into another without a seam: the region inside the patch's outline takes the patch's triangles and
/// follows its gradients, its outline takes the target's heights.
/// \pre both with one height at each place in plan, the target in any number of parts; a patch with one boundary, in
/// the target's coordinates.
/// \param target [m] the DEM that is changed; NaN: no data
/// \param patch the patch
/// \param run progress, log, stop token and number of threads
/// \return a TIN: the target's vertices outside with their bits; around the outline the target's triangles, cut along
/// it; inside the patch's triangles, cut where target edges cross its outline, and its vertices in their order. Heights
/// inside are those of paste_tin with the patch's gradients as guidance and the outline fixed. A patch cut out of the
/// target, in its own place, gives the target's heights back, to rounding.
/// \throws BadInput as facing_up, outline_of and cut_tin do, also where vertices of the two meshes lie too close to one
/// another
/// \throws NotConverged
/// \throws Cancelled
///
/// Source: \cite nenu2015, algorithm 1 and equations 14 to 16; \cite yu2004 (merging).
FusedTin fuse_tin(Tin const& target, Tin const& patch, Run const& run = {});

} // namespace thalweg::blend
