// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/export/internal/glb.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <nlohmann/json.hpp>

#include <thalweg/core/run/refuse.hpp>

namespace thalweg::exports {
namespace {

using GlbJson = nlohmann::ordered_json;

// Numbers of the standard.
enum GlbNumber : std::uint32_t {
    glb_magic = 0x46546C67,
    glb_version = 2,
    glb_chunk_json = 0x4E4F534A,
    glb_chunk_bin = 0x004E4942,
    glb_of_float = 5126,
    glb_of_index = 5125,
    glb_of_vertices = 34962,
    glb_of_indices = 34963,
    glb_linear = 9729,
    glb_linear_mipmaps = 9987,
    glb_clamped = 33071,
    glb_lines = 1,
    glb_triangles = 4
};

void put_word(std::string& bytes, std::uint32_t value) {
    for (unsigned shift = 0; shift < 32; shift += 8) {
        bytes += static_cast<char>((value >> shift) & 0xFFU);
    }
}

void put_float(std::string& bytes, double value) {
    put_word(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(value)));
}

Vec3 y_up(Vec3 v) {
    return {v.x, v.z, -v.y + 0.0};
}

void put_vector(std::string& bytes, Vec3 v) {
    put_float(bytes, v.x);
    put_float(bytes, v.y);
    put_float(bytes, v.z);
}

/// The binary part, and what the JSON says of it.
class GlbBuffer {
public:
    std::string bytes;
    GlbJson views = GlbJson::array();
    GlbJson accessors = GlbJson::array();

    /// Describes the bytes since begin as one view.
    std::size_t end_view(std::size_t begin, std::uint32_t target) {
        GlbJson view{{"buffer", 0}, {"byteOffset", begin}, {"byteLength", bytes.size() - begin}};
        if (target != 0) {
            view["target"] = target;
        }
        bytes.resize((bytes.size() + 3) / 4 * 4, '\0');
        views.push_back(std::move(view));
        return views.size() - 1;
    }
    std::size_t end_accessor(std::size_t begin, std::uint32_t target, std::uint32_t component, std::size_t count,
                             char const* type) {
        accessors.push_back(GlbJson{
            {"bufferView", end_view(begin, target)}, {"componentType", component}, {"count", count}, {"type", type}});
        return accessors.size() - 1;
    }
    /// Positions need their limits, as stored.
    std::size_t add_positions(std::vector<Vec3> const& vertices) {
        std::size_t const begin = bytes.size();
        constexpr float far = std::numeric_limits<float>::infinity();
        std::array<float, 3> low = {far, far, far};
        std::array<float, 3> high = {-far, -far, -far};
        for (Vec3 const& vertex : vertices) {
            Vec3 const v = y_up(vertex);
            put_vector(bytes, v);
            std::size_t k = 0;
            for (double const c : {v.x, v.y, v.z}) {
                low[k] = std::min(low[k], static_cast<float>(c));
                high[k] = std::max(high[k], static_cast<float>(c));
                ++k;
            }
        }
        std::size_t const number = end_accessor(begin, glb_of_vertices, glb_of_float, vertices.size(), "VEC3");
        accessors[number]["min"] = low;
        accessors[number]["max"] = high;
        return number;
    }
};

/// Of all triangles at a vertex, by their areas.
std::vector<Vec3> normals_of(LatticeMesh const& mesh) {
    std::vector<Vec3> normals(mesh.vertices.size());
    for (auto const& t : mesh.triangles) {
        Vec3 const normal = cross(mesh.vertices[t[1]] - mesh.vertices[t[0]], mesh.vertices[t[2]] - mesh.vertices[t[0]]);
        for (std::uint32_t const v : t) {
            normals[v] = normals[v] + normal;
        }
    }
    for (Vec3& normal : normals) {
        normal = (1.0 / norm(normal)) * normal;
    }
    return normals;
}

GlbJson add_terrain(GlbBuffer& buffer, LatticeMesh const& mesh, Run const& run) {
    std::size_t const positions = buffer.add_positions(mesh.vertices);
    run.at(0.3, "write");
    std::size_t begin = buffer.bytes.size();
    for (Vec3 const& normal : normals_of(mesh)) {
        put_vector(buffer.bytes, y_up(normal));
    }
    std::size_t const normals = buffer.end_accessor(begin, glb_of_vertices, glb_of_float, mesh.vertices.size(), "VEC3");
    run.at(0.5, "write");
    begin = buffer.bytes.size();
    for (Vec2 const& place : mesh.places) {
        put_float(buffer.bytes, place.x);
        put_float(buffer.bytes, place.y);
    }
    std::size_t const places = buffer.end_accessor(begin, glb_of_vertices, glb_of_float, mesh.places.size(), "VEC2");
    run.at(0.6, "write");
    begin = buffer.bytes.size();
    for (auto const& t : mesh.triangles) {
        for (std::uint32_t const v : t) {
            put_word(buffer.bytes, v);
        }
    }
    std::size_t const indices =
        buffer.end_accessor(begin, glb_of_indices, glb_of_index, 3 * mesh.triangles.size(), "SCALAR");
    return {{"attributes", {{"POSITION", positions}, {"NORMAL", normals}, {"TEXCOORD_0", places}}},
            {"indices", indices},
            {"material", 0},
            {"mode", glb_triangles}};
}

GlbJson add_river_lines(GlbBuffer& buffer, std::vector<std::vector<Vec3>> const& rivers) {
    std::vector<Vec3> vertices;
    std::vector<std::uint32_t> ends;
    for (std::vector<Vec3> const& river : rivers) {
        for (std::size_t i = 0; i < river.size(); ++i) {
            if (i > 0) {
                auto const number = static_cast<std::uint32_t>(vertices.size());
                ends.insert(ends.end(), {number - 1, number});
            }
            vertices.push_back(river[i]);
        }
    }
    std::size_t const positions = buffer.add_positions(vertices);
    std::size_t const begin = buffer.bytes.size();
    for (std::uint32_t const end : ends) {
        put_word(buffer.bytes, end);
    }
    std::size_t const indices = buffer.end_accessor(begin, glb_of_indices, glb_of_index, ends.size(), "SCALAR");
    return {{"attributes", {{"POSITION", positions}}}, {"indices", indices}, {"material", 1}, {"mode", glb_lines}};
}

} // namespace

