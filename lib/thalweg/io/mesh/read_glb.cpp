// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/mesh/internal/read_glb.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include <cpl_error.h>
#include <cpl_json.h>
#include <fmt/format.h>

#include <thalweg/core/run/refuse.hpp>

namespace thalweg::io {
namespace {

/// A matrix of a node by columns, as the file has it.
using Placement = std::array<double, 16>;

constexpr Placement in_place{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

Placement product(Placement const& a, Placement const& b) {
    Placement out{};
    for (std::size_t col = 0; col < 4; ++col) {
        for (std::size_t row = 0; row < 4; ++row) {
            for (std::size_t k = 0; k < 4; ++k) {
                out[4 * col + row] += a[4 * k + row] * b[4 * col + k];
            }
        }
    }
    return out;
}

Vec3 placed(Placement const& m, Vec3 v) {
    return {m[0] * v.x + m[4] * v.y + m[8] * v.z + m[12], m[1] * v.x + m[5] * v.y + m[9] * v.z + m[13],
            m[2] * v.x + m[6] * v.y + m[10] * v.z + m[14]};
}

std::vector<double> numbers_of(CPLJSONObject const& json) {
    std::vector<double> numbers;
    CPLJSONArray const list = json.IsValid() ? json.ToArray() : CPLJSONArray();
    for (int i = 0; list.IsValid() && i < list.Size(); ++i) {
        numbers.push_back(list[i].ToDouble(std::numeric_limits<double>::quiet_NaN()));
    }
    return numbers;
}

/// The place of a node by translation, rotation (a quaternion) and scale.
Placement composed(CPLJSONObject const& node) {
    std::vector<double> move = numbers_of(node.GetObj("translation"));
    std::vector<double> turn = numbers_of(node.GetObj("rotation"));
    std::vector<double> size = numbers_of(node.GetObj("scale"));
    move.resize(3, 0.0);
    turn = turn.size() == 4 ? turn : std::vector<double>{0.0, 0.0, 0.0, 1.0};
    size = size.size() == 3 ? size : std::vector<double>{1.0, 1.0, 1.0};
    double const x = turn[0];
    double const y = turn[1];
    double const z = turn[2];
    double const w = turn[3];
    return {size[0] * (1 - 2 * (y * y + z * z)),
            size[0] * 2 * (x * y + z * w),
            size[0] * 2 * (x * z - y * w),
            0,
            size[1] * 2 * (x * y - z * w),
            size[1] * (1 - 2 * (x * x + z * z)),
            size[1] * 2 * (y * z + x * w),
            0,
            size[2] * 2 * (x * z + y * w),
            size[2] * 2 * (y * z - x * w),
            size[2] * (1 - 2 * (x * x + y * y)),
            0,
            move[0],
            move[1],
            move[2],
            1};
}

Placement place_of(CPLJSONObject const& node) {
    std::vector<double> const matrix = numbers_of(node.GetObj("matrix"));
    if (matrix.size() != 16) {
        return composed(node);
    }
    Placement out{};
    std::copy(matrix.begin(), matrix.end(), out.begin());
    return out;
}

class GlbReader {
public:
    GlbReader(std::string const& bytes, About const& about) : bytes_(bytes), about_(about) {
        constexpr std::uint32_t magic = 0x46546C67;
        constexpr std::uint32_t json_chunk = 0x4E4F534A;
        constexpr std::uint32_t bin_chunk = 0x004E4942;
        constexpr std::size_t head = 20;
        refuse_if<BadInput>(bytes.size() < head || word(0) != magic || word(4) != 2 || word(16) != json_chunk,
                            about_.where, "{} is not a GLB of version 2", about_.name);
        std::size_t const text = word(12);
        refuse_if<BadInput>(text > bytes.size() - head, about_.where, "{} ends within its description", about_.name);
        CPLErrorStateBackuper const kept;
        CPLErrorHandlerPusher const quiet(CPLQuietErrorHandler);
        refuse_if<BadInput>(!document_.LoadMemory(bytes.substr(head, text)), about_.where,
                            "{}: its description is no JSON", about_.name);
        json_ = document_.GetRoot();
        std::size_t const next = head + text;
        if (bytes.size() >= next + 8 && word(next + 4) == bin_chunk) {
            begin_ = next + 8;
            end_ = begin_ + std::min<std::size_t>(word(next), bytes.size() - begin_);
        }
    }

    GlbTriangles read() {
        refuse_extensions();
        CPLJSONObject const scene = item("scenes", json_.GetInteger("scene", 0));
        CPLJSONArray const nodes = list_of(scene.GetObj("nodes"));
        for (int i = 0; i < nodes.Size(); ++i) {
            add_node(nodes[i].ToInteger(-1), in_place, 0);
        }
        take_facts(scene.GetObj("extras"));
        return std::move(out_);
    }

private:
    std::uint32_t word(std::size_t at) const {
        std::uint32_t value = 0;
        for (unsigned k = 0; k < 4; ++k) {
            value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes_[at + k])) << (8 * k);
        }
        return value;
    }

