# SPDX-License-Identifier: Apache-2.0
# The profiles of this folder as constant arrays in the library, in alphabetical order: builtin_profiles() of profile_json.hpp.
set(fdcg_profiles fdcg-reference ffbeast-wheel openffboard teensy-rawhid woodenhaptics)

set(fdcg_profile_folder ${CMAKE_CURRENT_BINARY_DIR}/profiles)
set(fdcg_profile_includes "")
set(fdcg_profile_rows "")
foreach(profile IN LISTS fdcg_profiles)
  string(MAKE_C_IDENTIFIER "fdcg_profile_${profile}" symbol)
  add_custom_command(
    OUTPUT ${fdcg_profile_folder}/${symbol}.c
    BYPRODUCTS ${fdcg_profile_folder}/${symbol}.h
    COMMAND ${CMAKE_COMMAND} -DINPUT=${CMAKE_CURRENT_LIST_DIR}/${profile}.json
            -DOUTPUT=${fdcg_profile_folder}/${symbol}.c -DSYMBOL=${symbol} -P ${CMAKE_CURRENT_LIST_DIR}/../../../cmake/FdcgEmbed.cmake
    DEPENDS ${CMAKE_CURRENT_LIST_DIR}/${profile}.json ${CMAKE_CURRENT_LIST_DIR}/../../../cmake/FdcgEmbed.cmake
    COMMENT "Embedding ${profile}.json" VERBATIM)
  target_sources(fdcg_device PRIVATE ${fdcg_profile_folder}/${symbol}.c)
  string(APPEND fdcg_profile_includes "#include \"${symbol}.h\"\n")
  string(APPEND fdcg_profile_rows "    {\"${profile}\", text_of(${symbol})},\n")
endforeach()
configure_file(${CMAKE_CURRENT_LIST_DIR}/builtin_profiles.cpp.in ${fdcg_profile_folder}/builtin_profiles.cpp @ONLY)
target_sources(fdcg_device PRIVATE ${fdcg_profile_folder}/builtin_profiles.cpp)
target_include_directories(fdcg_device PRIVATE ${fdcg_profile_folder})
