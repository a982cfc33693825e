#include "tools/surface_write.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
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

void append_row(Bytes& out, std::string_view keyword, std::span<const float> values) {
    append_text(out, keyword);
    char before = keyword.empty() ? '\0' : ' ';
    for (const float value : values) {
        append_number(out, value, before);
        before = ' ';
    }
    out.push_back('\n');
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

std::array<float, 3> vertex(const DecodedImage& image, uint32_t v) {
    return {image.positions[3 * size_t{v}], image.positions[3 * size_t{v} + 1], image.positions[3 * size_t{v} + 2]};
}

std::array<float, 3> facet_normal(const DecodedImage& image, const uint32_t* triangle) {
    const std::array<float, 3> a = vertex(image, triangle[0]);
    const std::array<float, 3> b = vertex(image, triangle[1]);
    const std::array<float, 3> c = vertex(image, triangle[2]);
    std::array<double, 3> normal = {};
    double squared = 0;
    for (size_t k = 0; k < 3; ++k) {
        const size_t i = (k + 1) % 3;
        const size_t j = (k + 2) % 3;
        normal[k] = (double{b[i]} - a[i]) * (double{c[j]} - a[j]) - (double{b[j]} - a[j]) * (double{c[i]} - a[i]);
        squared += normal[k] * normal[k];
    }
    const double scale = squared > 0 ? 1 / std::sqrt(squared) : 0;  // zero area: no normal; readers compute it anyway
    return {static_cast<float>(normal[0] * scale), static_cast<float>(normal[1] * scale),
            static_cast<float>(normal[2] * scale)};
}

bool has_colors(std::span<const DecodedImage> images) {
    return std::any_of(images.begin(), images.end(), [](const DecodedImage& image) { return image.colors.is_there(); });
}

// Returns the colour of a fused vertex, at its first sample. White if the image has no colours.
std::array<uint8_t, 3> vertex_color(const DecodedImage& image, size_t v) {
    if (!image.colors.is_there()) return {255, 255, 255};
    return color_at(image.colors, image.texcoords[2 * v], image.texcoords[2 * v + 1]);
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

Bytes write_ply(std::span<const DecodedImage> images) {
    Bytes out;
    out.reserve(400 + 24 * vertex_count(images) + 13 * triangle_count(images));
    append_text(out, "ply\nformat binary_little_endian 1.0\ncomment decoded by gim\nelement vertex ");
    append_text(out, std::to_string(vertex_count(images)));
    append_text(out,
                "\nproperty float x\nproperty float y\nproperty float z\n"
                "property float nx\nproperty float ny\nproperty float nz\n");
    const bool colored = has_colors(images);
    if (colored) append_text(out, "property uchar red\nproperty uchar green\nproperty uchar blue\n");
    append_text(out, "element face ");
    append_text(out, std::to_string(triangle_count(images)));
    append_text(out, "\nproperty list uchar int vertex_indices\nend_header\n");
    for (const DecodedImage& image : images) {
        for (size_t v = 0; v < image.positions.size(); v += 3) {
            for (size_t k = 0; k < 3; ++k) append(out, image.positions[v + k]);
            for (size_t k = 0; k < 3; ++k) append(out, image.normals[v + k]);
            if (colored) append(out, vertex_color(image, v / 3));
        }
    }
    uint32_t base = 0;
    for (const DecodedImage& image : images) {
        for (size_t t = 0; t < image.triangles.size(); t += 3) {
            out.push_back(3);
            for (size_t k = 0; k < 3; ++k) append(out, base + image.triangles[t + k]);
        }
        base += static_cast<uint32_t>(image.positions.size() / 3);
    }
    return out;
}

Bytes write_obj(std::span<const DecodedImage> images, const std::string& material_file) {
    Bytes out;
    append_text(out, "# decoded by gim\n");
    if (!material_file.empty()) append_text(out, "mtllib " + material_file + "\n");
    const bool colored = has_colors(images);
    size_t base = 1;       // OBJ counts from 1
    size_t grid_base = 1;  // texture coordinates belong to samples, normals and positions to fused vertices
    for (size_t i = 0; i < images.size(); ++i) {
        const DecodedImage& image = images[i];
        append_text(out, "o image" + std::to_string(i) + "\n");
        if (!material_file.empty()) append_text(out, "usemtl image" + std::to_string(i) + "\n");
        for (size_t v = 0; v < image.positions.size(); v += 3) {
            if (!colored) {
                append_row(out, "v", {&image.positions[v], 3});
                continue;
            }
            std::array<float, 6> row = {};
            std::copy_n(&image.positions[v], 3, row.begin());
            const std::array<uint8_t, 3> rgb = vertex_color(image, v / 3);
            for (size_t k = 0; k < 3; ++k) row[3 + k] = static_cast<float>(rgb[k]) / 255.0F;
            append_row(out, "v", row);
        }
        const GridMesh grid = grid_mesh(image);
        for (const uint32_t sample : grid.samples) {
            const float* t = &image.grid_texcoords[size_t{2} * sample];
            // OBJ puts the origin of textures at the bottom left.
            const std::array<float, 2> uv = {texture_coordinate(t[0], image.colors.columns),
                                             1.0F - texture_coordinate(t[1], image.colors.rows)};
            append_row(out, "vt", uv);
        }
        for (size_t v = 0; v < image.normals.size(); v += 3) append_row(out, "vn", {&image.normals[v], 3});
        for (size_t t = 0; t < image.triangles.size(); t += 3) {
            out.push_back('f');
            for (size_t k = 0; k < 3; ++k) {
                append_number(out, base + image.triangles[t + k], ' ');
                append_number(out, grid_base + grid.triangles[t + k], '/');
                append_number(out, base + image.triangles[t + k], '/');
            }
            out.push_back('\n');
        }
        base += image.positions.size() / 3;
        grid_base += grid.samples.size();
    }
    return out;
}

Bytes write_off(std::span<const DecodedImage> images) {
    Bytes out;
    append_text(out,
                "OFF\n" + std::to_string(vertex_count(images)) + " " + std::to_string(triangle_count(images)) + " 0\n");
    for (const DecodedImage& image : images) {
        for (size_t v = 0; v < image.positions.size(); v += 3) append_row(out, "", {&image.positions[v], 3});
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
            for (size_t k = 0; k < 3; ++k) append(out, vertex(image, image.triangles[t + k]));
            append(out, uint16_t{0});
        }
    }
    return out;
}

Result<Bytes> write_surface(SurfaceFormat format, std::span<const DecodedImage> images, const SurfaceOptions& options) {
    switch (format) {
        case SurfaceFormat::kPly:
            return write_ply(images);
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
