# SPDX-License-Identifier: Apache-2.0
# Cortex-M4 with its single-precision unit; 64-bit numbers are computed in software.
set(FDCG_CPU cortex-m4 CACHE STRING "GCC's name of the processor")
include(${CMAKE_CURRENT_LIST_DIR}/arm-none-eabi.cmake)
