# SPDX-License-Identifier: Apache-2.0
# cmake --install [--component NAME]: headers, libraries, the two programs where they are built, a CMake package and pkg-config
# files. Components, of the installation and of find_package(fdcg): the runtime's parts, step, query, effect, scene, surface, deform
# and body; runtime, which is all of them in one library; shared, the same as a shared library; and, unless FDCG_RUNTIME_ONLY, tools (fdcg::fdcg, fdcg::fdcg-servo), bake
# (fdcg::bake), bake_c (fdcg::bake_c) and device (fdcg::device). One that is installed alone brings those that it needs.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/fdcg)
# relative to the .pc file, so that the installed tree may be moved
file(RELATIVE_PATH fdcg_pc_to_prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)

add_custom_target(fdcg_installed) # builds what cmake --install takes

# fdcg_install_component(NAME TARGETS target... [NEEDS component...] [HEADERS folder PATTERN glob])
function(fdcg_install_component name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "HEADERS;PATTERN" "TARGETS;NEEDS")
  install(TARGETS ${arg_TARGETS} EXPORT fdcg-${name}
          LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${name}
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${name}
          RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT ${name}
          INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  add_dependencies(fdcg_installed ${arg_TARGETS})
  install(EXPORT fdcg-${name} NAMESPACE fdcg:: DESTINATION ${package_folder} COMPONENT ${name})
  if(arg_HEADERS)
    # C++ headers beside the device host's C header are for fdcg-servo alone.
    install(DIRECTORY ${arg_HEADERS}/fdcg DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT ${name} FILES_MATCHING
            PATTERN ${arg_PATTERN})
  endif()
  foreach(needed IN LISTS arg_NEEDS)
    install(CODE "
      execute_process(COMMAND \"${CMAKE_COMMAND}\" --install \"${PROJECT_BINARY_DIR}\" --component ${needed}
                      --prefix \"\${CMAKE_INSTALL_PREFIX}\" --config \"\${CMAKE_INSTALL_CONFIG_NAME}\"
                      COMMAND_ERROR_IS_FATAL ANY)" COMPONENT ${name} EXCLUDE_FROM_ALL)
  endforeach()
endfunction()

# fdcg_install_pc(NAME LIBRARY COMPONENT [REQUIRED NAME])
function(fdcg_install_pc fdcg_pc_name fdcg_pc_library component)
  set(fdcg_pc_requires ${ARGN})
  configure_file(cmake/fdcg.pc.in ${CMAKE_CURRENT_BINARY_DIR}/${fdcg_pc_name}.pc @ONLY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/${fdcg_pc_name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT ${component})
endfunction()

# package: what every component needs
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/fdcg-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES cmake/fdcg-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/fdcg-config-version.cmake cmake/FdcgAddGraph.cmake
              cmake/FdcgEmbed.cmake DESTINATION ${package_folder} COMPONENT package)
install(FILES LICENSE README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT package)
install(DIRECTORY docs schemas DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT package)
install(DIRECTORY runtime/include/fdcg DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT package)

fdcg_install_component(runtime TARGETS fdcg_runtime NEEDS package)
fdcg_install_pc(fdcg fdcg_runtime runtime)
if(TARGET fdcg_runtime_shared)
  fdcg_install_component(shared TARGETS fdcg_runtime_shared NEEDS package)
  fdcg_install_pc(fdcg-shared fdcg shared)
endif()
fdcg_install_component(step TARGETS fdcg_step NEEDS package)
fdcg_install_pc(fdcg-step fdcg_step step)
fdcg_install_component(query TARGETS fdcg_query NEEDS step)
fdcg_install_pc(fdcg-query fdcg_query query fdcg-step)
fdcg_install_component(effect TARGETS fdcg_effect NEEDS query)
fdcg_install_pc(fdcg-effect fdcg_effect effect fdcg-query)
fdcg_install_component(scene TARGETS fdcg_scene NEEDS query)
fdcg_install_pc(fdcg-scene fdcg_scene scene fdcg-query)
foreach(part surface deform body)
  fdcg_install_component(${part} TARGETS fdcg_${part} NEEDS scene)
  fdcg_install_pc(fdcg-${part} fdcg_${part} ${part} fdcg-scene)
endforeach()
if(NOT FDCG_RUNTIME_ONLY)
  fdcg_install_component(tools TARGETS fdcg fdcg-servo NEEDS package)
  if(NOT CMAKE_CROSSCOMPILING) # made by the programs themselves
    install(DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/tools/share/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT tools)
    install(DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/tools/share/bash-completion ${CMAKE_CURRENT_BINARY_DIR}/tools/share/zsh
            DESTINATION ${CMAKE_INSTALL_DATAROOTDIR} COMPONENT tools)
  endif()
  fdcg_install_component(bake TARGETS fdcg_bake NEEDS runtime HEADERS lib/include PATTERN *.hpp)
  fdcg_install_component(bake_c TARGETS fdcg_bake_c NEEDS package HEADERS lib/include PATTERN bake.h)
  fdcg_install_pc(fdcg-bake-c fdcg_bake_c bake_c)
  fdcg_install_component(device TARGETS fdcg_device NEEDS runtime HEADERS runtime/device/include PATTERN *.h)
endif()

# cpack (tools/package archive): all of it in one folder of an archive, for any place.
if(PROJECT_IS_TOP_LEVEL)
  set(CPACK_GENERATOR TGZ)
  if(CMAKE_SYSTEM_NAME STREQUAL "Windows")
    set(CPACK_GENERATOR ZIP)
  endif()
  string(TOLOWER "${CMAKE_SYSTEM_NAME}" system)
  set(CPACK_PACKAGE_FILE_NAME fdcg-${PROJECT_VERSION}-${system}-${CMAKE_SYSTEM_PROCESSOR})
  set(CPACK_STRIP_FILES ON)
  set(CPACK_VERBATIM_VARIABLES ON)
  include(CPack)
endif()
