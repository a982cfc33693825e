// write_buffers FOLDER: what tests/gpu/browser draws, decoded and patched by the library, with the frames that should come
// out. Each case is a folder: one file for each buffer, by the names of decoder/shaders/README.md, and case.json.
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>

#include "tests/gpu/compare_frames.h"
#include "tests/gpu/views.h"
#include "tools/gpu/split_patches.h"

namespace gim {
namespace {

using namespace gim::test;

constexpr uint32_t kSide = 256;  // of a frame
constexpr int kViews = 2;        // of each model at each number of levels

template <class T>
void write(const std::filesystem::path& path, std::span<const T> values) {
    std::ofstream file(path, std::ios::binary);
    file.write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(values.size_bytes()));
}

void write_case(const std::filesystem::path& folder, Model& model, const std::vector<gim_patch>& patches,
                uint32_t extra, Random& random) {
    std::filesystem::create_directories(folder);
    const SurfaceStore store = join_surfaces(std::vector<SurfaceData>{model.surface});
    InstancedPatches list;
    add_patches(patches, 0, 16, 0, &list);
    const std::vector<SampleTriangle> triangles = expand_patches(patches, model.surface, extra);
    ShaderInstance instance;
    instance.extra = extra;
    ShaderView view = lit_view(random_camera(model.centre, model.radius, random));
    view.patch_count = static_cast<uint32_t>(list.patches.size());
    view.capacity = static_cast<uint32_t>(triangles.size());

    SoftwareFrame frame(kSide, kSide, kFiner, kBackground, kSwiftShaderParts);
    frame.draw(placed(triangles, model.surface), model.surface, instance, view);
    const std::vector<uint8_t> contested = frame.contested();

    write(folder / "view", std::span<const ShaderView>(&view, 1));
    write(folder / "patches", std::span<const gim_patch>(list.patches));
    write(folder / "patch_instances", std::span<const uint32_t>(list.instances));
    write(folder / "instances", std::span<const ShaderInstance>(&instance, 1));
    write(folder / "domains", std::span<const ShaderDomain>(store.domains));
    write(folder / "positions", std::span<const float>(store.positions));
    write(folder / "normal_map", std::span<const int8_t>(store.normals));
    write(folder / "samples", std::span<const uint8_t>(frame.pixels().rgba));
    write(folder / "contested", std::span<const uint8_t>(contested));
    std::ofstream(folder / "case.json") << "{\"side\": " << kSide << ", \"finer\": " << kFiner
                                        << ", \"map_width\": " << store.map_width
                                        << ", \"map_height\": " << store.map_height
                                        << ", \"patches\": " << list.patches.size()
                                        << ", \"triangles\": " << triangles.size() << "}\n";
}

void write_all(const std::filesystem::path& folder) {
    Random random(41);
    for (const char* name : kModels) {
        Model model(name);
        for (int i = 0; i < kViews; ++i) {
            for (const uint32_t levels : {1u, 2u, 4u}) {
                const auto patches = model.banded_patches(model.depth() + 1 - levels, levels, random);
                const std::string title =
                    std::string(name) + "-" + std::to_string(levels) + "-levels-" + std::to_string(i);
                write_case(folder / title, model, patches, 0, random);
                if (levels == 4) write_case(folder / (title + "-finer"), model, patches, 1, random);
            }
        }
    }
}

}  // namespace
}  // namespace gim

int main(int argc, char** argv) {
    if (argc != 2) {
        std::cerr << "usage: write_buffers FOLDER\n";
        return 2;
    }
    gim::write_all(argv[1]);
    return ::testing::Test::HasFailure() ? 1 : 0;
}
