#include "tools/input.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "tools/decoded.h"

namespace gim {

Result<RawImage> read_raw_image(const Bytes& bytes) {
    constexpr size_t kSampleSize = 3 * sizeof(float);
    RawImage image;
    const size_t samples = bytes.size() / kSampleSize;
    image.side = static_cast<uint32_t>(std::lround(std::sqrt(static_cast<double>(samples))));
    if (bytes.empty() || size_t{image.side} * image.side * kSampleSize != bytes.size()) {
        return Error{Stage::kInput,
                     "this is neither a .gim file (the magic number is missing) nor a headerless float image (" +
                         std::to_string(bytes.size()) +
                         " bytes are not 12 * side * side for any side); get a fresh copy"};
    }
    image.channels.resize(bytes.size() / sizeof(float));
    std::memcpy(image.channels.data(), bytes.data(), bytes.size());
    return image;
}

TriangleMesh to_mesh(const RawImage& image) {
    const uint32_t n = image.side;
    const size_t samples = size_t{n} * n;
    TriangleMesh mesh;
    mesh.positions.resize(samples);
    for (size_t i = 0; i < samples; ++i) {
        mesh.positions[i] = {image.channels[i], image.channels[samples + i], image.channels[2 * samples + i]};
    }
    const auto squared = [&](uint32_t a, uint32_t b) {
        double sum = 0;
        for (size_t k = 0; k < 3; ++k) {
            const double d = mesh.positions[a][k] - mesh.positions[b][k];
            sum += d * d;
        }
        return sum;
    };
    for (uint32_t row = 0; row + 1 < n; ++row) {
        for (uint32_t column = 0; column + 1 < n; ++column) {
            const uint32_t a = row * n + column;
            const uint32_t b = a + 1;
            const uint32_t c = a + n;
            const uint32_t d = c + 1;
            if (squared(a, d) <= squared(b, c)) {
                mesh.triangles.push_back({a, b, d});
                mesh.triangles.push_back({a, d, c});
            } else {
                mesh.triangles.push_back({a, b, c});
                mesh.triangles.push_back({b, d, c});
            }
        }
    }
    return mesh;
}

double diagonal_of(const RawImage& image) {
    const size_t samples = size_t{image.side} * image.side;
    double sum = 0;
    for (size_t k = 0; k < 3; ++k) {
        const auto begin = image.channels.begin() + static_cast<std::ptrdiff_t>(k * samples);
        const auto [low, high] = std::minmax_element(begin, begin + static_cast<std::ptrdiff_t>(samples));
        const double extent = static_cast<double>(*high) - static_cast<double>(*low);
        sum += extent * extent;
    }
    return std::sqrt(sum);
}

Result<Input> read_input(const std::string& path, const ReadOptions& options) {
    MemoryBudget memory(options.max_memory);
    std::error_code unknown;  // of a pipe, which read_named reads all the same
    const uint64_t size = std::filesystem::file_size(path, unknown);
    if (!unknown) {
        if (const Result<void> fits = memory.take(size, 1, "the bytes of the file"); !fits.ok()) return fits.error();
    }
    const std::string& format = options.format;
    Result<Bytes> file = read_named(path);
    if (!file.ok()) return file.error();
    Bytes& bytes = file.value();
    const std::string extension = format.empty() ? extension_of(path) : format;

    Input input;
    if (is_gim(bytes)) {
        input.kind = Input::Kind::kGim;
        input.bytes = std::move(bytes);
        return input;
    }
    if (const auto image = raster_format_of(bytes, extension)) {
        Result<RasterImage> raster = read_raster(bytes, *image, options.raster, memory);
        if (!raster.ok()) return raster.error();
        input.kind = Input::Kind::kRaster;
        input.raster = std::move(raster.value());
        return input;
    }
    input.format =
        detect_format(format.empty() ? std::span<const uint8_t>(bytes) : std::span<const uint8_t>(), extension);
    if (extension == "gim" && input.format == MeshFormat::kUnknown) {
        Result<RawImage> raw = read_raw_image(bytes);
        if (!raw.ok()) return raw.error();
        input.kind = Input::Kind::kRawImage;
        input.raw = std::move(raw.value());
        return input;
    }
    const std::string folder = std::filesystem::path(path).parent_path().string();
    Textures textures(folder);
    ReadContext context{folder, options.want == Want::kShapeAndColors ? &textures : nullptr, memory, options.shading};
    textures.limit_memory(&context.memory);
    Result<TriangleMesh> mesh = read_mesh(bytes, input.format, context);
    if (!mesh.ok()) return mesh.error();
    input.warnings = std::move(context.warnings);
    input.mesh = std::move(mesh.value());
    return input;
}

Result<TriangleMesh> read_surface(const std::string& path, uint32_t level, const ReadOptions& options,
                                  std::vector<std::string>* warnings) {
    const std::string extension = extension_of(path);
    const bool name_tells = extension == "gim" || detect_format({}, extension) != MeshFormat::kUnknown;
    ReadOptions told = options;
    if (name_tells) told.format.clear();
    Result<Input> read = read_input(path, told);
    if (!read.ok()) return read.error();
    Input& input = read.value();
    if (warnings) *warnings = std::move(input.warnings);
    switch (input.kind) {
        case Input::Kind::kGim: {
            const Result<std::vector<DecodedImage>> images = decode_images(input.bytes, level);
            if (!images.ok()) return images.error();
            return to_mesh(images.value());
        }
        case Input::Kind::kRawImage:
            return to_mesh(input.raw);
        case Input::Kind::kRaster:
            return Error{Stage::kInput, "this is an image; encode it (gim encode IN OUT.gim) and take OUT.gim"};
        case Input::Kind::kMesh:
            break;
    }
    if (repeats_vertices(input.format)) return weld_equal_positions(input.mesh);
    return std::move(input.mesh);
}

}  // namespace gim
