// The C interface of gim/refine.h.
#include "gim/refine.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <span>

#include "decoder/layout/level_reader.h"
#include "decoder/open_domain.h"
#include "decoder/refine/patches.h"
#include "decoder/refine/quad_domain.h"
#include "decoder/refine/refined_mesh.h"
#include "decoder/refine/refiner.h"
#include "decoder/with_image.h"

using namespace gim;

struct gim_refined {
    RefinedMesh mesh;
    Refiner refiner;
};

namespace {

static_assert(GIM_NOTHING == kNoHalfEdge);

// What gim_open_domain keeps, in the caller's memory.
struct DomainMemory {
    gim_domain* head;
    TileGlue glue;
    SampleValue* values;

    DomainMemory(const DomainShape& shape, Arena* arena)
        : head(arena->take<gim_domain>(1)),
          glue(lay_out_glue(shape, arena)),
          values(arena->take<SampleValue>(shape.vertices)) {}
};

uint64_t domain_size(const DomainShape& shape) {
    Arena arena(nullptr);
    (void)DomainMemory(shape, &arena);
    return arena.used();
}

// Edges are marked after the glue was read, in the same memory.
uint64_t whole_scratch(const DomainShape& shape, uint64_t of_glue) {
    return std::max<uint64_t>(of_glue, uint64_t{edge_slots(shape)} * sizeof(uint64_t));
}

Status read_shape(const LevelReader& reader, const LevelRequest& request, DomainShape* shape, uint64_t* scratch) {
    if (!reader.domain_shape) return Status::kBadArgument;
    if (Status s = reader.domain_shape(request, shape, scratch); s != Status::kOk) return s;
    // Numbers of half-edges of base triangles must fit.
    if (shape->tiles > UINT32_MAX / 8) return Status::kLimitExceeded;
    *scratch = whole_scratch(*shape, *scratch);
    return Status::kOk;
}

constexpr uintptr_t kAlignment = 16;
bool is_aligned(const void* memory) { return memory && reinterpret_cast<uintptr_t>(memory) % kAlignment == 0; }

bool is_sound(const gim_rule& rule) {
    const auto is_fine = [](float x) { return x >= 0 && std::isfinite(x); };
    const float* box = rule.box;
    return is_fine(rule.pixel_error) && is_fine(rule.pixels_per_unit) && is_fine(rule.object_error) &&
           is_fine(rule.sphere[3]) && is_fine(rule.keep) && rule.keep <= 1 && (rule.planes || rule.plane_count == 0) &&
           box[0] <= box[3] && box[1] <= box[4] && box[2] <= box[5];
}

}  // namespace

gim_status gim_read_domain_info(const gim_info* info, const void* bytes, size_t size, uint32_t image, uint32_t level,
                                gim_domain_info* out) {
    if (!out) return GIM_BAD_ARGUMENT;
    return with_image(info, bytes, size, image, level, [&](const LevelReader& reader, const LevelRequest& request) {
        DomainShape shape;
        uint64_t scratch = 0;
        if (Status s = read_shape(reader, request, &shape, &scratch); s != Status::kOk) return s;
        *out = {shape.tiles, shape.intervals, shape.vertices, shape.most_triangles(), domain_size(shape), scratch};
        return Status::kOk;
    });
}

gim_status gim_open_domain(const gim_info* info, const void* bytes, size_t size, uint32_t image, uint32_t level,
                           const float* positions, void* memory, size_t memory_size, void* scratch, size_t scratch_size,
                           const gim_domain** domain) {
    if (!positions || !domain || !is_aligned(memory)) return GIM_BAD_ARGUMENT;
    return with_image(info, bytes, size, image, level, [&](const LevelReader& reader, const LevelRequest& request) {
        DomainShape shape;
        uint64_t of_scratch = 0;
        if (Status s = read_shape(reader, request, &shape, &of_scratch); s != Status::kOk) return s;
        if (Status s = check_scratch({scratch, scratch_size}, of_scratch); s != Status::kOk) return s;
        if (memory_size < domain_size(shape)) return Status::kScratchTooSmall;
        Arena arena(memory);
        DomainMemory parts(shape, &arena);
        if (Status s = reader.read_glue(request, shape, scratch, &parts.glue); s != Status::kOk) return s;
        choose_diagonals(shape, positions, static_cast<uint64_t*>(scratch), &parts.glue);
        new (parts.head) gim_domain{QuadDomain(shape, parts.glue, parts.values)};
        rate_samples(parts.head->domain, positions, parts.values);
        *domain = parts.head;
        return Status::kOk;
    });
}