    static CPLJSONArray list_of(CPLJSONObject const& json) {
        return json.IsValid() && json.GetType() == CPLJSONObject::Type::Array ? json.ToArray() : CPLJSONArray();
    }

    CPLJSONObject item(char const* list, int number) const {
        CPLJSONArray const items = list_of(json_.GetObj(list));
        refuse_if<BadInput>(number < 0 || number >= items.Size(), about_.where, "{} has no entry {} among its {}",
                            about_.name, number, list);
        return items[number];
    }

    void refuse_extensions() const {
        CPLJSONArray const needed = list_of(json_.GetObj("extensionsRequired"));
        for (int i = 0; i < needed.Size(); ++i) {
            std::string const name = needed[i].ToString();
            refuse_if<BadInput>(name.find("draco") != std::string::npos || name.find("meshopt") != std::string::npos ||
                                    name.find("quantization") != std::string::npos,
                                about_.where, "{} needs {}, which is not read: export it without compression",
                                about_.name, name);
        }
    }

    void add_node(int number, Placement const& above, int depth) {
        constexpr int deepest = 64;
        constexpr int most_nodes = 100'000;
        refuse_if<BadInput>(depth > deepest || ++visited_ > most_nodes, about_.where,
                            "{} has nodes within nodes without end", about_.name);
        CPLJSONObject const node = item("nodes", number);
        Placement const place = product(above, place_of(node));
        if (node.GetObj("mesh").IsValid()) {
            add_mesh(item("meshes", node.GetInteger("mesh", -1)), place);
        }
        CPLJSONArray const children = list_of(node.GetObj("children"));
        for (int i = 0; i < children.Size(); ++i) {
            add_node(children[i].ToInteger(-1), place, depth + 1);
        }
    }

    void add_mesh(CPLJSONObject const& mesh, Placement const& place) {
        constexpr int triangles = 4;
        CPLJSONArray const parts = list_of(mesh.GetObj("primitives"));
        for (int i = 0; i < parts.Size(); ++i) {
            if (parts[i].GetInteger("mode", triangles) == triangles) {
                add_part(parts[i], place);
            }
        }
    }

