// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "terminal/threads.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <new>
#include <system_error>
#include <thread>
#include <unistd.h>
#include <vector>

namespace thalweg::tools {

bool can_start_threads(int wanted) {
    if (wanted == 1) {
        return true;
    }
    long const count = wanted > 0 ? wanted : std::max<long>(sysconf(_SC_NPROCESSORS_ONLN), 1);
    std::atomic<bool> done = false;
    std::vector<std::thread> threads;
    bool all = true;
    try {
        threads.reserve(2 * static_cast<std::size_t>(count));
        while (threads.size() < threads.capacity()) {
            threads.emplace_back([&done] { done.wait(false); });
        }
    } catch (std::system_error const&) { // a limit on processes
        all = false;
    } catch (std::bad_alloc const&) { // or on memory
        all = false;
    }
    done = true;
    done.notify_all();
    for (std::thread& thread : threads) {
        thread.join();
    }
    return all;
}

} // namespace thalweg::tools
