# SPDX-License-Identifier: Apache-2.0
# What `cmake --install` puts where: the program, its graphs, and what plug-ins are built with. The folders that the
# program looks for are those of cli/CMakeLists.txt. The installed tree may be moved.
include(CMakePackageConfigHelpers)

install(TARGETS hone RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY graphs/ DESTINATION ${CMAKE_INSTALL_DATADIR}/hone/graphs FILES_MATCHING PATTERN "*.json")
install(DIRECTORY DESTINATION ${CMAKE_INSTALL_LIBDIR}/hone/plugins) # empty: what is put here is loaded
install(FILES LICENSE README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})

# find_package(hone) gives hone::plugin: the headers that a plug-in needs, and nothing to link. It works with an
# installed tree and with this build tree (-Dhone_DIR=build/release/cmake).
install(FILES core/plugin/hone_plugin.h core/plugin/hone_plugin.hpp
              core/plugin/hone_pass.h core/plugin/hone_pass.hpp core/plugin/hone_pass_run.hpp
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/hone)
install(TARGETS hone_plugin EXPORT hone-targets)
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/hone)
install(EXPORT hone-targets NAMESPACE hone:: DESTINATION ${package})
export(EXPORT hone-targets NAMESPACE hone:: FILE ${PROJECT_BINARY_DIR}/cmake/hone-targets.cmake)
configure_file(cmake/hone-config.cmake ${PROJECT_BINARY_DIR}/cmake/hone-config.cmake COPYONLY)
# Headers alone: any architecture. Before 1.0, a minor version may break what was.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/cmake/hone-config-version.cmake
                                 COMPATIBILITY SameMinorVersion ARCH_INDEPENDENT)
install(FILES ${PROJECT_BINARY_DIR}/cmake/hone-config.cmake ${PROJECT_BINARY_DIR}/cmake/hone-config-version.cmake
        DESTINATION ${package})
