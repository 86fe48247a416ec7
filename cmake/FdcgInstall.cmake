# SPDX-License-Identifier: Apache-2.0
# cmake --install: headers, libraries, the two programs where they are built, a CMake package and a pkg-config file. Components
# of find_package(fdcg): runtime, always; tools (fdcg::fdcg, fdcg::fdcg-servo), bake (fdcg::bake) and device (fdcg::device)
# unless FDCG_RUNTIME_ONLY.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/fdcg)

function(fdcg_install_component name)
  install(TARGETS ${ARGN} EXPORT fdcg-${name}
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
          RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR}
          INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  install(EXPORT fdcg-${name} NAMESPACE fdcg:: DESTINATION ${package_folder})
endfunction()

fdcg_install_component(runtime fdcg_runtime)
install(DIRECTORY runtime/include/fdcg DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
if(NOT FDCG_RUNTIME_ONLY)
  fdcg_install_component(tools fdcg fdcg-servo)
  fdcg_install_component(bake fdcg_bake)
  install(DIRECTORY lib/include/fdcg DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  fdcg_install_component(device fdcg_device)
  # the C++ headers there are for fdcg-servo alone
  install(DIRECTORY runtime/device/include/fdcg DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")
  if(NOT CMAKE_CROSSCOMPILING)
    install(DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/tools/share/man1 DESTINATION ${CMAKE_INSTALL_MANDIR})
    install(DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/tools/share/bash-completion ${CMAKE_CURRENT_BINARY_DIR}/tools/share/zsh
            DESTINATION ${CMAKE_INSTALL_DATAROOTDIR})
  endif()
endif()
install(FILES LICENSE README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs schemas DESTINATION ${CMAKE_INSTALL_DOCDIR})

write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/fdcg-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES cmake/fdcg-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/fdcg-config-version.cmake cmake/FdcgAddGraph.cmake
              cmake/FdcgEmbed.cmake DESTINATION ${package_folder})

# relative to the .pc file, so that the installed tree may be moved
file(RELATIVE_PATH fdcg_pc_to_prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(cmake/fdcg.pc.in ${CMAKE_CURRENT_BINARY_DIR}/fdcg.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/fdcg.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
