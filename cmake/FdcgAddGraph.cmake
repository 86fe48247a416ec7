# SPDX-License-Identifier: Apache-2.0
# fdcg_add_graph(TARGET MESH file [NAME name] [OUTPUT file] [PRECISION f64|f32] [OPTIONS option...] [EMBED])
#
# Bakes a mesh whenever TARGET is built and the mesh, a file that it refers to, or the compiler has changed.
#   MESH       relative to the calling list file's folder
#   NAME       default: the mesh's name without folder and extension
#   OUTPUT     default: NAME.fdcg; relative to the current binary folder
#   PRECISION  default: f64, or f32 where bare metal is built for (CMAKE_SYSTEM_NAME is Generic)
#   OPTIONS    more options of `fdcg compile`: --units mm
#   EMBED      links the file into TARGET as a constant array in read-only memory (flash), aligned to 64 bytes:
#              #include "NAME.h" declares `extern const unsigned char NAME[N]` and NAME_bytes for fdcg_open_memory
# The target's property FDCG_GRAPHS lists the full paths of what is baked for it.
#
# The compiler is FDCG_EXECUTABLE; else the project's own or the package's program where it runs on this host; else `fdcg` on
# the host's path. It is looked for when the function is called, so that the runtime can be used without it.

cmake_policy(VERSION 3.22) # here alone: paths in dependency files (CMP0116), whatever the project asks for
set(FDCG_EXECUTABLE "" CACHE FILEPATH "The offline compiler fdcg, a program of the host; empty: looked for")
set(_fdcg_embed_script "${CMAKE_CURRENT_LIST_DIR}/FdcgEmbed.cmake")

# Sets `command`, and `dependency`: what a baked file is older than when the compiler was built anew.
function(_fdcg_find_compiler command dependency)
  if(FDCG_EXECUTABLE)
    if(NOT EXISTS "${FDCG_EXECUTABLE}")
      message(FATAL_ERROR "fdcg_add_graph: FDCG_EXECUTABLE is '${FDCG_EXECUTABLE}', which does not exist")
    endif()
    set(found "${FDCG_EXECUTABLE}")
  elseif(NOT CMAKE_CROSSCOMPILING AND TARGET fdcg::fdcg)
    set(${command} $<TARGET_FILE:fdcg::fdcg> PARENT_SCOPE)
    set(${dependency} $<TARGET_FILE:fdcg::fdcg> PARENT_SCOPE)
    return()
  else()
    find_program(FDCG_HOST_EXECUTABLE fdcg NO_CMAKE_FIND_ROOT_PATH)
    mark_as_advanced(FDCG_HOST_EXECUTABLE)
    if(NOT FDCG_HOST_EXECUTABLE)
      message(FATAL_ERROR "fdcg_add_graph: there is no compiler. Install fdcg for this host and put it on the path, "
                          "or set FDCG_EXECUTABLE to the program")
    endif()
    set(found "${FDCG_HOST_EXECUTABLE}")
  endif()
  set(${command} "${found}" PARENT_SCOPE)
  set(${dependency} "${found}" PARENT_SCOPE)
endfunction()

# Adds the array made of `file` to the target's sources.
function(_fdcg_embed target name file)
  if(NOT name MATCHES "^[A-Za-z_][A-Za-z0-9_]*$")
    message(FATAL_ERROR "fdcg_add_graph: '${name}' is not a name in C; give NAME")
  endif()
  get_property(languages GLOBAL PROPERTY ENABLED_LANGUAGES)
  set(extension c)
  if(NOT "C" IN_LIST languages)
    set(extension cpp)
  endif()
  set(folder "${CMAKE_CURRENT_BINARY_DIR}/fdcg_${target}")
  set(source "${folder}/${name}.${extension}")
  add_custom_command(OUTPUT "${source}" "${folder}/${name}.h"
    COMMAND "${CMAKE_COMMAND}" "-DINPUT=${file}" "-DOUTPUT=${source}" -DSYMBOL=${name} -P "${_fdcg_embed_script}"
    DEPENDS "${file}" "${_fdcg_embed_script}"
    COMMENT "Embedding graph ${name}" VERBATIM)
  target_sources(${target} PRIVATE "${source}" "${folder}/${name}.h")
  target_include_directories(${target} PRIVATE "${folder}")
endfunction()

function(fdcg_add_graph target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "EMBED" "MESH;NAME;OUTPUT;PRECISION" "OPTIONS")
  if(NOT TARGET ${target})
    message(FATAL_ERROR "fdcg_add_graph: there is no target '${target}'")
  endif()
  get_target_property(folder ${target} SOURCE_DIR)
  if(NOT folder STREQUAL CMAKE_CURRENT_SOURCE_DIR)
    message(FATAL_ERROR "fdcg_add_graph: call it in ${folder}, where target '${target}' is made")
  endif()
  if(arg_UNPARSED_ARGUMENTS OR arg_KEYWORDS_MISSING_VALUES OR NOT arg_MESH)
    message(FATAL_ERROR "fdcg_add_graph(${target} MESH file [NAME name] [OUTPUT file] [PRECISION f64|f32] [OPTIONS option...] "
                        "[EMBED]): cannot use '${arg_UNPARSED_ARGUMENTS}${arg_KEYWORDS_MISSING_VALUES}'")
  endif()
  get_filename_component(mesh "${arg_MESH}" ABSOLUTE)
  if(NOT EXISTS "${mesh}")
    get_source_file_property(is_made "${mesh}" GENERATED) # by another rule of the project
    if(NOT is_made)
      message(FATAL_ERROR "fdcg_add_graph: there is no mesh '${mesh}'")
    endif()
  endif()
  if(NOT arg_NAME)
    get_filename_component(arg_NAME "${mesh}" NAME_WE)
  endif()
  if(NOT arg_OUTPUT)
    set(arg_OUTPUT "${arg_NAME}.fdcg")
  endif()
  get_filename_component(output "${arg_OUTPUT}" ABSOLUTE BASE_DIR "${CMAKE_CURRENT_BINARY_DIR}")
  if(NOT arg_PRECISION)
    set(arg_PRECISION f64)
    if(CMAKE_SYSTEM_NAME STREQUAL "Generic")
      set(arg_PRECISION f32)
    endif()
  endif()

  _fdcg_find_compiler(compiler dependency)
  get_filename_component(folder "${output}" DIRECTORY)
  file(MAKE_DIRECTORY "${folder}")
  add_custom_command(OUTPUT "${output}"
    COMMAND "${compiler}" compile "${mesh}" -o "${output}" --quiet --precision ${arg_PRECISION} --depfile "${output}.d"
            ${arg_OPTIONS}
    DEPENDS "${mesh}" "${dependency}" DEPFILE "${output}.d"
    COMMENT "Baking graph ${arg_NAME}" VERBATIM)
  target_sources(${target} PRIVATE "${output}")
  set_property(TARGET ${target} APPEND PROPERTY FDCG_GRAPHS "${output}")
  if(arg_EMBED)
    _fdcg_embed(${target} ${arg_NAME} "${output}")
  endif()
endfunction()
