// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <concepts>
#include <string>
#include <string_view>

#include <fmt/core.h>

#include <thalweg/core/run/error.hpp>

namespace thalweg {

/// Throws an error with a formatted message.
/// \tparam Fault an Error
/// \param where the function that throws: "module.function"
/// \param words,args as fmt::vformat takes them
template <class Fault>
[[noreturn, gnu::cold, gnu::noinline]] void refuse(std::string_view where, fmt::string_view words,
                                                   fmt::format_args args) {
    throw Fault(std::string(where), fmt::vformat(words, args));
}

/// Throws an error if something is wrong. Arguments are evaluated always, the message is formatted only then.
/// \tparam Fault an Error
/// \param is_wrong whether to throw
/// \param where the function that throws: "module.function"
/// \param words "what is wrong, at which place, what to do", as fmt::format takes it
/// \param args what the message's braces stand for
template <class Fault, class... Args>
[[gnu::always_inline]] inline void refuse_if(bool is_wrong, std::convertible_to<std::string_view> auto const& where,
                                             fmt::format_string<Args...> words, Args&&... args) {
    if (is_wrong) [[unlikely]] {
        refuse<Fault>(where, words, fmt::make_format_args(args...));
    }
}

} // namespace thalweg
