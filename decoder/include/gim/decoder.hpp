// gim/decoder.hpp: gim/decoder.h for C++20. Header-only; it adds memory management and checks of sizes, nothing else.
//
//   gim::Decoder decoder;
//   gim::DecoderLevel level;
//   gim_status s = decoder.open(bytes);                         // keeps a span: the bytes must outlive the decoder
//   if (s == GIM_OK) s = decoder.read_level(0, 0, &level);      // image 0, level 0 = full resolution
//   std::vector<float> positions(level.vertex_count * size_t{3});
//   std::vector<uint32_t> triangles(level.triangle_count * size_t{3});
//   if (s == GIM_OK) s = decoder.mesh(level, {positions, {}, {}, triangles});
//
// Every call returns a gim_status and throws nothing. The decoder owns the scratch that the C functions ask for, and
// keeps the largest piece that a call has needed. If there is no memory for it, the call returns GIM_SCRATCH_TOO_SMALL.
// One decoder serves one thread at a time. Any number of decoders may share the same bytes.
#ifndef GIM_DECODER_HPP
#define GIM_DECODER_HPP

#include <gim/decoder.h>

#include <cstddef>
#include <cstdint>
#include <new>
#include <span>
#include <utility>

namespace gim {

// Memory as the C functions ask for it: aligned to 16 bytes.
class Scratch {
  public:
    static constexpr std::size_t kAlignment = 16;

    Scratch() = default;
    explicit Scratch(std::uint64_t size) noexcept { (void)reserve(size); }
    Scratch(Scratch&& other) noexcept
        : memory_(std::exchange(other.memory_, nullptr)), size_(std::exchange(other.size_, 0)) {}
    Scratch& operator=(Scratch&& other) noexcept {
        std::swap(memory_, other.memory_);
        std::swap(size_, other.size_);
        return *this;
    }
    ~Scratch() { release(); }

    // Makes room for at least `size` bytes. Contents are lost if it grows. Returns false if there is no memory.
    bool reserve(std::uint64_t size) noexcept {
        if (size <= size_) return true;
        release();
        if (size > SIZE_MAX) return false;
        const auto bytes = static_cast<std::size_t>(size);
        memory_ = ::operator new (bytes, std::align_val_t{kAlignment}, std::nothrow);
        if (memory_) size_ = bytes;
        return memory_ != nullptr;
    }
    void* data() noexcept { return memory_; }
    std::size_t size() const noexcept { return size_; }

  private:
    void release() noexcept {
        ::operator delete (memory_, std::align_val_t{kAlignment});
        memory_ = nullptr;
        size_ = 0;
    }
    void* memory_ = nullptr;
    std::size_t size_ = 0;
};

// One level of one image, as Decoder::read_level fills it.
struct DecoderLevel : gim_level_info {
    std::uint32_t image = 0, level = 0;

    DecoderLevel() : gim_level_info{} {}
};

// One level of an attribute plane of one image, as Decoder::read_plane fills it.
struct DecoderPlane : gim_plane_info {
    std::uint32_t image = 0, kind = 0, level = 0;

    DecoderPlane() : gim_plane_info{} {}
};

// Where a decoded surface goes. n is vertex_count for a mesh, width * height for a grid. Leave unwanted spans empty.
struct SurfaceSpans {
    std::span<float> positions;          // n * 3; always wanted
    std::span<float> normals;            // n * 3
    std::span<float> texcoords;          // n * 2
    std::span<std::uint32_t> triangles;  // triangle_count * 3
};

class Decoder {
  public:
    // Reads header and index. limits: nullptr for the defaults.
    gim_status open(std::span<const std::uint8_t> bytes, const gim_limits* limits = nullptr) noexcept {
        bytes_ = bytes;
        info_ = {};
        return gim_read_info(bytes.data(), bytes.size(), limits, &info_);
    }
    // The header and index of the file that was opened last; zeros if that failed.
    const gim_info& info() const noexcept { return info_; }

    gim_status read_box(std::uint32_t image, gim_box* box) const noexcept {
        return gim_read_box(&info_, bytes_.data(), bytes_.size(), image, box);
    }

    gim_status read_level(std::uint32_t image, std::uint32_t level, DecoderLevel* out) const noexcept {
        const gim_status status = gim_read_level_info(&info_, bytes_.data(), bytes_.size(), image, level, out);
        if (status != GIM_OK) return status;
        out->image = image;
        out->level = level;
        return GIM_OK;
    }

    // Decode one level. level: as this decoder has read it from the open file. Return GIM_BAD_ARGUMENT if a span is
    // neither empty nor of the size that the level asks for.
    gim_status mesh(const DecoderLevel& level, const SurfaceSpans& out) noexcept {
        return decode(gim_decode_mesh, level, level.vertex_count, out);
    }
    // n of the spans is width * height; *vertex_count receives how many of them are used.
    gim_status hard_mesh(const DecoderLevel& level, std::uint32_t* vertex_count, const SurfaceSpans& out) noexcept {
        const auto function = [vertex_count](const gim_info* info, const void* bytes, std::size_t size,
                                             std::uint32_t image, std::uint32_t at_level, float* positions,
                                             auto... others) {
            return gim_decode_hard_mesh(info, bytes, size, image, at_level, vertex_count, positions, others...);
        };
        return decode(function, level, std::uint64_t{level.width} * level.height, out);
    }
    gim_status grid(const DecoderLevel& level, const SurfaceSpans& out) noexcept {
        return decode(gim_decode_grid, level, std::uint64_t{level.width} * level.height, out);
    }

