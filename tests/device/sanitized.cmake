# SPDX-License-Identifier: Apache-2.0
# All programs of the device's tests, and fdcg-servo under its contract tests, on a runtime and a device host that are built with a
# sanitizer: all sources once more for each.
set(device_programs profile scene tick transport hid host real_time random)
set(servo_classes_asan servo_run_test:Run servo_run_test:Latency servo_run_test:Replay servo_run_test:Check servo_run_test:Examples
    servo_run_test:Hostile servo_run_test:Devices servo_signals_test:Crashes servo_signals_test:Endings servo_signals_test:Stops
    servo_strikes_test:Hosts servo_strikes_test:Changes servo_strikes_test:Lags servo_faults_test:Restarts servo_faults_test:Losses
    serial_test:Lines serial_test:Faults serial_test:Calibrate serial_test:Refusals plugins_test:Libraries plugins_test:Haply
    dashboard_test:Bridges dashboard_test:Sockets dashboard_test:Recordings dashboard_test:Keys)
# What has threads beside each other; tests that want so many ticks in a time fail under this sanitizer.
set(servo_classes_tsan servo_run_test:Hostile servo_signals_test:Stops servo_strikes_test:Hosts servo_strikes_test:Lags
    serial_test:Faults plugins_test:Libraries plugins_test:Haply dashboard_test:Sockets)
# a crash is the handler's of the host, not the sanitizer's; the host's own memory is what is looked at
set(sanitizer_options handle_segv=0:handle_abort=0:handle_sigbus=0:handle_sigfpe=0:handle_sigill=0:handle_sigtrap=0)

# The sources of these targets, with their folders.
function(fdcg_sources_of result)
  set(sources)
  foreach(target IN LISTS ARGN)
    get_target_property(folder ${target} SOURCE_DIR)
    get_target_property(files ${target} SOURCES)
    list(FILTER files EXCLUDE REGEX TARGET_OBJECTS) # fdcg_json's as they are built for the library
    foreach(file IN LISTS files)
      cmake_path(ABSOLUTE_PATH file BASE_DIRECTORY ${folder})
      list(APPEND sources ${file})
    endforeach()
  endforeach()
  set(${result} ${sources} PARENT_SCOPE)
endfunction()

# fdcg_sanitized_parts(NAME flags): the runtime and the device host, objects.
function(fdcg_sanitized_parts name flags)
  fdcg_sources_of(sources fdcg_runtime fdcg_json fdcg_device)
  set(parts fdcg_device_parts_${name})
  add_library(${parts} OBJECT ${sources})
  add_dependencies(${parts} fdcg_device) # the built-in profiles
  get_target_property(definitions fdcg_runtime COMPILE_DEFINITIONS)
  target_compile_definitions(${parts} PUBLIC ${definitions})
  target_include_directories(${parts} PUBLIC
    ${PROJECT_SOURCE_DIR}/runtime/include ${PROJECT_SOURCE_DIR}/runtime/src ${PROJECT_SOURCE_DIR}/runtime/device/include
    ${PROJECT_SOURCE_DIR}/runtime/device/src ${PROJECT_SOURCE_DIR}/runtime/device/firmware ${PROJECT_SOURCE_DIR}/runtime)
  target_compile_options(${parts} PUBLIC -O1 -g1 -ffp-contract=off ${flags})
  target_link_options(${parts} PUBLIC ${flags})
  target_link_libraries(${parts} PUBLIC nlohmann_json::nlohmann_json Threads::Threads ${CMAKE_DL_LIBS})
endfunction()

