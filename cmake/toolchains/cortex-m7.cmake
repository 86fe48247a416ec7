# SPDX-License-Identifier: Apache-2.0
# Cortex-M7 with its double-precision unit (cortex-m7+nofp.dp: with the single-precision one).
set(FDCG_CPU cortex-m7 CACHE STRING "GCC's name of the processor")
include(${CMAKE_CURRENT_LIST_DIR}/arm-none-eabi.cmake)
