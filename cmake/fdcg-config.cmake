# SPDX-License-Identifier: Apache-2.0
# find_package(fdcg [COMPONENTS step query scene surface deform body runtime shared tools bake device]): the runtime's libraries that are
# installed, fdcg::step ... fdcg::body, and fdcg::runtime and fdcg::shared, which are all of them; fdcg_add_graph; the programs fdcg::fdcg and
# fdcg::fdcg-servo where they are installed; fdcg::bake and fdcg::device on request, since they look for what they link. A
# component that is asked for and not installed is an error.
include(CMakeFindDependencyMacro)
set(${CMAKE_FIND_PACKAGE_NAME}_FOUND TRUE)
set(fdcg_wanted ${${CMAKE_FIND_PACKAGE_NAME}_FIND_COMPONENTS})
set(fdcg_libraries step query scene surface deform body runtime shared) # each after what it links

foreach(component IN LISTS fdcg_wanted)
  if(component IN_LIST fdcg_libraries OR component MATCHES "^(tools|bake|device)$")
    if(EXISTS "${CMAKE_CURRENT_LIST_DIR}/fdcg-${component}.cmake")
      set(${CMAKE_FIND_PACKAGE_NAME}_${component}_FOUND TRUE)
      continue()
    endif()
  endif()
  if(${CMAKE_FIND_PACKAGE_NAME}_FIND_REQUIRED_${component})
    set(${CMAKE_FIND_PACKAGE_NAME}_FOUND FALSE)
    set(${CMAKE_FIND_PACKAGE_NAME}_NOT_FOUND_MESSAGE
        "this installation of fdcg has no component '${component}' (built with FDCG_RUNTIME_ONLY, or installed in part?)")
    return()
  endif()
endforeach()

foreach(library IN LISTS fdcg_libraries)
  if(EXISTS "${CMAKE_CURRENT_LIST_DIR}/fdcg-${library}.cmake")
    include("${CMAKE_CURRENT_LIST_DIR}/fdcg-${library}.cmake")
    # It needs nothing of C++ but the compiler: programs in C link it as C.
    get_target_property(fdcg_configurations fdcg::${library} IMPORTED_CONFIGURATIONS)
    foreach(configuration IN LISTS fdcg_configurations)
      set_target_properties(fdcg::${library} PROPERTIES IMPORTED_LINK_INTERFACE_LANGUAGES_${configuration} C)
    endforeach()
  endif()
endforeach()
if(EXISTS "${CMAKE_CURRENT_LIST_DIR}/fdcg-tools.cmake" AND NOT CMAKE_CROSSCOMPILING)
  include("${CMAKE_CURRENT_LIST_DIR}/fdcg-tools.cmake")
endif()
if("bake" IN_LIST fdcg_wanted)
  find_dependency(Threads)
  find_dependency(OpenSSL COMPONENTS Crypto)
  find_dependency(draco)
  find_dependency(meshoptimizer)
  find_dependency(pugixml)
  find_dependency(OpenMesh CONFIG)
  include("${CMAKE_CURRENT_LIST_DIR}/fdcg-bake.cmake")
endif()
if("device" IN_LIST fdcg_wanted)
  find_dependency(Threads)
  include("${CMAKE_CURRENT_LIST_DIR}/fdcg-device.cmake")
endif()
include("${CMAKE_CURRENT_LIST_DIR}/FdcgAddGraph.cmake")
