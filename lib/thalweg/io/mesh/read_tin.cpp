// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/mesh/read_tin.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/files/files.hpp>

namespace thalweg::io {
namespace {

constexpr std::int64_t most_bytes = std::int64_t{1} << 30;
constexpr std::string_view blanks = " \t\r";

bool ends_in(std::string const& path, std::string_view ending) {
    return path.size() > ending.size() && std::equal(ending.rbegin(), ending.rend(), path.rbegin(), [](char a, char b) {
               return a == std::tolower(static_cast<unsigned char>(b));
           });
}

/// A text, line by line and word by word.
class Words {
public:
    Words(std::string const& path, std::string_view text, Run const& run) : path_(path), rest_(text), run_(run) {}

    /// Goes to the next line. Gives: whether there is one.
    bool next_line() {
        if (rest_.empty()) {
            return false;
        }
        if (++number_ % 65536 == 0) {
            run_.check();
        }
        std::size_t const end = rest_.find('\n');
        line_ = rest_.substr(0, end);
        rest_ = end == std::string_view::npos ? std::string_view() : rest_.substr(end + 1);
        return true;
    }
    /// The next word of the line; "" at its end.
    std::string_view word() {
        std::size_t const begin = line_.find_first_not_of(blanks);
        if (begin == std::string_view::npos) {
            line_ = {};
            return {};
        }
        std::size_t const end = std::min(line_.find_first_of(blanks, begin), line_.size());
        std::string_view const word = line_.substr(begin, end - begin);
        line_ = line_.substr(end);
        return word;
    }
    /// The line's end behind the words read.
    std::string_view remainder() const {
        std::size_t const begin = line_.find_first_not_of(blanks);
        return begin == std::string_view::npos ? std::string_view()
                                               : line_.substr(begin, line_.find_last_not_of(blanks) - begin + 1);
    }
    double coordinate() {
        std::string_view const text = word();
        double value = 0.0;
        auto const [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
            refuse(fmt::format("'{}' is not a coordinate", text));
        }
        return value;
    }
    /// A number of a vertex; of OBJ's a/b/c the first.
    std::uint64_t index() {
        std::string_view text = word();
        text = text.substr(0, text.find('/'));
        std::uint64_t value = 0;
        auto const [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc() || end != text.data() + text.size()) {
            refuse(fmt::format("'{}' is not the number of a vertex", text));
        }
        return value;
    }
    Vec3 vertex() {
        double const x = coordinate();
        double const y = coordinate();
        return {x, y, coordinate()};
    }
    std::array<std::uint64_t, 3> corners() {
        std::uint64_t const a = index();
        std::uint64_t const b = index();
        return {a, b, index()};
    }
    /// Takes what comments of write_tin say.
    void comment(std::string_view text, TinFile& file) const {
        if (text.find("heights in ") != std::string_view::npos) {
            refuse("its heights are not in metres; write the mesh in metres");
        }
        if (text.substr(0, 4) == "crs ") {
            file.crs = std::string(text.substr(4));
        }
    }
    [[noreturn]] void refuse(std::string const& what) const {
        throw BadInput(fmt::format("io.read_tin: {}, line {}: {}", path_, number_, what));
    }

private:
    std::string const& path_;
    std::string_view rest_;
    std::string_view line_;
    std::int64_t number_ = 0;
    Run const& run_;
};

using Corners = std::vector<std::array<std::uint64_t, 3>>;

void read_2dm(Words& words, TinFile& file, Corners& corners) {
    std::unordered_map<std::uint64_t, std::uint64_t> number; // of a node by its id
    while (words.next_line()) {
        std::string_view const word = words.word();
        if (word == "ND") {
            if (!number.emplace(words.index(), file.tin.vertices.size()).second) {
                words.refuse("two nodes have this number");
            }
            file.tin.vertices.push_back(words.vertex());
        } else if (word == "E3T") {
            words.index();
            corners.push_back(words.corners());
        } else if (word.size() == 3 && word[0] == 'E' && word[1] >= '2' && word[1] <= '9') {
            words.refuse(fmt::format("{} is not a triangle (E3T)", word));
        } else if (word == "MESHNAME") {
            words.comment(words.remainder(), file);
        }
    }
    for (auto& triangle : corners) {
        for (std::uint64_t& v : triangle) {
            auto const found = number.find(v);
            v = found == number.end() ? file.tin.vertices.size() : found->second;
        }
    }
}

void read_obj(Words& words, TinFile& file, Corners& corners) {
    while (words.next_line()) {
        std::string_view const word = words.word();
        if (word == "#") {
            words.comment(words.remainder(), file);
        } else if (word == "v") {
            file.tin.vertices.push_back(words.vertex());
        } else if (word == "f") {
            corners.push_back(words.corners());
            if (!words.remainder().empty()) {
                words.refuse("a face with more than three corners");
            }
            for (std::uint64_t& v : corners.back()) {
                --v; // 0 becomes a number beyond any
            }
        }
    }
}

/// The next line that says something.
bool next_of_off(Words& words, TinFile& file) {
    while (words.next_line()) {
        std::string_view const text = words.remainder();
        if (!text.empty() && text[0] != '#') {
            return true;
        }
        if (!text.empty()) {
            std::size_t const begin = text.find_first_not_of("# ");
            words.comment(begin == std::string_view::npos ? std::string_view() : text.substr(begin), file);
        }
    }
    return false;
}

void read_off(Words& words, TinFile& file, Corners& corners) {
    if (!next_of_off(words, file) || words.word() != "OFF" || !next_of_off(words, file)) {
        words.refuse("an OFF file begins with OFF and three counts");
    }
    std::uint64_t const vertices = words.index();
    std::uint64_t const faces = words.index();
    for (std::uint64_t i = 0; i < vertices; ++i) {
        if (!next_of_off(words, file)) {
            words.refuse(fmt::format("the file ends after {} of {} vertices", i, vertices));
        }
        file.tin.vertices.push_back(words.vertex());
    }
    for (std::uint64_t i = 0; i < faces; ++i) {
        if (!next_of_off(words, file)) {
            words.refuse(fmt::format("the file ends after {} of {} faces", i, faces));
        }
        if (words.index() != 3) {
            words.refuse("a face that is not a triangle");
        }
        corners.push_back(words.corners());
    }
}

} // namespace

bool holds_tin(std::string const& path) {
    return ends_in(path, ".2dm") || ends_in(path, ".obj") || ends_in(path, ".off");
}

TinFile read_tin(std::string const& path, Run const& run) {
    if (!holds_tin(path)) {
        throw BadInput(fmt::format("io.read_tin: {} is not a mesh in 2DM, OBJ or OFF", path));
    }
    std::string const text = read_text(path, most_bytes);
    Words words(path, text, run);
    TinFile file;
    Corners corners;
    if (ends_in(path, ".2dm")) {
        read_2dm(words, file, corners);
    } else if (ends_in(path, ".obj")) {
        read_obj(words, file, corners);
    } else {
        read_off(words, file, corners);
    }
    for (std::size_t i = 0; i < corners.size(); ++i) {
        std::array<std::uint32_t, 3> triangle{};
        for (std::size_t k = 0; k < 3; ++k) {
            if (corners[i][k] >= file.tin.vertices.size()) {
                throw BadInput(
                    fmt::format("io.read_tin: {}: triangle {} names a vertex that is not there", path, i + 1));
            }
            triangle[k] = static_cast<std::uint32_t>(corners[i][k]);
        }
        file.tin.triangles.push_back(triangle);
    }
    if (file.tin.triangles.empty()) {
        throw BadInput(fmt::format("io.read_tin: {} has no triangles", path));
    }
    return file;
}

} // namespace thalweg::io
