# SPDX-License-Identifier: Apache-2.0
# What every target of hone has in common: the language, warnings, exact arithmetic, rooted includes.

# Includes are rooted ("hone/core/..."), whatever the checkout's folder is called.
set(HONE_INCLUDE_DIR ${PROJECT_BINARY_DIR}/include)
file(MAKE_DIRECTORY ${HONE_INCLUDE_DIR})
file(CREATE_LINK ${PROJECT_SOURCE_DIR} ${HONE_INCLUDE_DIR}/hone SYMBOLIC)

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(NOT CMAKE_BUILD_TYPE)
    set(CMAKE_BUILD_TYPE Release)
endif()
# Loops over pixels and rays are worth -O3 (passes and backends ask for it); the rest builds faster without.
set(CMAKE_CXX_FLAGS_RELEASE "-O2 -DNDEBUG")
find_program(HONE_CCACHE ccache)
if(HONE_CCACHE)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${HONE_CCACHE})
endif()

add_library(hone_settings INTERFACE)
target_include_directories(hone_settings INTERFACE ${HONE_INCLUDE_DIR})
# The same bits on every path through the code: no contraction into fused multiply-add, no fast-math. Nobody reads errno
# or floating-point traps, which keep square roots and selections from being vectorised; values stay as they are.
target_compile_options(hone_settings INTERFACE -ffp-contract=off -fno-math-errno -fno-trapping-math)
# -Wrestrict: GCC 12 sees overlaps in std::string's own code (its bug 105651).
set(is_gcc $<CXX_COMPILER_ID:GNU>)
target_compile_options(hone_settings INTERFACE -Wall -Wextra $<${is_gcc}:-Wshadow=local> -Wconversion -Wpedantic
                                               $<${is_gcc}:-Wno-restrict>)
if(HONE_ARCH)
    target_compile_options(hone_settings INTERFACE -march=${HONE_ARCH})
endif()
if(HONE_WERROR)
    target_compile_options(hone_settings INTERFACE -Werror)
endif()
if(HONE_SANITIZE)
    # GCC 12 takes the checks it adds itself for uses of uninitialised values.
    target_compile_options(hone_settings INTERFACE -Wno-maybe-uninitialized)
    # vptr asks for type information, which Debian's glslang is built without.
    target_compile_options(hone_settings INTERFACE -fsanitize=address,undefined -fno-sanitize=vptr
                           -fno-sanitize-recover=undefined)
    target_link_options(hone_settings INTERFACE -fsanitize=address,undefined)
endif()

# hone_library(core LINK glm::glm ... PRIVATE_LINK ...): a static library of the folder's .cpp files, hone::core.
function(hone_library name)
    cmake_parse_arguments(ARG "" "" "LINK;PRIVATE_LINK" ${ARGN})
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
    add_library(hone_${name} STATIC ${sources})
    add_library(hone::${name} ALIAS hone_${name})
    target_link_libraries(hone_${name} PUBLIC hone_settings ${ARG_LINK} PRIVATE ${ARG_PRIVATE_LINK})
    set_target_properties(hone_${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
endfunction()
