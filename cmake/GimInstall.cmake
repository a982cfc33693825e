# Install rules, the exported package (find_package(gim)) and gim-decoder.pc.
#
# Components. `decoder` depends only on what libgim-decoder links itself. `python` is gim.py. `encoder` and the program,
# `tools`, are installed only if they are built. `cmake --install build --component decoder` installs what an engine embeds and nothing else.
option(GIM_INSTALL "Install rules for gim" ${PROJECT_IS_TOP_LEVEL})
if(NOT GIM_INSTALL)
    return()
endif()
include(CMakePackageConfigHelpers)
set(gim_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/gim)

# Users of the decoder need zstd if its archive links zstd.
get_target_property(gim_decoder_links gim_decoder LINK_LIBRARIES)
if(gim_decoder_links MATCHES "zstd")
    set(gim_decoder_needs_zstd ON)
    set(gim_pc_requires_private libzstd)
else()
    set(gim_decoder_needs_zstd OFF)
    set(gim_pc_requires_private "")
endif()

# ---- decoder ---------------------------------------------------------------------------------------------------------

install(TARGETS gim_format gim_decoder EXPORT gim_decoder_targets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT decoder)
if(TARGET gim_decoder_shared)
    install(TARGETS gim_decoder_shared EXPORT gim_decoder_targets
            LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT decoder)
endif()
set(gim_decoder_headers ${PROJECT_SOURCE_DIR}/decoder/include/gim)
install(FILES ${gim_decoder_headers}/clusters.h ${gim_decoder_headers}/decoder.h
              ${gim_decoder_headers}/decoder.hpp ${gim_decoder_headers}/refine.h
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/gim COMPONENT decoder)
install(EXPORT gim_decoder_targets NAMESPACE gim:: FILE gim-decoder-targets.cmake
        DESTINATION ${gim_package_dir} COMPONENT decoder)

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/gim-config.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/gim-config.cmake
                              INSTALL_DESTINATION ${gim_package_dir} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/gim-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/gim-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/gim-config-version.cmake
        DESTINATION ${gim_package_dir} COMPONENT decoder)

# The archives contain C++, so a C program that links them must link the C++ runtime by name. The shared library brings
# its own.
set(gim_pc_archives "-lgim-format")
foreach(library IN LISTS CMAKE_CXX_IMPLICIT_LINK_LIBRARIES)
    if(library MATCHES "^(stdc\\+\\+|c\\+\\+|m)$")
        string(APPEND gim_pc_archives " -l${library}")
    endif()
endforeach()
if(TARGET gim_decoder_shared)
    set(gim_pc_libs "")
    set(gim_pc_libs_private "${gim_pc_archives}")
else()
    set(gim_pc_libs " ${gim_pc_archives}")
    set(gim_pc_libs_private "")
endif()
file(RELATIVE_PATH gim_pc_prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
string(REGEX REPLACE "/$" "" gim_pc_prefix "${gim_pc_prefix}")
configure_file(${CMAKE_CURRENT_LIST_DIR}/gim-decoder.pc.in ${CMAKE_CURRENT_BINARY_DIR}/gim-decoder.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/gim-decoder.pc
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT decoder)

# ---- Python ----------------------------------------------------------------------------------------------------------

set(GIM_INSTALL_PYTHONDIR lib/python3/dist-packages CACHE STRING "Where gim.py goes, below the prefix")
if(TARGET gim_decoder_shared)
    install(FILES ${PROJECT_SOURCE_DIR}/decoder/bindings/python/gim.py
            DESTINATION ${GIM_INSTALL_PYTHONDIR} COMPONENT python)
endif()

# ---- encoder and program ---------------------------------------------------------------------------------------------

if(TARGET gim_encoder)
    install(TARGETS gim_encoder EXPORT gim_encoder_targets
            ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT encoder)
    install(FILES ${PROJECT_SOURCE_DIR}/encoder/include/gim/encoder.h
            DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/gim COMPONENT encoder)
    install(EXPORT gim_encoder_targets NAMESPACE gim:: FILE gim-encoder-targets.cmake
            DESTINATION ${gim_package_dir} COMPONENT encoder)
endif()
if(TARGET gim)
    get_target_property(gim_is_left_out gim EXCLUDE_FROM_ALL)
    if(NOT gim_is_left_out)
        install(TARGETS gim RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT tools)
        # The page of gim view, if tools/viewer/build.sh has made it.
        install(DIRECTORY ${PROJECT_SOURCE_DIR}/build/viewer/ DESTINATION ${CMAKE_INSTALL_DATADIR}/gim/viewer
                COMPONENT tools OPTIONAL)
    endif()
endif()
