# SPDX-License-Identifier: Apache-2.0
# An overlay port of the runtime, of the sources that this folder is part of: vcpkg install fdcg --overlay-ports=tools/packaging/vcpkg
get_filename_component(SOURCE_PATH "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)
set(VCPKG_POLICY_DLLS_IN_STATIC_LIBRARY enabled) # fdcg::runtime is static and fdcg::shared shared, whatever the triplet says
vcpkg_cmake_configure(SOURCE_PATH "${SOURCE_PATH}" OPTIONS -DFDCG_RUNTIME_ONLY=ON -DFDCG_BUILD_TESTS=OFF -DFDCG_INSTALL=ON
                      -DFDCG_WERROR=OFF)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH lib/cmake/fdcg)
vcpkg_fixup_pkgconfig()
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include" "${CURRENT_PACKAGES_DIR}/debug/share")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
