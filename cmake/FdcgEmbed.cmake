# SPDX-License-Identifier: Apache-2.0
# cmake -DINPUT=cube.fdcg -DOUTPUT=cube.c -DSYMBOL=cube -P FdcgEmbed.cmake
# Writes a file's bytes as a constant array that starts at a multiple of 64, which compiles as C11 and as C++, and the header
# SYMBOL.h beside it: `extern const unsigned char SYMBOL[]` and `extern const unsigned long long SYMBOL_bytes`.
cmake_minimum_required(VERSION 3.22)
foreach(name INPUT OUTPUT SYMBOL)
  if(NOT DEFINED ${name})
    message(FATAL_ERROR "FdcgEmbed.cmake: -D${name}=... is missing")
  endif()
endforeach()
if(NOT SYMBOL MATCHES "^[A-Za-z_][A-Za-z0-9_]*$")
  message(FATAL_ERROR "FdcgEmbed.cmake: '${SYMBOL}' is not a name in C")
endif()

file(READ "${INPUT}" hex HEX)
string(LENGTH "${hex}" digits)
if(digits EQUAL 0)
  message(FATAL_ERROR "FdcgEmbed.cmake: ${INPUT} is empty")
endif()
math(EXPR bytes "${digits} / 2")
string(REGEX REPLACE "(................................................................)" "\\1\n" hex "${hex}") # 32 bytes a line
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," hex "${hex}")

set(guard "FDCG_EMBEDDED_${SYMBOL}_H")
get_filename_component(folder "${OUTPUT}" DIRECTORY)
file(CONFIGURE OUTPUT "${folder}/${SYMBOL}.h" @ONLY CONTENT
"/* Made by fdcg_add_graph. */
#ifndef @guard@
#define @guard@
#ifdef __cplusplus
extern \"C\" {
#endif
extern const unsigned char @SYMBOL@[@bytes@]; /* an FDCG file, for fdcg_open_memory */
extern const unsigned long long @SYMBOL@_bytes;
#ifdef __cplusplus
}
#endif
#endif
")
file(WRITE "${OUTPUT}"
"/* Made by fdcg_add_graph. */
#include \"${SYMBOL}.h\"
#ifdef __cplusplus
alignas(64)
#else
_Alignas(64)
#endif
const unsigned char ${SYMBOL}[${bytes}] = {
${hex}
};
const unsigned long long ${SYMBOL}_bytes = ${bytes};
")
