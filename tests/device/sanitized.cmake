# SPDX-License-Identifier: Apache-2.0
# The tests of faults, of the host and of its threads on a runtime and a device host that are built with a sanitizer: all sources once more for each.
function(fdcg_device_sanitized name flags)
  set(sources)
  foreach(library fdcg_runtime fdcg_json fdcg_device)
    get_target_property(folder ${library} SOURCE_DIR)
    get_target_property(files ${library} SOURCES)
    list(FILTER files EXCLUDE REGEX TARGET_OBJECTS) # fdcg_json's as they are built for the library
    foreach(file ${files})
      cmake_path(ABSOLUTE_PATH file BASE_DIRECTORY ${folder})
      list(APPEND sources ${file})
    endforeach()
  endforeach()
  add_executable(fdcg_test_device_faults_${name} host/device_c11.c host/faults_test.cpp host/host_test.cpp host/hung_thread_test.cpp host/loop_test.cpp
                 host/servo_work_test.cpp host/snapshot_test.cpp host/thread_calls.cpp ../support/catch_main.cpp ${sources})
  add_dependencies(fdcg_test_device_faults_${name} fdcg_device) # the built-in profiles
  target_include_directories(fdcg_test_device_faults_${name} PRIVATE
    ${PROJECT_SOURCE_DIR}/runtime/include ${PROJECT_SOURCE_DIR}/runtime/src ${PROJECT_SOURCE_DIR}/runtime/device/include
    ${PROJECT_SOURCE_DIR}/runtime/device/src ${PROJECT_SOURCE_DIR}/runtime/device/firmware ${PROJECT_SOURCE_DIR}/lib/include
    ${PROJECT_SOURCE_DIR}/runtime support ../support)
  get_target_property(definitions fdcg_runtime COMPILE_DEFINITIONS)
  target_compile_definitions(fdcg_test_device_faults_${name} PRIVATE ${definitions}
                             FDCG_CUBE="${PROJECT_SOURCE_DIR}/testdata/scenes/cube.fdcg")
  target_compile_options(fdcg_test_device_faults_${name} PRIVATE -O1 -g1 -ffp-contract=off ${flags})
  target_link_options(fdcg_test_device_faults_${name} PRIVATE ${flags})
  target_link_libraries(fdcg_test_device_faults_${name} PRIVATE fdcg_bake fdcg_test_meshes Catch2::Catch2 nlohmann_json::nlohmann_json Threads::Threads
                        ${CMAKE_DL_LIBS})
  catch_discover_tests(fdcg_test_device_faults_${name} TEST_PREFIX "device_faults_${name}: " DISCOVERY_MODE PRE_TEST
                       PROPERTIES TIMEOUT 300 LABELS nightly)
endfunction()
fdcg_device_sanitized(tsan -fsanitize=thread)
fdcg_device_sanitized(asan "-fsanitize=address,undefined;-fno-sanitize-recover=all")
