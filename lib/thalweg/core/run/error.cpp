// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/run/error.hpp>

#include <new>

namespace thalweg {

Error::Error(std::string const& where, std::string const& what) : std::runtime_error(what), where_(where) {}

char const* words_of(std::exception const& error) noexcept {
    return dynamic_cast<std::bad_alloc const*>(&error) != nullptr ? out_of_memory : error.what();
}

} // namespace thalweg
