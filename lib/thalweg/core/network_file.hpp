// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <thalweg/core/vec.hpp>

namespace thalweg {

/// A network file as it was read, before anything is believed of it.
struct NetworkFile {
    struct FileNode {
        std::int64_t id = 0;
        Vec3 at;
    };
    struct FileArc {
        std::int64_t id = 0;
        std::int64_t from_node = 0;
        std::int64_t to_node = 0;
        std::int64_t ds_arc = 0;
        std::int64_t strahler = 0;
        std::int64_t shreve = 0;
        std::int64_t basin = 0;
        std::vector<Vec3> line;
    };
    std::vector<FileNode> nodes;
    std::vector<FileArc> arcs;
};

} // namespace thalweg
