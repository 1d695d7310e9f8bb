// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sys/wait.h>

#include "command.hpp"

namespace fs = std::filesystem;

Workplace::Workplace() {
    std::string name = (fs::temp_directory_path() / "thalweg-test-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) {
        throw std::runtime_error("no temporary folder");
    }
    path_ = name;
}

Workplace::~Workplace() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

void Workplace::write(std::string const& name, std::string const& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
}

std::string file_bytes(fs::path const& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

Outcome thalweg_run(std::string const& arguments, fs::path const& folder) {
    Workplace const aside;
    fs::path const out = aside / "out";
    fs::path const err = aside / "err";
    std::string const command = "cd '" + folder.string() + "' && '" THALWEG_EXE "' " + arguments + " >'" +
                                out.string() + "' 2>'" + err.string() + "' </dev/null";
    int const status = std::system(command.c_str());
    Outcome outcome;
    outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    outcome.out = file_bytes(out);
    outcome.err = file_bytes(err);
    return outcome;
}