    // kind: GIM_PLANE_... Returns GIM_NO_SUCH_PLANE if the file has none of that kind.
    gim_status read_plane(std::uint32_t image, std::uint32_t kind, std::uint32_t level,
                          DecoderPlane* out) const noexcept {
        const gim_status status = gim_read_plane_info(&info_, bytes_.data(), bytes_.size(), image, kind, level, out);
        if (status != GIM_OK) return status;
        out->image = image;
        out->kind = kind;
        out->level = level;
        return GIM_OK;
    }
    // values: width * height * 3 numbers. Returns GIM_BAD_ARGUMENT on any other size.
    gim_status plane(const DecoderPlane& of, std::span<float> values) noexcept {
        if (values.empty() || values.size() != std::uint64_t{of.width} * of.height * 3) return GIM_BAD_ARGUMENT;
        if (!scratch_.reserve(of.scratch_size)) return GIM_SCRATCH_TOO_SMALL;
        return gim_decode_plane(&info_, bytes_.data(), bytes_.size(), of.image, of.kind, of.level, values.data(),
                                scratch_.data(), scratch_.size());
    }

    // Returns GIM_NO_SUCH_PLANE if the file has no labels.
    gim_status read_labels(const DecoderLevel& level, gim_labels_info* out) const noexcept {
        return gim_read_labels_info(&info_, bytes_.data(), bytes_.size(), level.image, level.level, out);
    }
    // out: triangle_count / 2 labels. Returns GIM_BAD_ARGUMENT on any other size.
    gim_status labels(const DecoderLevel& level, std::span<std::uint8_t> out) noexcept {
        gim_labels_info of{};
        if (const gim_status status = read_labels(level, &of); status != GIM_OK) return status;
        if (out.empty() || out.size() != of.cell_count) return GIM_BAD_ARGUMENT;
        if (!scratch_.reserve(of.scratch_size)) return GIM_SCRATCH_TOO_SMALL;
        return gim_decode_labels(&info_, bytes_.data(), bytes_.size(), level.image, level.level, out.data(),
                                 scratch_.data(), scratch_.size());
    }

    gim_status read_chunk(std::uint32_t i, gim_chunk* chunk) const noexcept {
        return gim_read_chunk(&info_, bytes_.data(), bytes_.size(), i, chunk);
    }

    // The length of the text that the file carries about itself. It is a claim of the file: cap it before you allocate.
    gim_status read_text_size(std::uint64_t* size) const noexcept {
        return gim_read_text(&info_, bytes_.data(), bytes_.size(), nullptr, 0, size, nullptr, 0);
    }
    // out: as long as the text. Returns GIM_SCRATCH_TOO_SMALL if it is shorter, GIM_BAD_ARGUMENT if it is longer.
    gim_status text(std::span<char> out) noexcept {
        std::uint64_t size = 0;
        if (const gim_status status = read_text_size(&size); status != GIM_OK) return status;
        if (out.size() > size) return GIM_BAD_ARGUMENT;
        if (out.empty()) return size == 0 ? GIM_OK : GIM_SCRATCH_TOO_SMALL;
        if (!scratch_.reserve(gim_text_scratch_size())) return GIM_SCRATCH_TOO_SMALL;
        return gim_read_text(&info_, bytes_.data(), bytes_.size(), out.data(), out.size(), &size, scratch_.data(),
                             scratch_.size());
    }

    // class_of: 4 * (side - 1) entries, or empty if not wanted. Returns GIM_BAD_ARGUMENT on any other size.
    gim_status seams(const DecoderLevel& level, std::span<std::uint32_t> class_of,
                     std::uint32_t* path_count) const noexcept {
        if (!class_of.empty() && (level.side == 0 || class_of.size() != std::uint64_t{level.side - 1} * 4))
            return GIM_BAD_ARGUMENT;
        return gim_read_seams(&info_, bytes_.data(), bytes_.size(), level.image, level.level, data_of(class_of),
                              path_count);
    }

  private:
    template <class T>
    static T* data_of(std::span<T> values) noexcept {
        return values.empty() ? nullptr : values.data();
    }
    static bool fits(std::size_t size, std::uint64_t wanted) noexcept { return size == 0 || size == wanted; }

    template <class DecodeFunction>
    gim_status decode(DecodeFunction function, const DecoderLevel& level, std::uint64_t vertices,
                      const SurfaceSpans& out) noexcept {
        if (out.positions.empty() || !fits(out.positions.size(), vertices * 3) ||
            !fits(out.normals.size(), vertices * 3) || !fits(out.texcoords.size(), vertices * 2) ||
            !fits(out.triangles.size(), std::uint64_t{level.triangle_count} * 3))
            return GIM_BAD_ARGUMENT;
        if (!scratch_.reserve(level.scratch_size)) return GIM_SCRATCH_TOO_SMALL;
        return function(&info_, bytes_.data(), bytes_.size(), level.image, level.level, out.positions.data(),
                        data_of(out.normals), data_of(out.texcoords), data_of(out.triangles), scratch_.data(),
                        scratch_.size());
    }

    std::span<const std::uint8_t> bytes_;
    gim_info info_{};
    Scratch scratch_;
};

}  // namespace gim

#endif
