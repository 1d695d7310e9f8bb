// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fmt/core.h>

#include <thalweg/core/run/error.hpp>

namespace thalweg {

/// Throws an error with a formatted message.
/// \tparam Fault an Error
/// \param words,args as fmt::vformat takes them
template <class Fault>
[[noreturn, gnu::cold, gnu::noinline]] void refuse(fmt::string_view words, fmt::format_args args) {
    throw Fault(fmt::vformat(words, args));
}

/// Throws an error if something is wrong. Arguments are evaluated always, the message is formatted only then.
/// \tparam Fault an Error
/// \param is_wrong whether to throw
/// \param words "module.function: what is wrong, where, what to do", as fmt::format takes it
/// \param args what the message's braces stand for
template <class Fault, class... Args>
[[gnu::always_inline]] inline void refuse_if(bool is_wrong, fmt::format_string<Args...> words, Args&&... args) {
    if (is_wrong) [[unlikely]] {
        refuse<Fault>(words, fmt::make_format_args(args...));
    }
}

} // namespace thalweg
