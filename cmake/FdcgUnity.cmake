# SPDX-License-Identifier: Apache-2.0
# fdcg_unite_folders(FOLDER): of each target made in FOLDER and below, the C++ sources of one folder are compiled as one unit. Most
# of the time of a small source goes to its headers, and that is spent once then. What it asks of the sources: two of them in one
# folder do not give one name to two things, in anonymous namespaces neither.
function(fdcg_unite_folders folder)
  get_property(below DIRECTORY ${folder} PROPERTY SUBDIRECTORIES)
  foreach(each IN LISTS below)
    fdcg_unite_folders(${each})
  endforeach()
  get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
  foreach(target IN LISTS targets)
    get_target_property(sources ${target} SOURCES)
    list(FILTER sources INCLUDE REGEX "^[^$].*\\.cpp$")
    foreach(source IN LISTS sources)
      cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY ${folder} NORMALIZE)
      cmake_path(RELATIVE_PATH source BASE_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE unit)
      cmake_path(GET unit PARENT_PATH unit)
      string(MAKE_C_IDENTIFIER "${unit}" unit)
      set_source_files_properties(${source} TARGET_DIRECTORY ${target} PROPERTIES UNITY_GROUP ${unit})
    endforeach()
    set_target_properties(${target} PROPERTIES UNITY_BUILD_MODE GROUP)
  endforeach()
endfunction()
