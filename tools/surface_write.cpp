#include "tools/surface_write.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <string>

#include "tools/little_endian.h"
#include "tools/plane_write.h"

namespace gim {
namespace {

void append_text(Bytes& out, std::string_view text) { out.insert(out.end(), text.begin(), text.end()); }

template <class Number>
void append_number(Bytes& out, Number value, char before) {
    std::array<char, 40> digits = {};
    const std::to_chars_result end = std::to_chars(digits.data(), digits.data() + digits.size(), value);
    if (before != '\0') out.push_back(static_cast<uint8_t>(before));
    out.insert(out.end(), digits.data(), end.ptr);
}

template <class Number>
void append_numbers(Bytes& out, std::span<const Number> values, char before) {
    for (const Number value : values) {
        append_number(out, value, before);
        before = ' ';
    }
}

void append_row(Bytes& out, std::string_view keyword, std::span<const float> values) {
    append_text(out, keyword);
    append_numbers(out, values, ' ');
    out.push_back('\n');
}

// Appends a vertex's position as floats, or as doubles if it is relative to an origin.
void append_position(Bytes& out, const DecodedImage& image, size_t v, char before) {
    if (image.is_relative()) {
        append_numbers<double>(out, image.vertex(v), before);
    } else {
        append_numbers<float>(out, {&image.positions[3 * v], 3}, before);
    }
}

std::string shortest(double value) {
    std::array<char, 40> digits = {};
    const std::to_chars_result end = std::to_chars(digits.data(), digits.data() + digits.size(), value);
    return {digits.data(), end.ptr};
}

size_t vertex_count(std::span<const DecodedImage> images) {
    size_t count = 0;
    for (const DecodedImage& image : images) count += image.positions.size() / 3;
    return count;
}

size_t triangle_count(std::span<const DecodedImage> images) {
    size_t count = 0;
    for (const DecodedImage& image : images) count += image.triangles.size() / 3;
    return count;
}

std::array<float, 3> to_floats(const std::array<double, 3>& p) {
    return {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
}

bool is_relative(std::span<const DecodedImage> images) {
    return std::any_of(images.begin(), images.end(), [](const DecodedImage& image) { return image.is_relative(); });
}

std::array<float, 3> facet_normal(const DecodedImage& image, const uint32_t* triangle) {
    const std::array<double, 3> a = image.vertex(triangle[0]);
    const std::array<double, 3> b = image.vertex(triangle[1]);
    const std::array<double, 3> c = image.vertex(triangle[2]);
    std::array<double, 3> normal = {};
    double squared = 0;
    for (size_t k = 0; k < 3; ++k) {
        const size_t i = (k + 1) % 3;
        const size_t j = (k + 2) % 3;
        normal[k] = (b[i] - a[i]) * (c[j] - a[j]) - (b[j] - a[j]) * (c[i] - a[i]);
        squared += normal[k] * normal[k];
    }
    const double scale = squared > 0 ? 1 / std::sqrt(squared) : 0;  // zero area: no normal; readers compute it anyway
    return {static_cast<float>(normal[0] * scale), static_cast<float>(normal[1] * scale),
            static_cast<float>(normal[2] * scale)};
}

bool has_colors(std::span<const DecodedImage> images) {
    return std::any_of(images.begin(), images.end(), [](const DecodedImage& image) { return image.colors.is_there(); });
}

// White if the image has no colours.
std::array<uint8_t, 3> color_of(const DecodedImage& image, const float* texcoord) {
    if (!image.colors.is_there()) return {255, 255, 255};
    return color_at(image.colors, texcoord[0], texcoord[1]);
}

// Returns the colour of a fused vertex, at its first sample.
std::array<uint8_t, 3> vertex_color(const DecodedImage& image, size_t v) {
    return color_of(image, &image.texcoords[2 * v]);
}

// A mesh with one normal for each vertex.
struct ShadedMesh {
    std::span<const float> positions, normals, texcoords;
    std::span<const uint32_t> triangles;
};
ShadedMesh shaded_mesh(const DecodedImage& image, bool split_sharp) {
    const HardMesh& hard = image.hard;
    if (hard.is_there() && split_sharp) return {hard.positions, hard.normals, hard.texcoords, hard.triangles};
    return {image.positions, image.normals, image.texcoords, image.triangles};
}

}  // namespace

float texture_coordinate(float t, uint32_t pixels) {
    return pixels == 0 ? t : (t * static_cast<float>(pixels - 1) + 0.5F) / static_cast<float>(pixels);
}

std::optional<SurfaceFormat> surface_format_of(std::string_view extension) {
    if (extension == "ply") return SurfaceFormat::kPly;
    if (extension == "obj") return SurfaceFormat::kObj;
    if (extension == "off") return SurfaceFormat::kOff;
    if (extension == "stl") return SurfaceFormat::kStl;
    if (extension == "glb") return SurfaceFormat::kGlb;
    if (extension == "exr") return SurfaceFormat::kExr;
    return std::nullopt;
}

Bytes write_ply(std::span<const DecodedImage> images, bool split_sharp) {
    std::vector<ShadedMesh> meshes;
    size_t vertices = 0;
    for (const DecodedImage& image : images) {
        meshes.push_back(shaded_mesh(image, split_sharp));
        vertices += meshes.back().positions.size() / 3;
    }
    Bytes out;
    out.reserve(400 + 24 * vertices + 13 * triangle_count(images));
    append_text(out, "ply\nformat binary_little_endian 1.0\ncomment decoded by gim\nelement vertex ");
    append_text(out, std::to_string(vertices));
    const bool relative = is_relative(images);
    append_text(out, relative ? "\nproperty double x\nproperty double y\nproperty double z\n"
                              : "\nproperty float x\nproperty float y\nproperty float z\n");
    append_text(out, "property float nx\nproperty float ny\nproperty float nz\n");
    const bool colored = has_colors(images);
    if (colored) append_text(out, "property uchar red\nproperty uchar green\nproperty uchar blue\n");
    append_text(out, "element face ");
    append_text(out, std::to_string(triangle_count(images)));
    append_text(out, "\nproperty list uchar int vertex_indices\nend_header\n");
    for (size_t i = 0; i < images.size(); ++i) {
        const ShadedMesh& mesh = meshes[i];
        for (size_t v = 0; v < mesh.positions.size(); v += 3) {
            if (relative) {
                append(out, images[i].in_space(&mesh.positions[v]));
            } else {
                for (size_t k = 0; k < 3; ++k) append(out, mesh.positions[v + k]);
            }
            for (size_t k = 0; k < 3; ++k) append(out, mesh.normals[v + k]);
            if (colored) append(out, color_of(images[i], &mesh.texcoords[v / 3 * 2]));
        }
    }
    uint32_t base = 0;
    for (const ShadedMesh& mesh : meshes) {
        for (size_t t = 0; t < mesh.triangles.size(); t += 3) {
            out.push_back(3);
            for (size_t k = 0; k < 3; ++k) append(out, base + mesh.triangles[t + k]);
        }
        base += static_cast<uint32_t>(mesh.positions.size() / 3);
    }
    return out;
}

Bytes write_obj(std::span<const DecodedImage> images, const std::string& material_file) {
    Bytes out;
    append_text(out, "# decoded by gim\n");
    if (!material_file.empty()) append_text(out, "mtllib " + material_file + "\n");
    const bool colored = has_colors(images);
    size_t base = 1;       // OBJ counts from 1
    size_t grid_base = 1;  // texture coordinates belong to samples, positions to fused vertices
    size_t normal_base = 1;
    for (size_t i = 0; i < images.size(); ++i) {
        const DecodedImage& image = images[i];
        append_text(out, "o image" + std::to_string(i) + "\n");
        if (!material_file.empty()) append_text(out, "usemtl image" + std::to_string(i) + "\n");
        for (size_t v = 0; v < image.positions.size(); v += 3) {
            out.push_back('v');
            append_position(out, image, v / 3, ' ');
            if (colored) {
                for (const uint8_t level : vertex_color(image, v / 3))
                    append_number(out, static_cast<float>(level) / 255.0F, ' ');
            }
            out.push_back('\n');
        }
        const GridMesh grid = grid_mesh(image);
        for (const uint32_t sample : grid.samples) {
            const float* t = &image.grid_texcoords[size_t{2} * sample];
            // OBJ puts the origin of textures at the bottom left.
            const std::array<float, 2> uv = {texture_coordinate(t[0], image.colors.columns),
                                             1.0F - texture_coordinate(t[1], image.colors.rows)};
            append_row(out, "vt", uv);
        }
        const ShadedMesh shaded = shaded_mesh(image, true);
        for (size_t v = 0; v < shaded.normals.size(); v += 3) append_row(out, "vn", shaded.normals.subspan(v, 3));
        for (size_t t = 0; t < image.triangles.size(); t += 3) {
            out.push_back('f');
            for (size_t k = 0; k < 3; ++k) {
                append_number(out, base + image.triangles[t + k], ' ');
                append_number(out, grid_base + grid.triangles[t + k], '/');
                append_number(out, normal_base + shaded.triangles[t + k], '/');
            }
            out.push_back('\n');
        }
        base += image.positions.size() / 3;
        normal_base += shaded.normals.size() / 3;
        grid_base += grid.samples.size();
    }
    return out;
}

Bytes write_off(std::span<const DecodedImage> images) {
    Bytes out;
    append_text(out,
                "OFF\n" + std::to_string(vertex_count(images)) + " " + std::to_string(triangle_count(images)) + " 0\n");
    for (const DecodedImage& image : images) {
        for (size_t v = 0; v < image.positions.size() / 3; ++v) {
            append_position(out, image, v, '\0');
            out.push_back('\n');
        }
    }
    uint32_t base = 0;
    for (const DecodedImage& image : images) {
        for (size_t t = 0; t < image.triangles.size(); t += 3) {
            out.push_back('3');
            for (size_t k = 0; k < 3; ++k) append_number(out, base + image.triangles[t + k], ' ');
            out.push_back('\n');
        }
        base += static_cast<uint32_t>(image.positions.size() / 3);
    }
    return out;
}

Bytes write_stl(std::span<const DecodedImage> images) {
    Bytes out;
    out.reserve(84 + 50 * triangle_count(images));
    append_text(out, "decoded by gim (binary STL)");  // must not begin with "solid"
    out.resize(80, ' ');
    append(out, static_cast<uint32_t>(triangle_count(images)));
    for (const DecodedImage& image : images) {
        for (size_t t = 0; t < image.triangles.size(); t += 3) {
            append(out, facet_normal(image, &image.triangles[t]));
            for (size_t k = 0; k < 3; ++k) append(out, to_floats(image.vertex(image.triangles[t + k])));
            append(out, uint16_t{0});
        }
    }
    return out;
}

std::string rounding_warning(SurfaceFormat format, std::span<const DecodedImage> images) {
    if (!is_relative(images)) return {};
    if (format == SurfaceFormat::kExr) {
        std::string text = "EXR holds 32-bit numbers: X, Y and Z are relative to the attribute gimOrigin,";
        for (const double o : images[0].origin) text += " " + shortest(o);
        return text;
    }
    if (format != SurfaceFormat::kStl) return {};
    double most = 0;
    for (const DecodedImage& image : images) {
        for (size_t v = 0; v < image.positions.size() / 3; ++v) {
            for (const double p : image.vertex(v)) most = std::max(most, std::abs(p - double{static_cast<float>(p)}));
        }
    }
    std::array<char, 100> text = {};
    std::snprintf(text.data(), text.size(),
                  "STL holds 32-bit numbers: positions are rounded by up to %.3g; ply, obj, off and glb hold them",
                  most);
    return text.data();
}

Result<Bytes> write_surface(SurfaceFormat format, std::span<const DecodedImage> images, const SurfaceOptions& options) {
    switch (format) {
        case SurfaceFormat::kPly:
            return write_ply(images, options.split_sharp);
        case SurfaceFormat::kObj:
            return write_obj(images, options.material_file);
        case SurfaceFormat::kOff:
            return write_off(images);
        case SurfaceFormat::kStl:
            return write_stl(images);
        case SurfaceFormat::kGlb:
            return write_glb(images, options.fused);
        case SurfaceFormat::kExr:
            return write_exr(images);
    }
    return Error{Stage::kWrite, "unknown format"};
}

}  // namespace gim
