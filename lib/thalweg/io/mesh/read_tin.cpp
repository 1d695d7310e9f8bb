// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
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

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/io/mesh/tin.hpp>

namespace thalweg::io {
namespace {

constexpr std::int64_t most_bytes = std::int64_t{1} << 30;
constexpr std::uint64_t most_corners = 1000;
constexpr std::string_view blanks = " \t\r";

bool ends_in(std::string const& path, std::string_view ending) {
    return path.size() > ending.size() && std::equal(ending.rbegin(), ending.rend(), path.rbegin(), [](char a, char b) {
               return a == std::tolower(static_cast<unsigned char>(b));
           });
}

/// Text, read line by line and word by word.
class Words {
public:
    Words(std::string const& path, std::string_view text, Run const& run) : path_(path), rest_(text), run_(run) {}

    /// Advances to the next line.
    /// \return whether there is one
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
    /// \return the next word of the line; "": its end.
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
    /// \return the rest of the line.
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
    /// Reads the number of a vertex; of OBJ's a/b/c the first.
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
    std::vector<std::uint64_t> corners(std::size_t count) {
        std::vector<std::uint64_t> face;
        while (face.size() < count) {
            face.push_back(index());
        }
        return face;
    }
    /// Reads the numbers in the rest of the line.
    std::vector<std::uint64_t> corners() {
        std::vector<std::uint64_t> face;
        while (face.size() < 3 || !remainder().empty()) {
            face.push_back(index());
        }
        return face;
    }
    /// Reads the comments written by write_tin.
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

using FaceList = std::vector<std::vector<std::uint64_t>>; // corners, counted from 0

void read_2dm(Words& words, TinFile& file, FaceList& faces) {
    std::unordered_map<std::uint64_t, std::uint64_t> number; // index of a node by its id
    while (words.next_line()) {
        std::string_view const word = words.word();
        if (word == "ND") {
            if (!number.emplace(words.index(), file.tin.vertices.size()).second) {
                words.refuse("two nodes have this number");
            }
            file.tin.vertices.push_back(words.vertex());
        } else if (word == "E3T" || word == "E4Q") {
            words.index();
            faces.push_back(words.corners(word == "E3T" ? 3 : 4));
        } else if (word.size() == 3 && word[0] == 'E' && word[1] >= '2' && word[1] <= '9') {
            words.refuse(fmt::format("{} is neither a triangle (E3T) nor a quadrilateral (E4Q)", word));
        } else if (word == "MESHNAME") {
            words.comment(words.remainder(), file);
        }
    }
    for (auto& face : faces) {
        for (std::uint64_t& v : face) {
            auto const found = number.find(v);
            v = found == number.end() ? file.tin.vertices.size() : found->second;
        }
    }
}

void read_obj(Words& words, TinFile& file, FaceList& faces) {
    while (words.next_line()) {
        std::string_view const word = words.word();
        if (word == "#") {
            words.comment(words.remainder(), file);
        } else if (word == "v") {
            file.tin.vertices.push_back(words.vertex());
        } else if (word == "f") {
            faces.push_back(words.corners());
            for (std::uint64_t& v : faces.back()) {
                --v; // 0 becomes a number beyond all others
            }
        }
    }
}

/// Advances to the next line with content.
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

void read_off(Words& words, TinFile& file, FaceList& faces) {
    if (!next_of_off(words, file) || words.word() != "OFF" || !next_of_off(words, file)) {
        words.refuse("an OFF file begins with OFF and three counts");
    }
    std::uint64_t const vertices = words.index();
    std::uint64_t const announced = words.index();
    for (std::uint64_t i = 0; i < vertices; ++i) {
        if (!next_of_off(words, file)) {
            words.refuse(fmt::format("the file ends after {} of {} vertices", i, vertices));
        }
        file.tin.vertices.push_back(words.vertex());
    }
    for (std::uint64_t i = 0; i < announced; ++i) {
        if (!next_of_off(words, file)) {
            words.refuse(fmt::format("the file ends after {} of {} faces", i, announced));
        }
        std::uint64_t const count = words.index();
        if (count < 3 || count > most_corners) {
            words.refuse(fmt::format("a face with {} corners", count));
        }
        faces.push_back(words.corners(count));
    }
}

double squared_distance(std::vector<Vec3> const& vertices, std::uint32_t a, std::uint32_t b) {
    Vec3 const d{vertices[a].x - vertices[b].x, vertices[a].y - vertices[b].y, vertices[a].z - vertices[b].z};
    return d.x * d.x + d.y * d.y + d.z * d.z;
}

/// Twice the area of a triangle in plan, positive counterclockwise.
double twice_area(std::vector<Vec3> const& vertices, std::array<std::uint32_t, 3> const& t) {
    Vec3 const a = vertices[t[0]];
    Vec3 const b = vertices[t[1]];
    Vec3 const c = vertices[t[2]];
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Splits a face with more than three corners into triangles: repeatedly cuts off the corner whose neighbours are
/// closest together, if the cut lies inside the face. Quadrilaterals are split along their shorter diagonal.
class FaceCutter {
public:
    FaceCutter(std::vector<std::uint32_t> face, std::vector<Vec3> const& vertices)
        : face_(std::move(face)), vertices_(vertices) {
        for (std::size_t k = 2; k < face_.size(); ++k) {
            area_ += twice_area(vertices_, {face_[0], face_[k - 1], face_[k]});
        }
    }

    void cut(std::vector<std::array<std::uint32_t, 3>>& triangles) {
        while (face_.size() > 3) {
            std::size_t const k = next();
            triangles.push_back(ear(k));
            face_.erase(face_.begin() + static_cast<std::ptrdiff_t>(k));
        }
        triangles.push_back({face_[0], face_[1], face_[2]});
    }

private:
    using Triangle = std::array<std::uint32_t, 3>;

    Triangle ear(std::size_t k) const {
        std::size_t const n = face_.size();
        return {face_[(k + n - 1) % n], face_[k % n], face_[(k + 1) % n]};
    }
    bool turns(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
        return area_ < 0.0 ? twice_area(vertices_, {a, b, c}) < 0.0 : twice_area(vertices_, {a, b, c}) > 0.0;
    }
    /// Whether the third side of the triangle lies inside the face.
    bool is_inside(Triangle const& t) const {
        return turns(t[0], t[1], t[2]) && std::ranges::none_of(face_, [&](std::uint32_t v) {
                   return v != t[0] && v != t[1] && v != t[2] && turns(t[0], t[1], v) && turns(t[1], t[2], v) &&
                          !turns(t[0], t[2], v); // or on the third side
               });
    }
    std::size_t next() const {
        std::size_t const n = face_.size();
        std::size_t best = n;
        std::size_t shortest = 0;
        auto const side = [&](std::size_t k) { return squared_distance(vertices_, ear(k)[0], ear(k)[2]); };
        for (std::size_t k = 0; k < n; ++k) {
            shortest = side(k) < side(shortest) ? k : shortest;
            if ((best == n || side(k) < side(best)) && is_inside(ear(k)) && (n > 4 || is_inside(ear(k + 2)))) {
                best = k;
            }
        }
        return best == n ? shortest : best; // a vertical face, or one that crosses itself
    }

    std::vector<std::uint32_t> face_;
    std::vector<Vec3> const& vertices_;
    double area_ = 0.0; ///< twice the area, in plan
};

/// The corners of a face as numbers of vertices, without consecutive duplicates.
std::vector<std::uint32_t> corners_of(std::vector<std::uint64_t> const& face) {
    std::vector<std::uint32_t> corners;
    for (std::uint64_t const v : face) {
        auto const corner = static_cast<std::uint32_t>(v);
        if (face.size() == 3 || corners.empty() || corners.back() != corner) {
            corners.push_back(corner);
        }
    }
    while (corners.size() > 3 && corners.front() == corners.back()) {
        corners.pop_back();
    }
    return corners;
}

} // namespace

bool holds_tin(std::string const& path) {
    return ends_in(path, ".2dm") || ends_in(path, ".obj") || ends_in(path, ".off");
}

TinFile read_tin(std::string const& path, Run const& run) {
    refuse_if<BadInput>(!holds_tin(path), "io.read_tin: {} is not a mesh in 2DM, OBJ or OFF", path);
    std::string const text = read_text(path, most_bytes);
    Words words(path, text, run);
    TinFile file;
    FaceList faces;
    if (ends_in(path, ".2dm")) {
        read_2dm(words, file, faces);
    } else if (ends_in(path, ".obj")) {
        read_obj(words, file, faces);
    } else {
        read_off(words, file, faces);
    }
    for (std::size_t i = 0; i < faces.size(); ++i) {
        if (std::ranges::any_of(faces[i], [&](std::uint64_t v) { return v >= file.tin.vertices.size(); })) {
            throw BadInput(fmt::format("io.read_tin: {}: face {} names a vertex that is not there", path, i + 1));
        }
        std::vector<std::uint32_t> corners = corners_of(faces[i]);
        refuse_if<BadInput>(corners.size() < 3, "io.read_tin: {}: face {} has fewer than three corners", path, i + 1);
        file.split += corners.size() > 3 ? 1 : 0;
        FaceCutter(std::move(corners), file.tin.vertices).cut(file.tin.triangles);
    }
    refuse_if<BadInput>(file.tin.triangles.empty(), "io.read_tin: {} has no triangles", path);
    if (file.split > 0) {
        file.findings.push_back(
            {.kind = "split_faces",
             .amount = static_cast<double>(file.split),
             .text = fmt::format("{}: {} faces with more than three corners are cut into triangles", path, file.split),
             .layer = path});
    }
    return file;
}

} // namespace thalweg::io