    void add_part(CPLJSONObject const& part, Placement const& place) {
        Samples const positions = samples_of(part.GetInteger("attributes/POSITION", -1), "VEC3");
        refuse_if<BadInput>(positions.type != of_float, about_.where, "{}: its positions are no floating-point numbers",
                            about_.name);
        std::size_t const first = out_.tin.vertices.size();
        refuse_if<BadInput>(first + positions.count > std::numeric_limits<std::uint32_t>::max(), about_.where,
                            "{} has too many vertices", about_.name);
        for (std::size_t i = 0; i < positions.count; ++i) {
            std::size_t const at = positions.begin + i * positions.stride;
            auto const number = [&](std::size_t k) {
                return static_cast<double>(std::bit_cast<float>(word(at + 4 * k)));
            };
            Vec3 const v = placed(place, {number(0), number(1), number(2)});
            refuse_if<BadInput>(!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z), about_.where,
                                "{}: vertex {} is at no finite place", about_.name, i);
            out_.tin.vertices.push_back(v);
        }
        std::vector<std::uint32_t> const corners = corners_of(part, positions.count);
        for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
            auto const corner = [&](std::size_t k) {
                refuse_if<BadInput>(corners[i + k] >= positions.count, about_.where,
                                    "{}: a triangle names a vertex that is not there", about_.name);
                return static_cast<std::uint32_t>(first + corners[i + k]);
            };
            out_.tin.triangles.push_back({corner(0), corner(1), corner(2)});
        }
    }

    std::vector<std::uint32_t> corners_of(CPLJSONObject const& part, std::size_t vertices) const {
        std::vector<std::uint32_t> corners;
        if (!part.GetObj("indices").IsValid()) {
            for (std::size_t i = 0; i < vertices; ++i) {
                corners.push_back(static_cast<std::uint32_t>(i));
            }
            return corners;
        }
        Samples const numbers = samples_of(part.GetInteger("indices", -1), "SCALAR");
        std::size_t const bytes = bytes_of(numbers.type);
        refuse_if<BadInput>(numbers.type == of_float, about_.where,
                            "{}: the corners of its triangles are no whole numbers", about_.name);
        for (std::size_t i = 0; i < numbers.count; ++i) {
            std::uint32_t corner = 0;
            for (std::size_t k = 0; k < bytes; ++k) {
                corner |= static_cast<std::uint32_t>(
                              static_cast<unsigned char>(bytes_[numbers.begin + i * numbers.stride + k]))
                          << (8 * k);
            }
            corners.push_back(corner);
        }
        return corners;
    }

    static constexpr int of_float = 5126;

    static std::size_t bytes_of(int type) {
        constexpr int of_byte = 5121;
        constexpr int of_short = 5123;
        return type == of_byte ? 1 : type == of_short ? 2 : 4;
    }

    /// Numbers in the binary part.
    struct Samples {
        std::size_t begin = 0; ///< in the file
        std::size_t stride = 0;
        std::size_t count = 0;
        int type = 0;
    };

    static std::size_t size_in(CPLJSONObject const& json, char const* key) {
        double const value = json.GetDouble(key, 0.0);
        return value > 0.0 && value < 1e12 ? static_cast<std::size_t>(value) : 0;
    }

    Samples samples_of(int number, std::string_view shape) const {
        CPLJSONObject const accessor = item("accessors", number);
        refuse_if<BadInput>(accessor.GetObj("sparse").IsValid() || accessor.GetString("type") != shape, about_.where,
                            "{}: accessor {} is sparse or not of {}", about_.name, number, shape);
        CPLJSONObject const view = item("bufferViews", accessor.GetInteger("bufferView", -1));
        refuse_if<BadInput>(view.GetInteger("buffer", 0) != 0 || list_of(json_.GetObj("buffers")).Size() > 1 ||
                                item("buffers", 0).GetObj("uri").IsValid(),
                            about_.where, "{} keeps its geometry in other files: export it as one GLB", about_.name);
        Samples samples;
        samples.type = accessor.GetInteger("componentType", 0);
        samples.count = size_in(accessor, "count");
        std::size_t const size = bytes_of(samples.type) * (shape == "VEC3" ? 3 : 1);
        std::size_t const stride = size_in(view, "byteStride");
        samples.stride = stride > 0 ? stride : size;
        samples.begin = begin_ + size_in(view, "byteOffset") + size_in(accessor, "byteOffset");
        bool const is_inside =
            samples.count == 0 || (samples.begin <= end_ && size <= end_ - samples.begin &&
                                   samples.count - 1 <= (end_ - samples.begin - size) / samples.stride);
        refuse_if<BadInput>(!is_inside, about_.where, "{} ends within accessor {}", about_.name, number);
        return samples;
    }

    void take_facts(CPLJSONObject const& extras) {
        if (!extras.IsValid() || !extras.GetObj("thalweg").IsValid()) {
            return;
        }
        std::vector<double> const origin = numbers_of(extras.GetObj("origin"));
        if (origin.size() == 3 && std::isfinite(origin[0] + origin[1] + origin[2])) {
            out_.origin = {origin[0], origin[1], origin[2]};
        }
        double const factor = extras.GetDouble("exaggeration", 1.0);
        out_.exaggeration = factor > 0.0 && std::isfinite(factor) ? factor : 1.0;
        out_.crs = extras.GetString("crs");
    }

    std::string const& bytes_;
    About const& about_;
    CPLJSONDocument document_;
    CPLJSONObject json_;
    std::size_t begin_ = 0; ///< of the binary part
    std::size_t end_ = 0;
    int visited_ = 0;
    GlbTriangles out_;
};

} // namespace

GlbTriangles read_glb(std::string const& bytes, About const& about) {
    return GlbReader(bytes, about).read();
}

} // namespace thalweg::io
