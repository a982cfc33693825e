// write_damaged VECTORS FOLDER: damages each conformance vector in 60 ways and tells what the native decoder makes of each
// copy, for tests that compare other builds with it. Writes FOLDER/damaged.bin, the copies one after the other, and
// FOLDER/damaged.txt: a line "NAME SIZE HASH" for each. decode_all.mjs computes the same hashes.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "format/checksum.h"
#include "gim/decoder.hpp"
#include "tests/random_numbers.h"

namespace {

using Bytes = std::vector<uint8_t>;

constexpr gim_limits kLimits = {65536, 16, 2049};  // as in decode_all.mjs
constexpr int kCopies = 60;

// FNV-1a over words of 32 bits. All NaNs are one.
class Hash {
  public:
    void add(uint32_t word) { hash_ = (hash_ ^ word) * 16777619u; }
    void add(const std::vector<uint32_t>& words) {
        for (const uint32_t word : words) add(word);
    }
    void add(const std::vector<float>& values) {
        for (const float value : values) {
            uint32_t word = 0x7FC00000;
            if (value == value) std::memcpy(&word, &value, 4);
            add(word);
        }
    }
    uint32_t value() const { return hash_; }

  private:
    uint32_t hash_ = 2166136261u;
};

// Everything that a file has, and the status of every call.
class Walk {
  public:
    explicit Walk(const Bytes& file) {
        if (!told(decoder_.open(file, &kLimits))) return;
        for (uint32_t image = 0; image < decoder_.info().image_count; ++image) walk_image(image);
        for (uint32_t kind = 0; kind < 3; ++kind)
            for (uint32_t image = 0; image < decoder_.info().image_count; ++image) walk_plane(image, kind);
    }
    uint32_t hash() const { return hash_.value(); }

  private:
    bool told(gim_status status) {
        hash_.add(static_cast<uint32_t>(status));
        return status == GIM_OK;
    }

    void walk_image(uint32_t image) {
        gim::DecoderLevel level;
        for (uint32_t l = 0; l <= level.coarsest_level; ++l) {
            if (!told(decoder_.read_level(image, l, &level))) return;
            for (const uint32_t number : {level.width, level.height, level.vertex_count, level.triangle_count})
                hash_.add(number);
            const size_t samples = size_t{level.width} * level.height;
            Surface grid(level, samples), mesh(level, level.vertex_count), hard(level, samples);
            if (told(decoder_.grid(level, grid.spans()))) grid.add_to(&hash_, samples);
            if (told(decoder_.mesh(level, mesh.spans()))) mesh.add_to(&hash_, level.vertex_count);
            uint32_t count = 0;
            if (told(decoder_.hard_mesh(level, &count, hard.spans()))) hard.add_to(&hash_, count);
        }
    }

    void walk_plane(uint32_t image, uint32_t kind) {
        gim::DecoderPlane plane;
        for (uint32_t l = 0; l <= plane.coarsest_level; ++l) {
            if (!told(decoder_.read_plane(image, kind, l, &plane))) return;
            std::vector<float> values(size_t{plane.width} * plane.height * 3);
            if (told(decoder_.plane(plane, values))) hash_.add(values);
        }
    }

    struct Surface {
        std::vector<float> positions, normals, texcoords;
        std::vector<uint32_t> triangles;

        Surface(const gim_level_info& level, size_t vertices)
            : positions(vertices * 3),
              normals(vertices * 3),
              texcoords(vertices * 2),
              triangles(size_t{level.triangle_count} * 3) {}
        gim::SurfaceSpans spans() { return {positions, normals, texcoords, triangles}; }
        void add_to(Hash* hash, size_t vertices) {
            positions.resize(vertices * 3);
            normals.resize(vertices * 3);
            texcoords.resize(vertices * 2);
            hash->add(positions);
            hash->add(normals);
            hash->add(texcoords);
            hash->add(triangles);
        }
    };

