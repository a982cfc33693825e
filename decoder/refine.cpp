// The C interface of gim/refine.h.
#include "gim/refine.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <span>

#include "decoder/domains.h"
#include "decoder/layout/level_reader.h"
#include "decoder/open_domain.h"
#include "decoder/refine/details.h"
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

Status read_shape(const LevelRequest& request, DomainShape* shape, uint64_t* scratch) {
    const DomainReader* reader = domain_reader_of(request.header.layout);
    if (!reader) return Status::kBadArgument;
    if (Status s = reader->shape(request, shape, scratch); s != Status::kOk) return s;
    // Numbers of half-edges of base triangles must fit.
    if (shape->tiles > UINT32_MAX / 8) return Status::kLimitExceeded;
    *scratch = whole_scratch(*shape, *scratch);
    return Status::kOk;
}

// Once read_shape has found the layout to have tiles.
Status read_glue(const LevelRequest& request, const DomainShape& shape, void* scratch, TileGlue* glue) {
    return domain_reader_of(request.header.layout)->read_glue(request, shape, scratch, glue);
}

gim_domain_info describe(const DomainShape& shape, uint64_t scratch) {
    return {shape.tiles,        shape.intervals, shape.vertices, shape.most_triangles(),
            domain_size(shape), scratch,         shape.width(),  shape.height()};
}

// Chooses diagonals and rates samples, once it is known how tiles are glued. edges: room for edge_slots(shape).
const gim_domain* finish(const DomainShape& shape, const float* positions, uint64_t* edges, DomainMemory* parts) {
    choose_diagonals(shape, positions, edges, &parts->glue);
    new (parts->head) gim_domain{QuadDomain(shape, parts->glue, parts->values)};
    rate_samples(parts->head->domain, positions, parts->values);
    return parts->head;
}

// Level 0, and the finer image that displacements make of it.
struct Detailed {
    PlaneLevel plane;
    uint32_t finer = 0;
    DomainShape coarse, shape;
    uint64_t scratch = 0;

    LevelRequest finer_than(const LevelRequest& request) const {
        return {request.header, request.file, request.limits, request.image, request.level, finer};
    }
};

// request: for the finest level.
Status read_detailed(const LevelReader& reader, const LevelRequest& request, uint32_t plane_level, Detailed* d) {
    const LevelRequest of_plane = {request.header, request.file, request.limits, request.image, plane_level};
    if (Status s = open_plane(reader, of_plane, GIM_PLANE_DISPLACEMENTS, &d->plane); s != Status::kOk) return s;
    gim_level_info level;
    if (Status s = reader.level_info(request, &level); s != Status::kOk) return s;
    while (uint64_t{level.width - 1} << d->finer < d->plane.width - 1) ++d->finer;
    if (uint64_t{level.width - 1} << d->finer != d->plane.width - 1) return Status::kNoSuchLevel;
    uint64_t of_coarse = 0, of_fine = 0;
    if (Status s = read_shape(request, &d->coarse, &of_coarse); s != Status::kOk) return s;
    if (Status s = read_shape(d->finer_than(request), &d->shape, &of_fine); s != Status::kOk) return s;
    Arena arena(nullptr);
    (void)lay_out_glue(d->coarse, &arena);
    (void)arena.take<uint8_t>(0);
    d->scratch = arena.used() + std::max(of_coarse, of_fine);
    return Status::kOk;
}

// Calls f(sample, vertex) for the samples of all tiles, as their place in the image, row by row.
template <class F>
void for_each_sample(const QuadDomain& domain, const F& f) {
    const DomainShape& shape = domain.shape();
    for (uint32_t t = 0; t < shape.tiles; ++t) {
        for (uint32_t row = 0; row <= shape.intervals; ++row) {
            const size_t first = size_t{shape.row_of(t) + row} * shape.width() + shape.column_of(t);
            for (uint32_t column = 0; column <= shape.intervals; ++column)
                f(first + column, domain.vertex_at(t, row, column));
        }
    }
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
    return with_level(info, bytes, size, image, level, [&](const LevelReader&, const LevelRequest& request) {
        DomainShape shape;
        uint64_t scratch = 0;
        if (Status s = read_shape(request, &shape, &scratch); s != Status::kOk) return s;
        *out = describe(shape, scratch);
        return Status::kOk;
    });
}

