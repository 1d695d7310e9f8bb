// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \cpponly

#include <string>
#include <vector>

namespace thalweg::solver {

/// Lists the OpenCL devices of this machine.
/// \return one line a device, "platform:device name (platform's name)", with the numbers for THALWEG_OPENCL_DEVICE, and
/// the reason if it cannot be used; empty: none
std::vector<std::string> opencl_devices();

/// Finds the device that Device::opencl uses: the one in the environment variable THALWEG_OPENCL_DEVICE, else the first
/// usable graphics card, else accelerator, else processor.
/// \return its name
/// \throws BadParameter when there is none, or the variable does not name a usable one
std::string opencl_device_name();

} // namespace thalweg::solver
