// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace thalweg::io {

/// What the name of every temporary file of this process holds: "thalweg-tmp-HOST-PID". Private to this module.
std::string temporary_mark();

/// Removes the temporary files and folders in a folder that processes of this host left when they were killed. Where
/// one died while it moved old files aside, all stays: NAME-old beside NAME holds files of the user. What cannot be
/// removed stays without a word.
void sweep_leftovers(std::filesystem::path const& folder) noexcept;

} // namespace thalweg::io
