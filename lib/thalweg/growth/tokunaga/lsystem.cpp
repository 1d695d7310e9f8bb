// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/growth/tokunaga/lsystem.hpp>

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/refuse.hpp>

namespace thalweg::growth {

std::string write_lsystem(TokunagaTree const& tree) {
    std::string word;
    // The remaining output, the next last: a link, or -1 for the end of a branch.
    std::vector<LinkId> ahead{0};
    while (!ahead.empty()) {
        LinkId const number = ahead.back();
        ahead.pop_back();
        if (number < 0) {
            word += ']';
            continue;
        }
        TreeLink const& link = tree.links[number];
        if (link.turn != 0) {
            word += '[';
            word.append(static_cast<std::size_t>(std::abs(link.turn)), link.turn > 0 ? '+' : '-');
        }
        word += link.up[0] < 0 ? 'G' : 'F';
        if (link.turn != 0) {
            ahead.push_back(-1);
        }
        if (link.up[0] >= 0) {
            auto [first, second] = link.up;
            if (tree.links[first].turn == 0 || (tree.links[second].turn != 0 && second < first)) {
                std::swap(first, second);
            }
            ahead.push_back(second);
            ahead.push_back(first);
        }
    }
    return word;
}

std::string lsystem(TokunagaParams const& params, Run const& run) {
    return write_lsystem(grow_tokunaga(params, run));
}

namespace {

constexpr std::uint64_t rewrite_stage = 0x7265777269746531; // "rewrite1"
constexpr std::size_t most_signs = 20'000'000;
constexpr int most_iterations = 60;
constexpr std::size_t signs_between_checks = 1 << 20;

std::string_view trimmed(std::string_view s) {
    std::size_t const begin = s.find_first_not_of(" \t\r");
    return begin == std::string_view::npos ? std::string_view()
                                           : s.substr(begin, s.find_last_not_of(" \t\r") - begin + 1);
}

std::string without_blanks(std::string_view s) {
    std::string out;
    for (char const c : s) {
        if (c != ' ' && c != '\t' && c != '\r') {
            out += c;
        }
    }
    return out;
}

/// Reads the lines of a rules file one after another.
class RulesReader {
public:
    explicit RulesReader(std::string const& name) : name_(name) {}

    void take(std::string_view line) {
        ++number_;
        line = trimmed(line.substr(0, line.find('#')));
        if (line.empty()) {
            return;
        }
        if (std::size_t const arrow = line.find("->"); arrow != std::string_view::npos) {
            take_rule(trimmed(line.substr(0, arrow)), line.substr(arrow + 2));
            return;
        }
        std::size_t const blank = line.find_first_of(" \t");
        std::string_view const word = line.substr(0, blank);
        std::string_view const value = blank == std::string_view::npos ? "" : trimmed(line.substr(blank));
        if (word == "axiom") {
            system_.axiom = checked(without_blanks(value));
        } else if (word == "iterations") {
            system_.iterations = static_cast<int>(number(value, most_iterations, true));
        } else if (word == "angle") {
            system_.angle_deg = number(value, 180.0, false);
        } else {
            refuse(fmt::format("'{}' is not one of axiom, iterations, angle, SIGN -> WORD", line));
        }
    }

    LSystem finish() {
        refuse_if<BadInput>(system_.axiom.empty(), "growth.read_rules",
                            "{}: there is no axiom; write a line such as: axiom F", name_);
        return std::move(system_);
    }

private:
    [[noreturn]] void refuse(std::string const& what) const {
        throw BadInput("growth.read_rules", fmt::format("{}, line {}: {}", name_, number_, what));
    }

    std::string checked(std::string word) const {
        for (char const c : word) {
            if (c < '!' || c > '~') {
                refuse("words consist of printable ASCII signs");
            }
        }
        return word;
    }

    double number(std::string_view text, double most, bool whole) const {
        double value = -1.0;
        auto const [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc() || end != text.data() + text.size() || !(value >= 0.0 && value <= most) ||
            (whole && value != std::floor(value))) {
            refuse(fmt::format("'{}' is not a {}number from 0 to {}", text, whole ? "whole " : "", most));
        }
        return value;
    }

