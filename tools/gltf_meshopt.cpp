#include "tools/gltf_meshopt.h"

#include <meshoptimizer.h>

namespace gim::gltf {
namespace {

// The first byte of a stream: the codec in the upper half, its version in the lower.
struct Codec {
    uint8_t mark;
    uint8_t newest_version;
    std::string name;
};

void check_codec(const Codec& codec, std::span<const uint8_t> source) {
    if (source.empty()) throw Failure("it has no compressed bytes (is the file cut short?)");
    if ((source[0] & 0xf0) != codec.mark) throw Failure("its bytes are no stream of the " + codec.name + " codec");
    const int version = source[0] & 0x0f;
    if (version > codec.newest_version) {
        throw Failure("version " + std::to_string(version) + " of the " + codec.name + " codec; gim reads up to " +
                      std::to_string(codec.newest_version) + ": compress it with EXT_meshopt_compression, or not");
    }
}

struct Layout {
    std::string mode, filter;
    uint64_t count, stride;
};

// A stream cannot hold more than this, whatever it claims. Vertices: two bits for sixteen bytes. Indices: a byte for a
// triangle or an index.
uint64_t most_decoded_bytes(const Layout& layout, uint64_t source) {
    if (layout.mode == "ATTRIBUTES") return source * 64;
    return source * (layout.mode == "TRIANGLES" ? 3 : 1) * layout.stride;
}

// The decoders check the bytes that they read, but only assert what their caller chooses.
void check_layout(const Layout& layout) {
    const bool vertices = layout.mode == "ATTRIBUTES";
    if (!vertices && layout.mode != "TRIANGLES" && layout.mode != "INDICES") {
        throw Failure("the mode " + layout.mode.substr(0, 40) + " is unknown");
    }
    const bool stride_ok = vertices ? layout.stride > 0 && layout.stride <= 256 && layout.stride % 4 == 0
                                    : layout.stride == 2 || layout.stride == 4;
    if (!stride_ok) throw Failure("its \"byteStride\" is not one of the mode " + layout.mode);
    if (layout.mode == "TRIANGLES" && layout.count % 3 != 0) throw Failure("its \"count\" is no multiple of 3");
    if (layout.filter == "NONE") return;
    bool filter_ok = vertices;
    if (layout.filter == "OCTAHEDRAL") {
        filter_ok = filter_ok && (layout.stride == 4 || layout.stride == 8);
    } else if (layout.filter == "QUATERNION") {
        filter_ok = filter_ok && layout.stride == 8;
    } else if (layout.filter != "EXPONENTIAL") {
        throw Failure("the filter " + layout.filter.substr(0, 40) + " is unknown");
    }
    if (!filter_ok) throw Failure("the filter " + layout.filter + " does not fit its mode and \"byteStride\"");
}

int decode(const Layout& layout, std::span<const uint8_t> source, Bytes& out) {
    if (layout.mode == "ATTRIBUTES") {
        check_codec({0xa0, 0, "vertex"}, source);
        return meshopt_decodeVertexBuffer(out.data(), layout.count, layout.stride, source.data(), source.size());
    }
    if (layout.mode == "TRIANGLES") {
        check_codec({0xe0, 1, "triangle"}, source);
        return meshopt_decodeIndexBuffer(out.data(), layout.count, layout.stride, source.data(), source.size());
    }
    check_codec({0xd0, 1, "index"}, source);
    return meshopt_decodeIndexSequence(out.data(), layout.count, layout.stride, source.data(), source.size());
}

void apply_filter(const Layout& layout, Bytes& out) {
    if (layout.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(out.data(), layout.count, layout.stride);
    if (layout.filter == "QUATERNION") meshopt_decodeFilterQuat(out.data(), layout.count, layout.stride);
    if (layout.filter == "EXPONENTIAL") meshopt_decodeFilterExp(out.data(), layout.count, layout.stride);
}

}  // namespace

Bytes decode_meshopt(const Json& packed, std::span<const uint8_t> source, MemoryBudget& memory) {
    const Layout layout = {text(packed, "mode"), text(packed, "filter", "NONE"),
                           whole_number(packed, "count").value_or(0), whole_number(packed, "byteStride").value_or(0)};
    check_layout(layout);
    if (layout.count == 0) return {};
    if (layout.count > most_decoded_bytes(layout, source.size()) / layout.stride) {
        throw Failure("it claims more elements than its bytes can hold (is the file cut short?)");
    }
    take(memory, layout.count, layout.stride, "its compressed buffer views");
    Bytes out(layout.count * layout.stride);
    if (decode(layout, source, out) != 0) throw Failure("its bytes are damaged");
    apply_filter(layout, out);
    return out;
}

}  // namespace gim::gltf
