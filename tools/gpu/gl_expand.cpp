#include "tools/gpu/gl_expand.h"

#include <algorithm>

namespace gim {
namespace {

constexpr uint32_t kMostGroups = 65535;  // along one axis, on every driver

}  // namespace

Result<GlExpand> GlExpand::create(uint32_t capacity) {
    Result<GlProgram> expand = GlProgram::build({"expand.comp"});
    if (!expand.ok()) return expand.error();
    Result<GlProgram> draw = GlProgram::build({"surface.vert", "surface.frag"});
    if (!draw.ok()) return draw.error();
    GlExpand made(std::move(expand.value()), std::move(draw.value()));
    made.set_capacity(capacity);
    return made;
}

void GlExpand::set_capacity(uint32_t capacity) {
    triangles_.reserve(size_t{16} * capacity);
    capacity_ = capacity;
    const ShaderDraw nothing;
    command_.write(std::span<const ShaderDraw>(&nothing, 1));
}

void GlExpand::expand(GlSurface& surface) {
    const ShaderDraw nothing;
    command_.write(std::span<const ShaderDraw>(&nothing, 1));
    const uint32_t patches = surface.patch_count();
    if (patches == 0) return;
    surface.bind(capacity_);
    triangles_.bind(GL_SHADER_STORAGE_BUFFER, 5);
    command_.bind(GL_SHADER_STORAGE_BUFFER, 6);
    expand_.use();
    const uint32_t rows = (patches - 1) / kMostGroups + 1;
    glDispatchCompute(std::min(patches, kMostGroups), rows, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

void GlExpand::set_triangles(std::span<const std::array<uint32_t, 4>> triangles) {
    const auto count = static_cast<uint32_t>(triangles.size());
    if (count > capacity_) set_capacity(count);
    triangles_.write(triangles);
    ShaderDraw command;
    command.vertex_count = 3 * count;
    command.needed = count;
    command_.write(std::span<const ShaderDraw>(&command, 1));
}

void GlExpand::draw(GlSurface& surface) const {
    surface.bind(capacity_);
    triangles_.bind(GL_SHADER_STORAGE_BUFFER, 5);
    draw_.use();
    glBindVertexArray(no_vertices_.name());
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, command_.name());
    glDrawArraysIndirect(GL_TRIANGLES, nullptr);
}

uint32_t GlExpand::needed() const {
    ShaderDraw command;
    command_.read(std::span<ShaderDraw>(&command, 1));
    return command.needed;
}

std::vector<std::array<uint32_t, 4>> GlExpand::read_triangles() const {
    std::vector<std::array<uint32_t, 4>> triangles(std::min(needed(), capacity_));
    triangles_.read(std::span(triangles));
    return triangles;
}

}  // namespace gim
