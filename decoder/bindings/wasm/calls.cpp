// What the JavaScript of the npm package calls besides gim/decoder.h: records as rows of numbers, so that the script
// needs no knowledge of how a compiler lays out a struct. decoder/bindings/npm/core.js reads them in the same order.
#include <cstddef>
#include <cstdint>

#include "gim/decoder.h"

namespace {

// The memory of one call.
struct Session {
    double numbers[64];  // where functions put what they read
    gim_info info;       // core.js passes its address to gim_decode_...
};
static_assert(offsetof(Session, info) == 512);

// Appends numbers to those of a session.
class Row {
  public:
    explicit Row(Session* session) : next_(session->numbers) {}
    template <class... Numbers>
    void add(Numbers... numbers) {
        ((*next_++ = static_cast<double>(numbers)), ...);
    }

  private:
    double* next_;
};

void add_box(Row& row, const gim_box& box) {
    for (const float low : box.low) row.add(low);
    for (const float high : box.high) row.add(high);
}

}  // namespace

extern "C" {

uint32_t gim_js_session_size(void) { return sizeof(Session); }

gim_status gim_js_info(Session* session, const void* bytes, size_t size, double max_samples, uint32_t max_images,
                       uint32_t max_side) {
    const gim_limits limits = {static_cast<uint64_t>(max_samples), max_images, max_side};
    gim_info& info = session->info;
    const gim_status status = gim_read_info(bytes, size, &limits, &info);
    if (status != GIM_OK) return status;
    Row row(session);
    row.add(info.version, info.layout, info.coding, info.bits, info.image_count, info.level_count, info.sample_count,
            info.file_size, info.is_relative, info.step, info.quantizer, info.index_size);
    for (const double origin : info.origin) row.add(origin);
    for (const float error : info.level_rms_error) row.add(error);
    for (const float error : info.level_max_error) row.add(error);
    row.add(info.has_boxes);
    add_box(row, info.box);
    row.add(info.chunk_count);
    return status;
}

gim_status gim_js_box(Session* session, const void* bytes, size_t size, uint32_t image) {
    gim_box box;
    const gim_status status = gim_read_box(&session->info, bytes, size, image, &box);
    if (status != GIM_OK) return status;
    Row row(session);
    add_box(row, box);
    return status;
}

// What a chunk is (the number of its type), which level (-1: none), where it begins and how long it is.
gim_status gim_js_chunk(Session* session, const void* bytes, size_t size, uint32_t i) {
    gim_chunk chunk;
    const gim_status status = gim_read_chunk(&session->info, bytes, size, i, &chunk);
    if (status == GIM_OK) Row(session).add(chunk.type, chunk.level, chunk.offset, chunk.size);
    return status;
}

uint32_t gim_js_choose(Session* session, float distance, float vertical_fov, float viewport_height, float pixel_error,
                       uint32_t shown) {
    const gim_view view = {distance, vertical_fov, viewport_height, pixel_error};
    return gim_choose_level(&session->info, &view, shown);
}

gim_status gim_js_level(Session* session, const void* bytes, size_t size, uint32_t image, uint32_t level) {
    gim_level_info info;
    const gim_status status = gim_read_level_info(&session->info, bytes, size, image, level, &info);
    if (status == GIM_OK)
        Row(session).add(info.side, info.width, info.height, info.coarsest_level, info.vertex_count,
                         info.triangle_count, info.prefix_size, info.scratch_size);
    return status;
}

gim_status gim_js_plane(Session* session, const void* bytes, size_t size, uint32_t image, uint32_t kind,
                        uint32_t level) {
    gim_plane_info info;
    const gim_status status = gim_read_plane_info(&session->info, bytes, size, image, kind, level, &info);
    if (status == GIM_OK)
        Row(session).add(info.width, info.height, info.coarsest_level, info.quantizer, info.stream_size,
                         info.prefix_size, info.scratch_size);
    return status;
}

gim_status gim_js_labels(Session* session, const void* bytes, size_t size, uint32_t image, uint32_t level) {
    gim_labels_info info;
    const gim_status status = gim_read_labels_info(&session->info, bytes, size, image, level, &info);
    if (status == GIM_OK) Row(session).add(info.cell_count, info.prefix_size, info.scratch_size);
    return status;
}
}
