# SPDX-License-Identifier: Apache-2.0
# hone::plugin: the headers that a plug-in is written with.
include(${CMAKE_CURRENT_LIST_DIR}/hone-targets.cmake)
