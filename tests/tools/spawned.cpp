// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fcntl.h>
#include <signal.h>
#include <stdexcept>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include "spawned.hpp"

namespace fs = std::filesystem;

Spawned::Spawned(std::vector<std::string> words, fs::path const& folder, std::function<void()> const& prepare,
                 std::string const& program) {
    std::string name = (fs::temp_directory_path() / "thalweg-streams-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) {
        throw std::runtime_error("no temporary folder");
    }
    aside_ = name;
    words.insert(words.begin(), "thalweg");
    std::vector<char*> list;
    for (std::string& word : words) {
        list.push_back(word.data());
    }
    list.push_back(nullptr);
    std::string const out = aside_ / "out";
    std::string const err = aside_ / "err";
    pid_ = fork();
    if (pid_ != 0) {
        return;
    }
    int const none = open("/dev/null", O_RDONLY);
    int const to_out = open(out.c_str(), O_WRONLY | O_CREAT, 0600);
    int const to_err = open(err.c_str(), O_WRONLY | O_CREAT, 0600);
    bool const ready = dup2(none, 0) == 0 && dup2(to_out, 1) == 1 && dup2(to_err, 2) == 2 && chdir(folder.c_str()) == 0;
    close(none);
    close(to_out);
    close(to_err);
    prepare();
    if (ready) {
        execv(program.c_str(), list.data());
    }
    _exit(99);
}

Spawned::~Spawned() {
    if (pid_ > 0) {
        kill(pid_, SIGKILL);
        waitpid(pid_, nullptr, 0);
    }
    std::error_code ignored;
    fs::remove_all(aside_, ignored);
}

Ended Spawned::wait(double most_s) {
    Ended ended;
    auto const begin = std::chrono::steady_clock::now();
    int status = 0;
    while (waitpid(pid_, &status, std::isfinite(most_s) ? WNOHANG : 0) == 0) {
        if (std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() > most_s) {
            ended.hung = true;
            kill(pid_, SIGKILL);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    pid_ = -1;
    ended.code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    ended.out = file_bytes(aside_ / "out");
    ended.err = file_bytes(aside_ / "err");
    return ended;
}

std::vector<std::string> small_make(std::string const& folder) {
    return {"make",  "-o",
            folder,  "-q",
            "--set", "grid.width=96",
            "--set", "grid.height=96",
            "--set", "network.dla.particles=1500",
            "--set", "network.prune=6"};
}

Workplace* MadeOnce::place_ = nullptr;

void MadeOnce::SetUpTestSuite() {
    place_ = new Workplace;
    ASSERT_EQ(spawn(small_make("base"), place_->path()).code, 0);
}

void MadeOnce::TearDownTestSuite() {
    delete place_;
    place_ = nullptr;
}

std::vector<std::string> names_in(fs::path const& folder) {
    std::vector<std::string> names;
    for (auto const& entry : fs::directory_iterator(folder)) {
        names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

std::string difference(fs::path const& folder, fs::path const& reference) {
    std::vector<std::string> const names = names_in(reference);
    if (names_in(folder) != names) {
        return "other files";
    }
    for (std::string const& name : names) {
        bool const is_report = name.rfind("report.", 0) == 0;
        if (!is_report && file_bytes(folder / name) != file_bytes(reference / name)) {
            return name;
        }
    }
    return "";
}