    gim::Decoder decoder_;
    Hash hash_;
};

// Where the index keeps the checksum of each chunk, found by its value.
struct Chunk {
    size_t offset, size, checksum_at;
};
std::vector<Chunk> find_chunks(const Bytes& file, const gim_info& info) {
    std::vector<Chunk> chunks;
    size_t from = 0;
    gim_chunk chunk;
    for (uint32_t i = 0; gim_read_chunk(&info, file.data(), file.size(), i, &chunk) == GIM_OK && chunk.intact; ++i) {
        const auto offset = static_cast<size_t>(chunk.offset), size = static_cast<size_t>(chunk.size);
        const uint16_t crc = gim::crc16(std::span(file).subspan(offset, size));
        while (from + 6 <= info.index_size && (file[from] | file[from + 1] << 8) != crc) ++from;
        chunks.push_back({offset, size, from});
        from += 2;
    }
    return chunks;
}

// Corrects the checksums, so that damage gets to the streams.
void sign(const std::vector<Chunk>& chunks, uint32_t index_size, Bytes* file) {
    if (file->size() < index_size) return;
    for (const Chunk& c : chunks) {
        if (c.offset + c.size > file->size()) continue;
        const uint16_t crc = gim::crc16(std::span(*file).subspan(c.offset, c.size));
        (*file)[c.checksum_at] = static_cast<uint8_t>(crc);
        (*file)[c.checksum_at + 1] = static_cast<uint8_t>(crc >> 8);
    }
    const uint32_t crc = gim::crc32(std::span(*file).first(index_size - 4));
    for (uint32_t i = 0; i < 4; ++i) (*file)[index_size - 4 + i] = static_cast<uint8_t>(crc >> (8 * i));
}

Bytes damaged(Bytes file, gim::Random& random) {
    if (file.empty()) return file;
    const auto place = [&] { return gim::number_between(random, 0, static_cast<uint32_t>(file.size()) - 1); };
    const uint32_t how = gim::number_between(random, 0, 9);
    if (how == 0) file.resize(place());
    const uint32_t times = how == 0 || file.empty() ? 0 : gim::number_between(random, 1, how > 6 ? 8 : 1);
    for (uint32_t i = 0; i < times; ++i) {
        if (how % 2 == 0)
            file[place()] = static_cast<uint8_t>(random());
        else
            file[place()] ^= static_cast<uint8_t>(1u << gim::number_between(random, 0, 7));
    }
    return file;
}

Bytes read(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) return std::fprintf(stderr, "usage: write_damaged VECTORS FOLDER\n"), 2;
    std::vector<std::filesystem::path> paths;
    for (const char* folder : {"valid", "invalid"})
        for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(argv[1]) / folder))
            if (entry.path().extension() == ".gim") paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end());
    const std::filesystem::path folder = argv[2];
    std::filesystem::create_directories(folder);
    std::ofstream bytes(folder / "damaged.bin", std::ios::binary), text(folder / "damaged.txt");
    gim::Random random(1);
    for (const auto& path : paths) {
        const Bytes file = read(path);
        gim_info info;
        std::vector<Chunk> chunks;
        const bool can_sign = gim_read_info(file.data(), file.size(), nullptr, &info) == GIM_OK;
        if (can_sign) chunks = find_chunks(file, info);
        for (int i = 0; i < kCopies; ++i) {
            Bytes copy = damaged(file, random);
            if (can_sign && i % 6 != 0) sign(chunks, info.index_size, &copy);
            bytes.write(reinterpret_cast<const char*>(copy.data()), static_cast<std::streamsize>(copy.size()));
            text << path.stem().string() << ' ' << copy.size() << ' ' << Walk(copy).hash() << '\n';
        }
    }
    bytes.flush();
    text.flush();
    return bytes && text ? 0 : (std::fprintf(stderr, "cannot write to %s\n", argv[2]), 1);
}
