// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/gdal/internal/virtual_files.hpp>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <string_view>
#include <system_error>

#include <cpl_conv.h>
#include <cpl_minixml.h>
#include <cpl_string.h>
#include <cpl_vsi.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/files/internal/files.hpp>

namespace thalweg::io {

namespace fs = std::filesystem;

namespace {

constexpr int deepest = 8; ///< virtual rasters in one another

struct DestroyTree {
    void operator()(CPLXMLNode* node) const { CPLDestroyXMLNode(node); }
};
using Tree = std::unique_ptr<CPLXMLNode, DestroyTree>;

/// The beginning of a file, as GDAL's drivers see it.
std::string head_of(std::string const& name) {
    std::array<char, 1024> bytes{};
    VSILFILE* const file = VSIFOpenL(name.c_str(), "rb");
    if (file == nullptr) {
        return "";
    }
    std::size_t const count = VSIFReadL(bytes.data(), 1, bytes.size(), file);
    VSIFCloseL(file);
    return {bytes.data(), count};
}

bool is_virtual(std::string const& head) {
    return head.find("<VRTDataset") != std::string::npos || head.find("<OGRVRTDataSource") != std::string::npos ||
           head.find("<GDALTileIndexDataset") != std::string::npos;
}

/// Looks into virtual files.
class Follower {
public:
    /// \param path the user's
    Follower(std::string const& path, bool is_disguised) : path_(path), is_disguised_(is_disguised) {}

    void follow(std::string const& name, int depth) const {
        constexpr std::string_view scheme = "vrt://";
        if (name.starts_with(scheme)) {
            follow(name.substr(scheme.size(), name.find('?') - scheme.size()), depth);
            return;
        }
        bool const is_text = is_virtual(name);
        if (!is_text && !is_virtual(head_of(name))) {
            return;
        }
        refuse_if<BadInput>(
            depth > deepest, "io.open_unchanged",
            "{} names virtual files that name others, more than {} deep: make a GeoTIFF of it (gdal_translate)", path_,
            deepest);
        CPLErrorHandlerPusher const quiet(CPLQuietErrorHandler);
        Tree const tree(is_text ? CPLParseXMLString(name.c_str()) : CPLParseXMLFile(name.c_str()));
        look(tree.get(), is_text ? "" : fs::path(name).parent_path(), depth);
    }

private:
    void look(CPLXMLNode const* node, fs::path const& folder, int depth) const {
        for (; node != nullptr; node = node->psNext) {
            refuse_if<BadInput>(node->eType == CXT_Attribute && EQUAL(node->pszValue, "subClass") &&
                                    node->psChild != nullptr && EQUAL(node->psChild->pszValue, "VRTRawRasterBand"),
                                "io.open_unchanged",
                                "{} reads the bytes of another file as heights (VRTRawRasterBand), whatever that file "
                                "is: convert the file itself to GeoTIFF (gdal_translate)",
                                path_);
            bool const names_source = node->eType == CXT_Element && (EQUAL(node->pszValue, "SourceFilename") ||
                                                                     EQUAL(node->pszValue, "SourceDataset") ||
                                                                     EQUAL(node->pszValue, "SrcDataSource"));
            if (names_source) {
                fs::path source = CPLGetXMLValue(node, "", "");
                if (std::string_view(CPLGetXMLValue(node, "relativeToVRT", "0")) != "0") {
                    source = folder / source;
                }
                require_near(source);
                follow(source.string(), depth + 1);
            }
            look(node->psChild, folder, depth);
        }
    }

    void require_near(fs::path const& source) const {
        std::error_code failed;
        if (!is_disguised_ || !fs::exists(source, failed)) {
            return; // what is no file is left to the file systems' guard
        }
        fs::path const near = fs::weakly_canonical(fs::absolute(path_, failed), failed).parent_path();
        fs::path const own = fs::weakly_canonical(fs::absolute(path_, failed).parent_path(), failed);
        std::string const real = fs::weakly_canonical(fs::absolute(source, failed), failed).string();
        refuse_if<BadInput>(!real.starts_with((near / "").string()) && !real.starts_with((own / "").string()),
                            "io.open_unchanged",
                            "{} is a virtual file (VRT), though its name does not say so, and names {} outside its "
                            "folder: if you know it, rename it to .vrt",
                            path_, source.string());
    }

    std::string const& path_;
    bool const is_disguised_;
};

} // namespace

bool is_virtual_in_disguise(std::string const& name, std::string const& path) {
    if (lower_extension(path) == ".vrt") {
        return false;
    }
    constexpr std::array beside{"", ".msk", ".ovr"};
    return std::ranges::any_of(beside, [&](char const* ending) { return is_virtual(head_of(name + ending)); });
}

void require_honest_sources(std::string const& name, std::string const& path, bool is_disguised) {
    Follower(path, is_disguised).follow(name, 1);
    for (char const* const ending : {".msk", ".ovr"}) { // what they name elsewhere is closed, and not needed
        Follower(path, false).follow(name + ending, 1);
    }
}

} // namespace thalweg::io
