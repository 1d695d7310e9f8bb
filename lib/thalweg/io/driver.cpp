// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/driver.hpp>

#include <algorithm>
#include <mutex>
#include <utility>
#include <vector>

#include <cpl_error.h>
#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogr_srs_api.h>

#include <thalweg/core/error.hpp>
#include <thalweg/io/gdal_guard.hpp>

namespace thalweg::io {

struct Driver::Log {
    std::vector<std::string> errors; // the first few: a corrupt file can give one a tile
};

namespace {

constexpr std::size_t errors_kept = 4;

void CPL_STDCALL note(CPLErr level, CPLErrorNum, char const* text) {
    if (level < CE_Failure) {
        return;
    }
    auto& errors = *static_cast<std::vector<std::string>*>(CPLGetErrorHandlerUserData());
    if (errors.size() < errors_kept && std::ranges::find(errors, text) == errors.end()) {
        errors.emplace_back(text);
    }
}

} // namespace

Driver::Driver() : log_(std::make_unique<Log>()) {
    static std::once_flag once;
    std::call_once(once, [] {
        GDALAllRegister();
        guard_gdal();
        OSRSetPROJEnableNetwork(0); // a datum grid fetched on one machine only would change the coordinates there
    });
    CPLPushErrorHandlerEx(note, &log_->errors);
}

Driver::~Driver() {
    CPLPopErrorHandler();
}

std::string Driver::take() const {
    std::string words;
    for (auto const& error : std::exchange(log_->errors, {})) {
        words += (words.empty() ? "" : "; ") + error;
    }
    return words;
}

void Driver::check(std::string const& what) const {
    if (auto const words = take(); !words.empty()) {
        bool const by_guard = !take_refused_address().empty();
        if (by_guard || words.find("ALLOW_NETWORK_ACCESS=NO") != std::string::npos) {
            throw BadInput(fmt::format("{}: thalweg connects only to what the command line names; take the address out "
                                       "of the file ({})",
                                       what, words));
        }
        throw IoError(what + ": " + words);
    }
}

std::string gdal_version() {
    return std::string("GDAL ") + GDALVersionInfo("RELEASE_NAME");
}

} // namespace thalweg::io
