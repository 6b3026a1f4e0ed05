# SPDX-License-Identifier: Apache-2.0
# Script: compiles SHADER with GLSLANG and wraps the words into namespace hone::spirv as NAME, in OUTPUT.
execute_process(
    COMMAND ${GLSLANG} -V --target-env vulkan1.3 --auto-map-bindings -I${INCLUDE} --vn ${NAME} --depfile ${OUTPUT}.raw.d
            -o ${OUTPUT}.raw ${SHADER}
    RESULT_VARIABLE result OUTPUT_VARIABLE log ERROR_VARIABLE log)
if(NOT result EQUAL 0 OR log MATCHES "WARNING|ERROR")
    message(FATAL_ERROR "${log}")
endif()
file(READ ${OUTPUT}.raw words)
string(REPLACE "const uint32_t" "inline constexpr std::uint32_t" words "${words}")
string(REGEX REPLACE "#pragma once" "" words "${words}")
file(WRITE ${OUTPUT} "#pragma once\n#include <cstdint>\nnamespace hone::spirv {\n${words}}\n")
file(READ ${OUTPUT}.raw.d depfile)
string(REPLACE "${OUTPUT}.raw" "${OUTPUT}" depfile "${depfile}")
file(WRITE ${OUTPUT}.d "${depfile}")
file(REMOVE ${OUTPUT}.raw ${OUTPUT}.raw.d)
