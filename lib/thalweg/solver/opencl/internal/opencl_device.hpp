// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <string>

namespace thalweg::solver {

/// The chosen device, ready for work: one for the life of the process, made when it is first asked for. A handle is
/// OpenCL's own pointer.
struct OpenClDevice {
    void* device = nullptr;
    void* context = nullptr;
    std::string name;
    std::int64_t memory_bytes = 0;        ///< of the device
    std::int64_t largest_block_bytes = 0; ///< that can be taken at once
};

/// Throws: as opencl_device_name().
OpenClDevice const& opencl_device();

/// What OpenCL's numbers mean: "CL_OUT_OF_RESOURCES".
std::string opencl_error_name(int code);

/// Throws: IoError with both numbers when blocks of these sizes do not fit into the device's memory.
/// Takes: the stage that asks, for the message; bytes of all blocks and of the largest.
void check_device_memory(OpenClDevice const& device, char const* stage, std::int64_t bytes, std::int64_t largest_bytes);

} // namespace thalweg::solver
