// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/mesh/internal/read_glb.hpp>
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
        line_ = cut_line();
        return true;
    }
    /// The same where a line that ends with a backslash goes on in the next.
    bool next_whole_line() {
        if (!next_line()) {
            return false;
        }
        auto const goes_on = [](std::string_view text) {
            std::size_t const last = text.find_last_not_of(blanks);
            return last != std::string_view::npos && text[last] == '\\';
        };
        if (goes_on(line_)) {
            joined_.clear();
            for (std::string_view part = line_;; part = cut_line()) {
                bool const is_last = !goes_on(part) || rest_.empty();
                joined_ += goes_on(part) ? part.substr(0, part.find_last_of('\\')) : part;
                joined_ += ' ';
                if (is_last) {
                    break;
                }
            }
            line_ = joined_;
        }
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
    std::uint64_t index() { return whole<std::uint64_t>(); }
    /// Reads the same from 1, or from the last of the vertices so far, which is -1.
    /// \return from 0; 2^64 - 1: there is no such vertex
    std::uint64_t index_among(std::size_t vertices) {
        auto const value = whole<std::int64_t>();
        std::int64_t const from_0 = value < 0 ? static_cast<std::int64_t>(vertices) + value : value - 1;
        return from_0 < 0 ? std::numeric_limits<std::uint64_t>::max() : static_cast<std::uint64_t>(from_0);
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
    std::vector<std::uint64_t> corners_among(std::size_t vertices) {
        std::vector<std::uint64_t> face;
        while (face.size() < 3 || !remainder().empty()) {
            face.push_back(index_among(vertices));
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
        throw BadInput("io.read_tin", fmt::format("{}, line {}: {}", path_, number_, what));
    }

private:
    std::string_view cut_line() {
        if (++number_ % 65536 == 0) {
            run_.check();
        }
        std::size_t const end = rest_.find('\n');
        std::string_view const line = rest_.substr(0, end);
        rest_ = end == std::string_view::npos ? std::string_view() : rest_.substr(end + 1);
        return line;
    }
    template <class Whole> Whole whole() {
        std::string_view text = word();
        text = text.substr(0, text.find('/'));
        Whole value = 0;
        auto const [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc() || end != text.data() + text.size()) {
            refuse(fmt::format("'{}' is not the number of a vertex", text));
        }
        return value;
    }

    std::string const& path_;
    std::string_view rest_;
    std::string_view line_;
    std::string joined_; ///< of a line in several parts
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

/// What the comments of an OBJ say of its coordinates.
struct ObjAxes {
    bool says_y_up = false;
    bool says_z_up = false;
    Vec3 origin = {};          ///< east, north, height
    double exaggeration = 1.0; ///< of heights above the origin
};

/// Reads the numbers that follow a word at the beginning of a comment of write_textured_obj.
template <std::size_t Count>
std::optional<std::array<double, Count>> numbers_after(std::string_view word, std::string_view text) {
    if (!text.starts_with(word)) {
        return std::nullopt;
    }
    std::array<double, Count> values{};
    char const* at = text.data() + word.size();
    char const* const last = text.data() + text.size();
    for (double& value : values) {
        while (at != last && *at == ' ') {
            ++at;
        }
        auto const [end, error] = std::from_chars(at, last, value);
        if (error != std::errc() || !std::isfinite(value)) {
            return std::nullopt;
        }
        at = end;
    }
    return values;
}

/// Reads "Y up", "y-up", "z is up" and the like, and the origin and exaggeration that write_textured_obj writes.
void take_axes(std::string_view text, ObjAxes& axes) {
    std::string simple;
    for (char const c : text) {
        simple += std::isalnum(static_cast<unsigned char>(c)) != 0
                      ? static_cast<char>(std::tolower(static_cast<unsigned char>(c)))
                      : ' ';
    }
    simple = " " + simple + " ";
    auto const says = [&](std::string_view axis) {
        return simple.find(fmt::format(" {} up ", axis)) != std::string::npos ||
               simple.find(fmt::format(" {} is up ", axis)) != std::string::npos;
    };
    axes.says_y_up = axes.says_y_up || says("y");
    axes.says_z_up = axes.says_z_up || says("z");
    if (auto const origin = numbers_after<3>("origin ", text)) {
        axes.origin = {(*origin)[0], (*origin)[1], (*origin)[2]};
    }
    if (auto const factor = numbers_after<1>("exaggeration ", text); factor && (*factor)[0] > 0.0) {
        axes.exaggeration = (*factor)[0];
    }
}

ObjAxes read_obj(Words& words, TinFile& file, FaceList& faces) {
    ObjAxes axes;
    while (words.next_whole_line()) {
        std::string_view const word = words.word();
        if (word.substr(0, 1) == "#") {
            words.comment(words.remainder(), file);
            take_axes(word.size() == 1 ? words.remainder() : word.substr(1), axes);
        } else if (word == "v") {
            file.tin.vertices.push_back(words.vertex());
        } else if (word == "f") {
            faces.push_back(words.corners_among(file.tin.vertices.size()));
        }
    }
    return axes;
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

/// Colours, normals and places in a picture follow the coordinates of a vertex, and are skipped.
void read_off(Words& words, TinFile& file, FaceList& faces) {
    constexpr std::array kinds{"OFF", "COFF", "NOFF", "CNOFF", "STOFF", "STCOFF", "STNOFF", "STCNOFF"};
    if (!next_of_off(words, file) || std::ranges::find(kinds, words.word()) == kinds.end()) {
        words.refuse("an OFF file begins with OFF (or COFF, NOFF, ...) and three counts, as text");
    }
    if (std::string_view const same = words.remainder(); same.empty() || same[0] == '#') {
        if (!next_of_off(words, file)) {
            words.refuse("the file ends after OFF");
        }
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

/// How triangles face in plan.
struct Facing {
    std::int64_t up = 0;
    std::int64_t down = 0;
    std::int64_t upright = 0; ///< without an area in plan
    bool is_folded() const {
        constexpr std::int64_t one_in = 100;
        return one_in * std::min(up, down) > up + down + upright || upright > up + down;
    }
};

/// \param turned plan with north to -z
Facing facing_of(Tin const& tin, bool turned) {
    Facing facing;
    auto const at = [&](std::uint32_t v) {
        Vec3 const& p = tin.vertices[v];
        return turned ? Vec2{p.x, -p.z} : Vec2{p.x, p.y};
    };
    for (auto const& t : tin.triangles) {
        Vec2 const ab = at(t[1]) - at(t[0]);
        Vec2 const ac = at(t[2]) - at(t[0]);
        double const area = ab.x * ac.y - ab.y * ac.x;
        double const noise = 1e-9 * (norm(ab) * norm(ac));
        (std::fabs(area) <= noise ? facing.upright : area > 0.0 ? facing.up : facing.down) += 1;
    }
    return facing;
}

/// Turns a mesh whose heights are on the y axis: y is up and south is z, as in OBJ files of most programs.
void turn_upright(TinFile& file, ObjAxes const& axes, std::string const& path) {
    if (!axes.says_y_up) {
        refuse_if<BadInput>(!axes.says_z_up && facing_of(file.tin, false).is_folded() &&
                                !facing_of(file.tin, true).is_folded(),
                            "io.read_tin",
                            "{} is folded in plan, with its heights on the y axis: export it with Z up (Blender: "
                            "Forward Axis Y, Up Axis Z), or begin it with the line \"# Y up\"",
                            path);
        return;
    }
    for (Vec3& v : file.tin.vertices) {
        v = {v.x + axes.origin.x, axes.origin.y - v.z, v.y / axes.exaggeration + axes.origin.z};
    }
    file.findings.push_back(
        {.kind = "mesh_turned",
         .text = fmt::format(
             "{}: Y is up in it; x is taken as east, -z as north, y as the height{}", path,
             axes.exaggeration == 1.0 ? "" : fmt::format(" without its exaggeration of {:.6g}", axes.exaggeration)),
         .layer = path});
}

/// Vertices at one place become one, the first: meshes are often written triangle by triangle.
void weld(TinFile& file, std::string const& path) {
    constexpr double share = 1e-8; // of the extent
    std::vector<Vec3>& vertices = file.tin.vertices;
    Vec3 low = vertices.front();
    Vec3 high = low;
    for (Vec3 const& v : vertices) {
        low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
        high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
    }
    double const within_m = share * std::max({high.x - low.x, high.y - low.y, high.z - low.z});
    if (!(within_m > 0.0)) {
        return;
    }
    using Key = std::array<std::int64_t, 3>;
    struct Hash { // only looked up, never iterated
        std::size_t operator()(Key const& k) const {
            std::uint64_t h = 0;
            for (std::int64_t const c : k) {
                h = (h ^ static_cast<std::uint64_t>(c)) * 0x9e3779b97f4a7c15ULL;
                h ^= h >> 29U;
            }
            return static_cast<std::size_t>(h);
        }
    };
    auto const cell = [&](Vec3 const& v) {
        return Key{static_cast<std::int64_t>(std::floor((v.x - low.x) / within_m)),
                   static_cast<std::int64_t>(std::floor((v.y - low.y) / within_m)),
                   static_cast<std::int64_t>(std::floor((v.z - low.z) / within_m))};
    };
    auto const distance_2 = [](Vec3 const& a, Vec3 const& b) {
        Vec3 const d{a.x - b.x, a.y - b.y, a.z - b.z};
        return d.x * d.x + d.y * d.y + d.z * d.z;
    };
    std::unordered_map<Key, std::uint32_t, Hash> kept; // by cell: the first vertex
    kept.reserve(vertices.size());
    std::vector<std::uint32_t> number(vertices.size());
    std::vector<Vec3> unique;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        Key const at = cell(vertices[i]);
        std::uint32_t found = static_cast<std::uint32_t>(unique.size());
        auto const look = [&](Key const& key) {
            auto const same = kept.find(key);
            if (same != kept.end() && distance_2(unique[same->second], vertices[i]) <= within_m * within_m) {
                found = std::min(found, same->second);
            }
        };
        look(at);
        for (std::int64_t n = 0; n < 27 && found == unique.size(); ++n) {
            look({at[0] + n % 3 - 1, at[1] + n / 3 % 3 - 1, at[2] + n / 9 - 1});
        }
        number[i] = found;
        if (found == unique.size()) {
            kept.emplace(at, found);
            unique.push_back(vertices[i]);
        }
    }
    if (unique.size() == vertices.size()) {
        return;
    }
    std::size_t const before = vertices.size();
    vertices = std::move(unique);
    for (auto& t : file.tin.triangles) {
        t = {number[t[0]], number[t[1]], number[t[2]]};
    }
    std::size_t const collapsed =
        std::erase_if(file.tin.triangles, [](auto const& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
    refuse_if<BadInput>(file.tin.triangles.empty(), "io.read_tin", "{} has no triangles", path);
    file.findings.push_back(
        {.kind = "welded",
         .amount = static_cast<double>(before - vertices.size()),
         .text = fmt::format("{}: {} of {} vertices lie within {:.2g} m of others and are one with them{}", path,
                             before - vertices.size(), before, within_m,
                             collapsed == 0 ? "" : fmt::format("; {} triangles without area are left out", collapsed)),
         .layer = path});
}

/// A GLB, whose axes the format sets.
TinFile read_glb_file(std::string const& bytes, std::string const& path) {
    Driver const driver;
    GlbTriangles read = read_glb(bytes, {"io.read_tin", path});
    refuse_if<BadInput>(read.tin.triangles.empty(), "io.read_tin", "{} has no triangles", path);
    TinFile file;
    file.tin = std::move(read.tin);
    file.crs = std::move(read.crs);
    ObjAxes axes;
    axes.says_y_up = true;
    axes.origin = read.origin;
    axes.exaggeration = read.exaggeration;
    turn_upright(file, axes, path);
    weld(file, path);
    return file;
}

} // namespace

bool holds_tin(std::string const& path) {
    return ends_in(path, ".2dm") || ends_in(path, ".obj") || ends_in(path, ".off") || ends_in(path, ".glb");
}

TinFile read_tin(std::string const& path, Run const& run) {
    refuse_if<BadInput>(!holds_tin(path), "io.read_tin", "{} is not a mesh in 2DM, OBJ, OFF or GLB", path);
    std::string const text = read_text(path, most_bytes);
    if (ends_in(path, ".glb")) {
        return read_glb_file(text, path);
    }
    Words words(path, text, run);
    TinFile file;
    FaceList faces;
    ObjAxes axes;
    if (ends_in(path, ".2dm")) {
        read_2dm(words, file, faces);
    } else if (ends_in(path, ".obj")) {
        axes = read_obj(words, file, faces);
    } else {
        read_off(words, file, faces);
    }
    for (std::size_t i = 0; i < faces.size(); ++i) {
        if (std::ranges::any_of(faces[i], [&](std::uint64_t v) { return v >= file.tin.vertices.size(); })) {
            throw BadInput("io.read_tin", fmt::format("{}: face {} names a vertex that is not there", path, i + 1));
        }
        std::vector<std::uint32_t> corners = corners_of(faces[i]);
        refuse_if<BadInput>(corners.size() < 3, "io.read_tin", "{}: face {} has fewer than three corners", path, i + 1);
        file.split += corners.size() > 3 ? 1 : 0;
        FaceCutter(std::move(corners), file.tin.vertices).cut(file.tin.triangles);
    }
    refuse_if<BadInput>(file.tin.triangles.empty(), "io.read_tin", "{} has no triangles", path);
    if (file.split > 0) {
        file.findings.push_back(
            {.kind = "split_faces",
             .amount = static_cast<double>(file.split),
             .text = fmt::format("{}: {} faces with more than three corners are cut into triangles", path, file.split),
             .layer = path});
    }
    if (ends_in(path, ".obj")) {
        turn_upright(file, axes, path);
    }
    if (!ends_in(path, ".2dm")) { // whose nodes have ids
        weld(file, path);
    }
    return file;
}

} // namespace thalweg::io
