# The mesh readers as a library of their own, without encoder and command line, so that the fuzz targets can link it.
find_path(GIM_STB_INCLUDE_DIR stb_image_write.h PATH_SUFFIXES stb REQUIRED)
find_package(Eigen3 3.4 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(draco CONFIG REQUIRED)
find_package(meshoptimizer CONFIG REQUIRED)

set(folder ${CMAKE_CURRENT_LIST_DIR})
add_library(gim_readers STATIC
    ${folder}/file.cpp
    ${folder}/foreign_format.cpp
    ${folder}/gltf_accessor.cpp
    ${folder}/gltf_draco.cpp
    ${folder}/gltf_extensions.cpp
    ${folder}/gltf_file.cpp
    ${folder}/gltf_json.cpp
    ${folder}/gltf_material.cpp
    ${folder}/gltf_meshopt.cpp
    ${folder}/gltf_primitive.cpp
    ${folder}/gltf_scene.cpp
    ${folder}/gltf_skin.cpp
    ${folder}/gltf_uri.cpp
    ${folder}/picture_kind.cpp
    ${folder}/memory_budget.cpp
    ${folder}/mesh_read.cpp
    ${folder}/named_file.cpp
    ${folder}/ply_body.cpp
    ${folder}/ply_header.cpp
    ${folder}/polygons.cpp
    ${folder}/read_gltf.cpp
    ${folder}/read_mtl.cpp
    ${folder}/read_obj.cpp
    ${folder}/read_off.cpp
    ${folder}/read_ply.cpp
    ${folder}/read_stl.cpp
    ${folder}/smoothing_groups.cpp
    ${folder}/stb.cpp
    ${folder}/text_scanner.cpp
    ${folder}/textures.cpp
)
gim_target(gim_readers)
target_include_directories(gim_readers PUBLIC ${PROJECT_SOURCE_DIR}/encoder/include)
target_include_directories(gim_readers SYSTEM PRIVATE ${GIM_STB_INCLUDE_DIR})
target_link_libraries(gim_readers
    PUBLIC nlohmann_json::nlohmann_json
    PRIVATE Eigen3::Eigen draco::draco meshoptimizer::meshoptimizer)