    void take_rule(std::string_view sign, std::string_view word) {
        if (sign.size() != 1 || sign == "[" || sign == "]") {
            refuse(fmt::format("before -> stands '{}', it must be one sign other than [ and ]", sign));
        }
        checked(std::string(sign));
        std::string successor = checked(without_blanks(word));
        int open = 0;
        for (char const c : successor) {
            open += c == '[' ? 1 : c == ']' ? -1 : 0;
            if (open < 0) {
                break;
            }
        }
        if (open != 0) {
            refuse("the brackets do not match");
        }
        system_.rules[sign.front()].push_back(std::move(successor));
    }

    std::string const& name_;
    int number_ = 0;
    LSystem system_;
};

void require_brackets(std::string_view word) {
    std::int64_t open = 0;
    for (std::size_t i = 0; i < word.size(); ++i) {
        open += word[i] == '[' ? 1 : word[i] == ']' ? -1 : 0;
        refuse_if<BadParameter>(open < 0, "growth.rewrite",
                                "the axiom closes a bracket at position {} that is not open", i + 1);
    }
    refuse_if<BadParameter>(open > 0, "growth.rewrite", "the axiom has a [ without its ]");
}

std::string rewritten(std::string const& word, LSystem const& system, std::uint64_t seed, int iteration,
                      Run const& run) {
    std::string next;
    for (std::size_t i = 0; i < word.size(); ++i) {
        if (i % signs_between_checks == 0) {
            run.check();
        }
        auto const rule = system.rules.find(word[i]);
        if (rule == system.rules.end()) {
            next += word[i];
        } else {
            std::vector<std::string> const& words = rule->second;
            std::size_t const which =
                words.size() == 1
                    ? 0
                    : static_cast<std::size_t>(
                          random_word(seed, rewrite_stage, static_cast<std::uint64_t>(iteration), i) % words.size());
            next += words[which];
        }
        refuse_if<BadParameter>(next.size() > most_signs, "growth.rewrite",
                                "after {} iterations the word has more than {} signs; ask for fewer iterations",
                                iteration + 1, most_signs);
    }
    return next;
}

struct Turtle {
    Vec2 at;
    int turns = 0;  ///< by angle_deg to the left
    int halves = 0; ///< half turns
};

} // namespace

LSystem read_rules(std::string_view text, std::string const& name) {
    RulesReader reader(name);
    while (!text.empty()) {
        std::size_t const end = text.find('\n');
        reader.take(text.substr(0, end));
        text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
    }
    return reader.finish();
}

std::string rewrite(LSystem const& system, std::uint64_t seed, Run const& run) {
    refuse_if<BadParameter>(system.iterations < 0 || system.iterations > most_iterations, "growth.rewrite",
                            "{} iterations; give 0 to {}", system.iterations, most_iterations);
    require_brackets(system.axiom);
    std::string word = system.axiom;
    for (int k = 0; k < system.iterations; ++k) {
        word = rewritten(word, system, seed, k, run);
    }
    return word;
}

std::vector<std::vector<Vec2>> draw_word(std::string_view word, double angle_deg, Run const& run) {
    double const angle = angle_deg / 180.0 * portable::pi;
    std::vector<std::vector<Vec2>> lines;
    std::vector<Turtle> remembered;
    Turtle turtle;
    bool is_drawing = false; // whether the last line ends at the turtle
    for (std::size_t i = 0; i < word.size(); ++i) {
        if (i % signs_between_checks == 0) {
            run.check();
        }
        char const sign = word[i];
        if ((sign >= 'A' && sign <= 'Z') || (sign >= 'a' && sign <= 'z')) {
            double const bearing = angle * turtle.turns + portable::pi * (turtle.halves % 2);
            Vec2 const from = turtle.at;
            turtle.at = {from.x - portable::sin(bearing), from.y + portable::cos(bearing)};
            bool const draws = sign <= 'Z';
            if (draws && !is_drawing) {
                lines.push_back({from});
            }
            if (draws) {
                lines.back().push_back(turtle.at);
            }
            is_drawing = draws;
        } else if (sign == '+' || sign == '-') {
            turtle.turns += sign == '+' ? 1 : -1;
        } else if (sign == '|') {
            ++turtle.halves;
        } else if (sign == '[') {
            remembered.push_back(turtle);
        } else if (sign == ']' && !remembered.empty()) {
            turtle = remembered.back();
            remembered.pop_back();
            is_drawing = false;
        }
    }
    return lines;
}

} // namespace thalweg::growth
