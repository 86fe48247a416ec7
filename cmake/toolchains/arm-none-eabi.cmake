# SPDX-License-Identifier: Apache-2.0
# Cortex-M with GCC and newlib's headers (Debian: gcc-arm-none-eabi, libnewlib-arm-none-eabi); C++ only needs a compiler, no
# libstdc++. FDCG_CPU names the processor: use cortex-m4f.cmake or cortex-m7.cmake, or set it.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR arm)
set(FDCG_CPU cortex-m7 CACHE STRING "GCC's name of the processor")
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES FDCG_CPU)

set(CMAKE_C_COMPILER arm-none-eabi-gcc)
set(CMAKE_CXX_COMPILER arm-none-eabi-g++)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY) # a program would need a linker script
foreach(language C CXX)
  set(CMAKE_${language}_FLAGS_INIT "-mcpu=${FDCG_CPU} -mthumb -mfloat-abi=hard -ffunction-sections -fdata-sections")
  set(CMAKE_${language}_FLAGS_RELEASE_INIT "-Os -DNDEBUG")
  set(CMAKE_${language}_FLAGS_RELEASE "-Os -DNDEBUG" CACHE STRING "")
endforeach()
set(CMAKE_EXE_LINKER_FLAGS_INIT "-Wl,--gc-sections")

set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER) # fdcg runs on the host
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
