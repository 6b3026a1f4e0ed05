# SPDX-License-Identifier: Apache-2.0
# Compiles kernels (*.glsl.h with a kernel() in it) and shaders (*.vert, *.frag) to SPIR-V and embeds them:
# passes/combine/combine.glsl.h becomes hone::spirv::combine in "hone_spirv/combine.h".

find_program(HONE_GLSLANG glslangValidator REQUIRED)

# hone_kernels(target file...): a *.glsl.h without a kernel() is a library that kernels include, and left out.
function(hone_kernels target)
    set(folder ${PROJECT_BINARY_DIR}/generated/hone_spirv)
    file(MAKE_DIRECTORY ${folder})
    foreach(file ${ARGN})
        cmake_path(ABSOLUTE_PATH file NORMALIZE OUTPUT_VARIABLE path)
        cmake_path(GET path FILENAME filename)
        if(filename MATCHES "^(.*)\\.glsl\\.h$")
            set(name ${CMAKE_MATCH_1})
            file(STRINGS ${path} entry REGEX "^(HONE_FLAT )?void kernel\\(" LIMIT_COUNT 1)
            if(NOT entry)
                continue()
            endif()
            cmake_path(RELATIVE_PATH path BASE_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE HONE_KERNEL)
            set(shader ${folder}/${name}.comp)
            configure_file(${PROJECT_SOURCE_DIR}/cmake/kernel.comp.in ${shader} @ONLY)
        else()
            string(REPLACE "." "_" name ${filename})
            set(shader ${path})
        endif()
        set(header ${folder}/${name}.h)
        add_custom_command(
            OUTPUT ${header}
            COMMAND ${CMAKE_COMMAND} -DGLSLANG=${HONE_GLSLANG} -DSHADER=${shader} -DNAME=${name} -DOUTPUT=${header}
                    -DINCLUDE=${HONE_INCLUDE_DIR} -P ${PROJECT_SOURCE_DIR}/cmake/compile_shader.cmake
            DEPENDS ${shader} ${path} ${PROJECT_SOURCE_DIR}/cmake/compile_shader.cmake
            DEPFILE ${header}.d
            COMMENT "SPIR-V ${name}"
            VERBATIM)
        list(APPEND headers ${header})
    endforeach()
    target_sources(${target} PRIVATE ${headers})
    target_include_directories(${target} PUBLIC ${PROJECT_BINARY_DIR}/generated)
endfunction()
