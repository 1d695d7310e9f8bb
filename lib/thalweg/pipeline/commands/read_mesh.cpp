// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/commands/internal/read_mesh.hpp>

#include <fmt/format.h>

namespace thalweg::pipeline {

io::TinFile read_mesh(std::string const& path, Run const& run) {
    io::TinFile file = io::read_tin(path, run);
    if (file.split > 0) {
        run.tell("note",
                 fmt::format("{}: {} faces with more than three corners are cut into triangles", path, file.split));
    }
    return file;
}

} // namespace thalweg::pipeline
