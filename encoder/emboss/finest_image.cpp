#include "encoder/emboss/finest_image.h"

#include <string>

#include "gim/refine.h"

namespace gim {
namespace {

static_assert(kNone == GIM_NOTHING);

Error failed(gim_status status) {
    return {Stage::kInput, std::string("the .gim file does not decode: ") + gim_status_text(status)};
}

gim_status read_places(const gim_info& info, std::span<const uint8_t> file, uint32_t image,
                       const std::vector<float>& positions, FinestImage* out) {
    gim_domain_info shape;
    gim_status status = gim_read_domain_info(&info, file.data(), file.size(), image, 0, &shape);
    if (status != GIM_OK) return status;
    Scratch memory(shape.domain_size), scratch(shape.scratch_size);
    const gim_domain* domain = nullptr;
    status = gim_open_domain(&info, file.data(), file.size(), image, 0, positions.data(), memory.data(), memory.size(),
                             scratch.data(), scratch.size(), &domain);
    if (status != GIM_OK) return status;
    out->width = shape.width;
    out->height = shape.height;
    out->tiles = shape.tile_count;
    out->intervals = shape.intervals;
    out->vertex_at.resize(size_t{shape.width} * shape.height);
    gim_read_sample_vertices(domain, out->vertex_at.data());
    return GIM_OK;
}

}  // namespace

Result<FinestImage> finest_image(Decoder& decoder, std::span<const uint8_t> file, uint32_t image) {
    if (decoder.info().layout == GIM_LAYOUT_MCGIM)
        return Error{Stage::kInput, "charts cannot be embossed; encode with --layout tiles or --layout gim"};
    DecoderLevel level;
    if (const gim_status s = decoder.read_level(image, 0, &level); s != GIM_OK) return failed(s);
    const size_t vertices = level.vertex_count;
    std::vector<float> positions(3 * vertices), normals(3 * vertices), texcoords(2 * vertices);
    std::vector<uint32_t> triangles(3 * size_t{level.triangle_count});
    if (const gim_status s = decoder.mesh(level, {positions, normals, texcoords, triangles}); s != GIM_OK)
        return failed(s);
    FinestImage out;
    const auto triple = [](const std::vector<float>& of, size_t i) {
        return Vec3(of[3 * i], of[3 * i + 1], of[3 * i + 2]);
    };
    const Vec3 origin = decoder.info().is_relative
                            ? Vec3(decoder.info().origin[0], decoder.info().origin[1], decoder.info().origin[2])
                            : Vec3(Vec3::Zero());
    for (size_t v = 0; v < vertices; ++v) {
        out.mesh.positions.push_back(origin + triple(positions, v));
        out.normals.push_back(triple(normals, v));
        out.texcoords.push_back({texcoords[2 * v], texcoords[2 * v + 1]});
    }
    for (size_t i = 0; i < triangles.size(); i += 3)
        out.mesh.triangles.push_back({triangles[i], triangles[i + 1], triangles[i + 2]});
    if (const gim_status s = read_places(decoder.info(), file, image, positions, &out); s != GIM_OK) return failed(s);
    // The tiles of a square share the samples of their sides.
    out.slot = decoder.info().layout == GIM_LAYOUT_TILES ? out.intervals + 1 : out.intervals;
    return out;
}

}  // namespace gim
