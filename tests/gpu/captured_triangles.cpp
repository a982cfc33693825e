#include "tests/gpu/captured_triangles.h"

#include <gtest/gtest.h>

#include "tools/gpu/gl_program.h"

namespace gim::test {
namespace {

struct Vertex {
    std::array<float, 4> position;
    std::array<float, 2> map_at;
};

uint32_t draw(GlSurface& surface, GLuint query) {
    glBeginQuery(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN, query);
    glBeginTransformFeedback(GL_TRIANGLES);
    GLint first = 0;
    for (const uint32_t end : surface.patch_batches()) {
        glDrawArrays(GL_PATCHES, first, static_cast<GLsizei>(end) - first);
        first = static_cast<GLint>(end);
    }
    glEndTransformFeedback();
    glEndQuery(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN);
    GLuint triangles = 0;
    glGetQueryObjectuiv(query, GL_QUERY_RESULT, &triangles);
    return triangles;
}

}  // namespace

std::vector<SoftTriangle> captured_triangles(GlSurface& surface, const SurfaceData& data) {
    auto program = GlProgram::build({"patch.vert", "patch.tesc", "patch.tese"}, {"gl_Position", "map_at"});
    EXPECT_TRUE(program.ok()) << program.error().message;
    ShaderView as_it_is;
    for (size_t i = 0; i < 16; i += 5) as_it_is.world_to_clip[i] = 1;
    surface.set_view(as_it_is);
    surface.bind(0);
    program.value().use();
    const GlVertexArray no_vertices = make_vertex_array();
    glBindVertexArray(no_vertices.name());
    glPatchParameteri(GL_PATCH_VERTICES, 1);
    const size_t room = size_t{3} << 19;
    GlBuffer vertices(room * sizeof(Vertex));
    vertices.bind(GL_TRANSFORM_FEEDBACK_BUFFER, 0);
    GLuint query = 0;
    glGenQueries(1, &query);
    glEnable(GL_RASTERIZER_DISCARD);
    const uint32_t triangles = draw(surface, query);
    glDisable(GL_RASTERIZER_DISCARD);
    glDeleteQueries(1, &query);
    EXPECT_LT(3 * size_t{triangles}, room);

    std::vector<Vertex> read(size_t{3} * triangles);
    vertices.read(std::span(read));
    std::vector<SoftTriangle> out(triangles);
    for (size_t i = 0; i < read.size(); ++i) {
        const Vertex& v = read[i];
        out[i / 3].positions[i % 3] = {v.position[0], v.position[1], v.position[2]};
        out[i / 3].texels[i % 3] = {double{v.map_at[0]} * data.map_width - 0.5,
                                    double{v.map_at[1]} * data.map_height - 0.5};
    }
    return out;
}

}  // namespace gim::test
