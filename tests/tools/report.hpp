// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "command.hpp"

/// The report.json of a folder.
inline nlohmann::json report_of(std::filesystem::path const& folder) {
    return nlohmann::json::parse(file_bytes(folder / "report.json"));
}

/// Every check of a report holds.
inline void expect_checks_hold(nlohmann::json const& report, std::string const& words = "") {
    for (auto const& check : report["checks"]) {
        EXPECT_TRUE(check["ok"].get<bool>()) << words << check;
    }
}
