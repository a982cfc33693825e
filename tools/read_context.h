// What the readers of all formats share.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tools/memory_budget.h"
#include "tools/textures.h"

namespace gim {

struct ReadContext {
    std::string folder;                      // of the mesh file: where buffers, materials and textures lie
    Textures* textures = nullptr;            // takes the textures until the mesh gets them; null: read only the shape
    MemoryBudget memory{};                   // counts the mesh and what is unpacked for it
    bool shading = false;                    // also read TriangleMesh::shading
    std::vector<std::string> warnings = {};  // what the mesh lost, one line each; the caller names the file

    void warn(std::string text) { warnings.push_back(std::move(text)); }
};

}  // namespace gim