std::string glb(GlbScene const& scene, Run const& run) {
    GlbBuffer buffer;
    buffer.bytes.reserve(32 * scene.mesh.vertices.size() + 12 * scene.mesh.triangles.size() + scene.texture.size());
    GlbJson nodes = GlbJson::array({{{"name", "terrain"}, {"mesh", 0}}});
    GlbJson meshes =
        GlbJson::array({{{"name", "terrain"}, {"primitives", GlbJson::array({add_terrain(buffer, scene.mesh, run)})}}});
    GlbJson materials =
        GlbJson::array({{{"name", "ground"},
                         {"pbrMetallicRoughness",
                          {{"baseColorTexture", {{"index", 0}}}, {"metallicFactor", 0.0}, {"roughnessFactor", 1.0}}}}});
    if (!scene.rivers.empty()) {
        nodes.push_back({{"name", "rivers"}, {"mesh", 1}});
        meshes.push_back({{"name", "rivers"}, {"primitives", GlbJson::array({add_river_lines(buffer, scene.rivers)})}});
        materials.push_back({{"name", "water"},
                             {"pbrMetallicRoughness",
                              {{"baseColorFactor", {0.006, 0.08, 0.37, 1.0}}, // glb_linear, of a map's rivers
                               {"metallicFactor", 0.0},
                               {"roughnessFactor", 1.0}}}});
    }
    std::size_t const begin = buffer.bytes.size();
    buffer.bytes += scene.texture;
    std::size_t const image = buffer.end_view(begin, 0);
    GlbJson shown = GlbJson::array();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        shown.push_back(i);
    }
    GlbJson const json{{"asset", {{"version", "2.0"}, {"generator", scene.generator}}},
                       {"scene", 0},
                       {"scenes", GlbJson::array({{{"nodes", shown}, {"extras", GlbJson::parse(scene.facts)}}})},
                       {"nodes", nodes},
                       {"meshes", meshes},
                       {"materials", materials},
                       {"textures", GlbJson::array({{{"sampler", 0}, {"source", 0}}})},
                       {"samplers", GlbJson::array({{{"magFilter", glb_linear},
                                                     {"minFilter", glb_linear_mipmaps},
                                                     {"wrapS", glb_clamped},
                                                     {"wrapT", glb_clamped}}})},
                       {"images", GlbJson::array({{{"bufferView", image}, {"mimeType", "image/png"}}})},
                       {"accessors", buffer.accessors},
                       {"bufferViews", buffer.views},
                       {"buffers", GlbJson::array({{{"byteLength", buffer.bytes.size()}}})}};
    std::string text = json.dump(-1, ' ', false, GlbJson::error_handler_t::replace);
    text.resize((text.size() + 3) / 4 * 4, ' ');
    constexpr std::size_t heads = 12 + 8 + 8;
    std::size_t const size = heads + text.size() + buffer.bytes.size();
    refuse_if<BadInput>(size > std::numeric_limits<std::uint32_t>::max(), "export.glb",
                        "the file would have {} bytes, GLB holds at most 2^32 - 1: make it smaller (--size)", size);
    std::string file;
    file.reserve(size);
    for (std::uint32_t const word :
         {std::uint32_t{glb_magic}, std::uint32_t{glb_version}, static_cast<std::uint32_t>(size),
          static_cast<std::uint32_t>(text.size()), std::uint32_t{glb_chunk_json}}) {
        put_word(file, word);
    }
    file += text;
    put_word(file, static_cast<std::uint32_t>(buffer.bytes.size()));
    put_word(file, glb_chunk_bin);
    file += buffer.bytes;
    return file;
}

} // namespace thalweg::exports