gim_status gim_open_domain(const gim_info* info, const void* bytes, size_t size, uint32_t image, uint32_t level,
                           const float* positions, void* memory, size_t memory_size, void* scratch, size_t scratch_size,
                           const gim_domain** domain) {
    if (!positions || !domain || !is_aligned(memory)) return GIM_BAD_ARGUMENT;
    return with_level(info, bytes, size, image, level, [&](const LevelReader&, const LevelRequest& request) {
        DomainShape shape;
        uint64_t of_scratch = 0;
        if (Status s = read_shape(request, &shape, &of_scratch); s != Status::kOk) return s;
        if (Status s = check_scratch({scratch, scratch_size}, of_scratch); s != Status::kOk) return s;
        if (memory_size < domain_size(shape)) return Status::kScratchTooSmall;
        Arena arena(memory);
        DomainMemory parts(shape, &arena);
        if (Status s = read_glue(request, shape, scratch, &parts.glue); s != Status::kOk) return s;
        *domain = finish(shape, positions, static_cast<uint64_t*>(scratch), &parts);
        return Status::kOk;
    });
}

gim_status gim_read_detailed_domain_info(const gim_info* info, const void* bytes, size_t size, uint32_t image,
                                         uint32_t plane_level, gim_domain_info* out) {
    if (!out) return GIM_BAD_ARGUMENT;
    return with_level(info, bytes, size, image, 0, [&](const LevelReader& reader, const LevelRequest& request) {
        Detailed d;
        if (Status s = read_detailed(reader, request, plane_level, &d); s != Status::kOk) return s;
        *out = describe(d.shape, d.scratch);
        return Status::kOk;
    });
}

gim_status gim_open_detailed_domain(const gim_info* info, const void* bytes, size_t size, uint32_t image,
                                    uint32_t plane_level, const float* positions, const float* displacements,
                                    float* detailed, void* memory, size_t memory_size, void* scratch,
                                    size_t scratch_size, const gim_domain** domain) {
    if (!positions || !displacements || !detailed || !domain || !is_aligned(memory)) return GIM_BAD_ARGUMENT;
    return with_level(info, bytes, size, image, 0, [&](const LevelReader& reader, const LevelRequest& request) {
        Detailed d;
        if (Status s = read_detailed(reader, request, plane_level, &d); s != Status::kOk) return s;
        if (Status s = check_scratch({scratch, scratch_size}, d.scratch); s != Status::kOk) return s;
        if (memory_size < domain_size(d.shape)) return Status::kScratchTooSmall;
        Arena of_memory(memory), of_scratch(scratch);
        DomainMemory parts(d.shape, &of_memory);
        TileGlue coarse_glue = lay_out_glue(d.coarse, &of_scratch);
        uint8_t* rest = of_scratch.take<uint8_t>(0);
        if (Status s = read_glue(request, d.coarse, rest, &coarse_glue); s != Status::kOk) return s;
        if (Status s = read_glue(d.finer_than(request), d.shape, rest, &parts.glue); s != Status::kOk) return s;
        displace(QuadDomain(d.coarse, coarse_glue, nullptr), QuadDomain(d.shape, parts.glue, nullptr),
                 {displacements, d.plane.width, d.finer}, positions, detailed);
        *domain = finish(d.shape, detailed, reinterpret_cast<uint64_t*>(rest), &parts);
        return Status::kOk;
    });
}

void gim_read_sample_vertices(const gim_domain* domain, uint32_t* vertices) {
    const DomainShape& shape = domain->domain.shape();
    std::fill_n(vertices, size_t{shape.width()} * shape.height(), GIM_NOTHING);
    for_each_sample(domain->domain, [&](size_t sample, uint32_t vertex) { vertices[sample] = vertex; });
}

void gim_lay_out_samples(const gim_domain* domain, const float* of_vertices, uint32_t components, float* samples) {
    const DomainShape& shape = domain->domain.shape();
    std::fill_n(samples, size_t{shape.width()} * shape.height() * components, std::numeric_limits<float>::quiet_NaN());
    for_each_sample(domain->domain, [&](size_t sample, uint32_t vertex) {
        std::copy_n(of_vertices + size_t{vertex} * components, components, samples + sample * components);
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
    const DomainShape& shape = mesh->mesh.domain().shape();
    if (shape.width() - 1 > UINT16_MAX || shape.height() - 1 > UINT16_MAX) return GIM_LIMIT_EXCEEDED;
    PatchList list(patches, capacity);
    list_patches(mesh->mesh, &list);
    *count = list.count();
    return list.count() > capacity ? GIM_SCRATCH_TOO_SMALL : GIM_OK;
}
