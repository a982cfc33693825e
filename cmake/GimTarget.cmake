# Settings that every target of the project shares.
#
# -ffp-contract=off everywhere: decoded samples must be the same bits on every machine, and the encoder measures its own
# output with the decoder's arithmetic (spec/gim-format.md, "Arithmetic").
function(gim_target target)
    target_compile_features(${target} PUBLIC cxx_std_20)
    target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR})
    target_compile_options(${target} PRIVATE
        $<$<CXX_COMPILER_ID:GNU,Clang,AppleClang>:-Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -ffp-contract=off>)
    # GCC 12 warns of overlaps and overflows in inlined std::string and std::vector that do not exist (GCC bug 105651).
    target_compile_options(${target} PRIVATE
        $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-restrict;-Wno-stringop-overflow>)
    if(GIM_BUILD_FUZZERS)
        target_compile_options(${target} PRIVATE -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all)
    endif()
    if(GIM_WARNINGS_AS_ERRORS)
        target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU,Clang,AppleClang>:-Werror>)
    endif()
endfunction()

# Objects of this target may end up in a shared library, which must not export them.
function(gim_hide_symbols target)
    set_target_properties(${target} PROPERTIES CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
endfunction()

# Compiles these headers once for all files of the target. Each file still includes what it needs;
# -DGIM_PRECOMPILE_HEADERS=OFF tells if one does not.
function(gim_precompile target)
    if(GIM_PRECOMPILE_HEADERS)
        target_precompile_headers(${target} PRIVATE ${ARGN})
        # Headers that are precompiled lose what makes them the system's, and GCC 12 warns of std::string in them.
        target_compile_options(${target} PRIVATE
            $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-array-bounds>)
    endif()
endfunction()
