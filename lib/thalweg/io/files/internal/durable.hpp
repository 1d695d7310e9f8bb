// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace thalweg::io {

/// Waits until a file, or a folder's list of names, is on the disk: a rename that follows then never names what a power
/// failure has cut. Takes: the path; who writes, for messages. Throws: IoError with the system's reason. Private to
/// this module.
void make_durable(std::filesystem::path const& place, std::string const& who);

/// Likewise every file and folder below a folder, and the folder.
void make_all_durable(std::filesystem::path const& folder, std::string const& who);

} // namespace thalweg::io