void gim_vertex_worth(const gim_domain* domain, uint32_t vertex, float* error, float* radius) {
    const SampleValue& value = domain->domain.value(vertex);
    *error = value.error;
    *radius = value.radius;
}

uint64_t gim_refined_size(const gim_domain* domain, uint32_t most_triangles) {
    if (!domain || most_triangles < 2 * domain->domain.shape().tiles || most_triangles > UINT32_MAX / 4) return 0;
    Arena arena(nullptr);
    (void)arena.take<gim_refined>(1);
    RefinedMesh mesh(&domain->domain, most_triangles, &arena);
    (void)Refiner(&mesh, &arena);
    return arena.used();
}

gim_status gim_begin_refined(const gim_domain* domain, uint32_t most_triangles, void* memory, size_t memory_size,
                             gim_refined** mesh) {
    if (!domain || !mesh || !is_aligned(memory)) return GIM_BAD_ARGUMENT;
    const uint64_t needed = gim_refined_size(domain, most_triangles);
    if (needed == 0) return GIM_BAD_ARGUMENT;
    if (memory_size < needed) return GIM_SCRATCH_TOO_SMALL;
    Arena arena(memory);
    auto* head = arena.take<gim_refined>(1);
    new (&head->mesh) RefinedMesh(&domain->domain, most_triangles, &arena);
    new (&head->refiner) Refiner(&head->mesh, &arena);
    head->mesh.reset();
    *mesh = head;
    return GIM_OK;
}

const uint32_t* gim_refined_triangles(const gim_refined* mesh, uint32_t* triangle_count) {
    if (triangle_count) *triangle_count = mesh->mesh.triangle_count();
    return mesh->mesh.triangles();
}

gim_status gim_read_half_edge(const gim_refined* mesh, uint32_t half_edge, gim_half_edge* read) {
    if (!mesh || !read || triangle_of(half_edge) >= mesh->mesh.triangle_count()) return GIM_BAD_ARGUMENT;
    const RefinedMesh& m = mesh->mesh;
    const TilePlace start = m.start(half_edge), end = m.start(next_half_edge(half_edge));
    const uint32_t vertex = m.vertex(half_edge);
    *read = {m.mate(half_edge),     vertex,         m.tile(triangle_of(half_edge)), {start.row, start.column},
             {end.row, end.column}, m.level(vertex)};
    return GIM_OK;
}

gim_status gim_split(gim_refined* mesh, uint32_t triangle) {
    if (!mesh) return GIM_BAD_ARGUMENT;
    return static_cast<gim_status>(mesh->mesh.split(triangle));
}

gim_status gim_weld(gim_refined* mesh, uint32_t vertex) {
    return mesh && mesh->mesh.weld(vertex) ? GIM_OK : GIM_BAD_ARGUMENT;
}

void gim_take_changes(gim_refined* mesh, gim_changes* changes) {
    const MeshChanges c = mesh->mesh.take_changes();
    const auto count = [](std::span<const uint32_t> all) { return static_cast<uint32_t>(all.size()); };
    *changes = {c.added.data(),     c.removed.data(),   count(c.added),     count(c.removed),
                c.triangles.data(), count(c.triangles), c.triangles_before, mesh->mesh.triangle_count()};
}

gim_status gim_refine(gim_refined* mesh, const gim_rule* rule, uint32_t most_operations, uint32_t* done) {
    if (!mesh || !rule || !is_sound(*rule)) return GIM_BAD_ARGUMENT;
    const bool is_done = mesh->refiner.run(*rule, most_operations);
    if (done) *done = is_done ? 1 : 0;
    return GIM_OK;
}

gim_status gim_read_patches(const gim_refined* mesh, gim_patch* patches, uint32_t capacity, uint32_t* count) {
    if (!mesh || !count || (!patches && capacity > 0)) return GIM_BAD_ARGUMENT;
    const QuadDomain& domain = mesh->mesh.domain();
    const TileGlue& glue = domain.glue();
    const uint64_t rows = (domain.shape().tiles + glue.columns - 1) / glue.columns;
    if (glue.columns * uint64_t{glue.slot} > UINT16_MAX || rows * glue.slot > UINT16_MAX) return GIM_LIMIT_EXCEEDED;
    PatchList list(patches, capacity);
    list_patches(mesh->mesh, &list);
    *count = list.count();
    return list.count() > capacity ? GIM_SCRATCH_TOO_SMALL : GIM_OK;
}
