// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/gdal/driver.hpp>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <unistd.h>
#include <utility>
#include <vector>

#include <cpl_error.h>
#include <gdal_priv.h>
#include <ogr_srs_api.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/gdal/internal/access.hpp>

namespace thalweg::io {

namespace {

struct KeptErrors {
    std::vector<std::string> errors; // the first few: a corrupt file can cause one per tile
    bool is_cut = false;             // memory was insufficient for more
};

constexpr std::size_t errors_kept = 4;

// After an error of this level (a failed allocation) GDAL calls abort().
void end_if_fatal(CPLErr level, char const* text) {
    if (level != CE_Fatal) {
        return;
    }
    for (char const* const part : {"error: ", text, "\n"}) {
        [[maybe_unused]] auto const written = write(STDERR_FILENO, part, std::strlen(part));
    }
    std::_Exit(EXIT_FAILURE);
}

void CPL_STDCALL note(CPLErr level, CPLErrorNum, char const* text) noexcept {
    end_if_fatal(level, text);
    if (level < CE_Failure) {
        return;
    }
    auto& [errors, is_cut] = *static_cast<KeptErrors*>(CPLGetErrorHandlerUserData());
    try {
        if (errors.size() < errors_kept && std::ranges::find(errors, text) == errors.end()) {
            errors.emplace_back(text);
        }
    } catch (std::exception const&) { // exceptions must not cross C frames
        is_cut = true;
    }
}

// For threads without a Driver.
void CPL_STDCALL note_elsewhere(CPLErr level, CPLErrorNum number, char const* text) {
    end_if_fatal(level, text);
    CPLDefaultErrorHandler(level, number, text);
}

} // namespace

struct Driver::Log : KeptErrors {};

Driver::Driver() : log_(std::make_unique<Log>()) {
    // Not call_once: an exception (out of memory) would cross C frames.
    [[maybe_unused]] static bool const is_registered = [] {
        GDALAllRegister();
        guard_gdal();
        if (!is_gdal_shared()) {
            CPLSetErrorHandler(note_elsewhere);
            OSRSetPROJEnableNetwork(0); // a datum grid downloaded on one machine would change coordinates only there
        }
        return true;
    }();
    enter_gdal();
    CPLPushErrorHandlerEx(note, static_cast<KeptErrors*>(log_.get()));
}

Driver::~Driver() {
    CPLPopErrorHandler();
    leave_gdal();
}

std::string Driver::take() const {
    std::string words = std::exchange(log_->is_cut, false) ? "out of memory" : "";
    for (auto const& error : std::exchange(log_->errors, {})) {
        words += (words.empty() ? "" : "; ") + error;
    }
    return words;
}

void Driver::check(std::string const& where, std::string const& name) const {
    if (auto const words = take(); !words.empty()) {
        throw_refusal(take_refusal(), {where, name});
        std::string const beginning = name.empty() ? "" : name + ": ";
        refuse_if<BadInput>(
            words.find("ALLOW_NETWORK_ACCESS=NO") != std::string::npos, where,
            "{}thalweg connects only to what the command line names; take the address out of the file ({})", beginning,
            words);
        refuse_if<BadInput>(words.find("crs not found") != std::string::npos, where,
                            "{}it names a CRS that does not exist ({}); correct it, or assign another (ogr2ogr or "
                            "gdal_edit.py -a_srs EPSG:n)",
                            beginning, words);
        throw IoError(where, beginning + words);
    }
}

std::string gdal_version() {
    return std::string("GDAL ") + GDALVersionInfo("RELEASE_NAME");
}

} // namespace thalweg::io
