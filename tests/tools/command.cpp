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

void Workplace::shell(std::string const& command) const {
    std::string const line = "cd '" + path_.string() + "' && (" + command + ") >shell.log 2>&1";
    EXPECT_EQ(std::system(line.c_str()), 0) << command << "\n" << file_bytes(path_ / "shell.log");
    fs::remove(path_ / "shell.log");
}

std::map<std::string, std::string> content(fs::path const& folder) {
    std::map<std::string, std::string> all;
    for (auto const& entry : fs::recursive_directory_iterator(folder)) {
        all[entry.path().lexically_relative(folder).string()] =
            entry.is_regular_file() ? file_bytes(entry.path()) : std::string();
    }
    return all;
}

void expect_refused(Workplace const& place, std::string const& command, std::vector<std::string> const& arguments) {
    auto const before = content(place.path());
    for (std::string const& words : arguments) {
        SCOPED_TRACE(command + " " + words);
        Outcome const run = expect_run(place, command + " " + words, 2);
        EXPECT_TRUE(test::has("\n" + run.err, "\nerror: "));
        EXPECT_EQ(run.out, "");
        EXPECT_TRUE(content(place.path()) == before);
    }
}

nlohmann::json report_of(fs::path const& folder) {
    return nlohmann::json::parse(file_bytes(folder / "report.json"));
}

void expect_checks_hold(nlohmann::json const& report, std::string const& words) {
    for (auto const& check : report["checks"]) {
        EXPECT_TRUE(check["ok"].get<bool>()) << words << check;
    }
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
