// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/run/run.hpp>
#include <thalweg/core/tin.hpp>

namespace thalweg::blend {

/// Two meshes fused into one.
struct FusedTin {
    Tin tin;
    std::int64_t removed = 0; ///< vertices of the target inside the patch's outline
    std::int64_t inner = 0;   ///< vertices of the patch inside its outline
    std::int64_t added = 0;   ///< vertices on the outline that are not the target's
    double lift_max_m = 0.0;  ///< [m] largest vertical shift of a vertex on the patch's edge
    double residual = 0.0;    ///< as in PastedTin
};

/// Pastes a TIN into another without a seam: inside the patch's outline are the patch's triangles and gradients, on the
/// outline the target's heights.
/// \param target one height per position; any number of parts
/// \param patch one height per position, one boundary; in the target's coordinates
/// \param run progress, log, stop token and number of threads
/// \return the target's vertices outside bit for bit; around the outline its triangles, cut along the outline; inside
/// the patch's triangles, cut where target edges cross the outline, with vertices in their order. Heights inside are
/// those of paste_tin with the patch's gradients as guidance and a fixed outline. A patch cut from the target gives the
/// target's heights, to rounding.
/// \throws BadInput as facing_up, outline_of and cut_tin, also when vertices of the two meshes are too close
/// \throws NotConverged when the solver does not reach its tolerance
/// \throws Cancelled
///
/// Source: \cite nenu2015, algorithm 1 and equations 14 to 16; \cite yu2004 (merging).
FusedTin fuse_tin(Tin const& target, Tin const& patch, Run const& run = {});

} // namespace thalweg::blend