# fdcg_sanitized_test(NAME program): fdcg_test_device_PROGRAM once more.
function(fdcg_sanitized_test name program)
  set(plain fdcg_test_device_${program})
  set(target fdcg_test_device_${program}_${name})
  fdcg_sources_of(sources ${plain})
  add_executable(${target} ../support/catch_main.cpp ${sources})
  get_target_property(definitions ${plain} COMPILE_DEFINITIONS)
  target_compile_definitions(${target} PRIVATE ${definitions})
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/lib/include support ../support ../bench)
  target_link_libraries(${target} PRIVATE fdcg_device_parts_${name} fdcg_bake fdcg_test_meshes fdcg_test_walker Catch2::Catch2)
  add_dependencies(${target} ${plain})
  if(program STREQUAL hid)
    set_target_properties(${target} PROPERTIES BUILD_RPATH ${CMAKE_CURRENT_BINARY_DIR}/fake_hidapi)
    target_link_options(${target} PRIVATE -Wl,--disable-new-dtags)
  endif()
  catch_discover_tests(${target} TEST_PREFIX "device_${program}_${name}: " DISCOVERY_MODE PRE_TEST
                       PROPERTIES TIMEOUT 600 LABELS nightly SKIP_REGULAR_EXPRESSION "skipped: "
                       ENVIRONMENT "ASAN_OPTIONS=${sanitizer_options};TSAN_OPTIONS=${sanitizer_options}")
  add_dependencies(fdcg_sanitized ${target})
endfunction()

# fdcg_sanitized_servo(NAME): fdcg-servo once more, and its contract tests.
function(fdcg_sanitized_servo name)
  set(target fdcg_servo_${name})
  fdcg_sources_of(sources fdcg-servo fdcg_dashboard fdcg_tools_common)
  add_executable(${target} ${sources})
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/tools)
  target_compile_definitions(${target} PRIVATE BOOST_ASIO_NO_DEPRECATED BOOST_ALLOW_DEPRECATED_HEADERS)
  target_link_libraries(${target} PRIVATE fdcg_device_parts_${name} CLI11::CLI11)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON OUTPUT_NAME fdcg-servo # as tests read it in messages
                        RUNTIME_OUTPUT_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/${name})
  add_dependencies(${target} fdcg fdcg_test_fake_hid_node fdcg_test_fake_hid_firmware fdcg_test_pty_device fdcg_haply_inverse
                   fdcg_test_force_dimension fdcg_test_novint_falcon)
  add_dependencies(fdcg_sanitized ${target})
  foreach(class IN LISTS servo_classes_${name})
    string(REPLACE ":" ";" file_and_class ${class})
    list(GET file_and_class 0 file)
    list(GET file_and_class 1 case)
    string(REPLACE ":" "." title ${class})
    fdcg_script_test("contract_${name}: ${title}" TIER nightly TIMEOUT 600 PROPERTIES PROCESSORS 2
      COMMAND ${FDCG_PYTHON} -B ${PROJECT_SOURCE_DIR}/tests/contract/${file}.py ${case} ENVIRONMENT
      "FDCG=$<TARGET_FILE:fdcg>;FDCG_SERVO=$<TARGET_FILE:${target}>;FDCG_SLOW_HOST=1;FDCG_ROOT=${PROJECT_SOURCE_DIR};FDCG_FAKE_HID=$<TARGET_FILE_DIR:fdcg_test_fake_hid_node>;FDCG_FAKE_HID_FIRMWARE=$<TARGET_FILE_DIR:fdcg_test_fake_hid_firmware>;FDCG_PTY_DEVICE=$<TARGET_FILE:fdcg_test_pty_device>;FDCG_PLUGIN_HAPLY_INVERSE=$<TARGET_FILE:fdcg_haply_inverse>;FDCG_PLUGIN_FORCE_DIMENSION=$<TARGET_FILE:fdcg_test_force_dimension>;FDCG_PLUGIN_NOVINT_FALCON=$<TARGET_FILE:fdcg_test_novint_falcon>;ASAN_OPTIONS=${sanitizer_options};TSAN_OPTIONS=${sanitizer_options}")
  endforeach()
endfunction()

find_package(CLI11 REQUIRED)
add_custom_target(fdcg_sanitized)
fdcg_sanitized_parts(tsan -fsanitize=thread)
fdcg_sanitized_parts(asan "-fsanitize=address,undefined;-fno-sanitize-recover=all")
foreach(name tsan asan)
  foreach(program IN LISTS device_programs)
    fdcg_sanitized_test(${name} ${program})
  endforeach()
  fdcg_sanitized_servo(${name})
endforeach()
