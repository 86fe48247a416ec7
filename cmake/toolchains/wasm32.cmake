# SPDX-License-Identifier: Apache-2.0
# WebAssembly by Clang, LLD and WASI's C library (Debian: clang, lld, wasi-libc, libclang-rt-14-dev-wasm32); C++ only needs a
# compiler, no C++ library.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR wasm32)
set(CMAKE_C_COMPILER clang)
set(CMAKE_CXX_COMPILER clang++)
foreach(language C CXX)
  set(CMAKE_${language}_COMPILER_TARGET wasm32-wasi)
  set(CMAKE_${language}_FLAGS_INIT "--sysroot=/usr -isystem /usr/include/wasm32-wasi -ffunction-sections -fdata-sections -Wno-unused-command-line-argument")
  set(CMAKE_${language}_FLAGS_RELEASE_INIT "-O2 -DNDEBUG")
  set(CMAKE_${language}_FLAGS_RELEASE "-O2 -DNDEBUG" CACHE STRING "")
endforeach()
set(CMAKE_CXX_FLAGS_INIT "${CMAKE_CXX_FLAGS_INIT} -nostdinc++")
set(CMAKE_EXE_LINKER_FLAGS_INIT "-Wl,--gc-sections -nostdlib++")
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)

set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER) # fdcg runs on the host
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
