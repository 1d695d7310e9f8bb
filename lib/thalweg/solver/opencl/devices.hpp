// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace thalweg::solver {

/// The OpenCL devices of this machine.
/// \return one line a device, "platform:device name (platform's name)"; the numbers are what THALWEG_OPENCL_DEVICE
/// takes. Devices that cannot be used say why. Empty where there is none.
std::vector<std::string> opencl_devices();

/// \return the name of the device that Device::opencl stands for: the one that the environment's variable
/// THALWEG_OPENCL_DEVICE names, else the first graphics card, else the first accelerator, else the first processor that
/// can be used.
/// \throws BadParameter when there is none, or the variable names none that can be used
std::string opencl_device_name();

} // namespace thalweg::solver
