# SPDX-License-Identifier: Apache-2.0
# How tests are made: fdcg_test() for a Catch2 program, fdcg_script_test() for a command. Every test has one tier, which is its
# CTest label and decides which of the targets fdcg_fast and fdcg_standard builds it; "all" builds everything.
#   fast      unit tests and the contract of the commands
#   standard  properties, seeded defects, consumers, other targets, quick evaluation
#   all       real files, agreement with the reference, mutants, the virtual machine
#   nightly   hours
set(fdcg_tiers fast standard all nightly)
add_custom_target(fdcg_fast)
add_custom_target(fdcg_standard)
add_dependencies(fdcg_standard fdcg_fast)

# fdcg_in_tier(TIER target...): builds the targets with a tier.
function(fdcg_in_tier tier)
  if(NOT tier IN_LIST fdcg_tiers)
    message(FATAL_ERROR "fdcg: '${tier}' is no tier; the tiers are ${fdcg_tiers}")
  endif()
  if(TARGET fdcg_${tier})
    add_dependencies(fdcg_${tier} ${ARGN})
  endif()
endfunction()

# Code of tests mostly waits for the library: optimised it would only take longer to compile. What computes itself is at -O1.
set(fdcg_test_level $<$<CONFIG:Release>:-O0>)
set(fdcg_computing_level $<$<CONFIG:Release>:-O1>)

# fdcg_test(NAME TIER tier SOURCES ... LIBRARIES ... [INCLUDES folder...] [DEFINITIONS ...] [TIMEOUT seconds] [COMPUTES]
# [OWN_HEADERS] [RUN_ALONE]): one Catch2 program, each test case a CTest test. COMPUTES: it is to be optimised. OWN_HEADERS: so
# too, and its flags differ from the others', so that it cannot share their precompiled header. RUN_ALONE: beside no other test.
function(fdcg_test name)
  cmake_parse_arguments(arg "COMPUTES;OWN_HEADERS;RUN_ALONE" "TIER;TIMEOUT" "SOURCES;LIBRARIES;INCLUDES;DEFINITIONS" ${ARGN})
  if(NOT arg_TIER)
    message(FATAL_ERROR "fdcg: test ${name} has no tier; the tiers are ${fdcg_tiers}")
  endif()
  set(target fdcg_test_${name})
  add_executable(${target} ${arg_SOURCES})
  target_link_libraries(${target} PRIVATE fdcg_test_main ${arg_LIBRARIES})
  target_include_directories(${target} PRIVATE ${arg_INCLUDES})
  target_compile_definitions(${target} PRIVATE ${arg_DEFINITIONS})
  if(arg_OWN_HEADERS)
    target_compile_options(${target} PRIVATE ${fdcg_computing_level})
  elseif(arg_COMPUTES)
    fdcg_precompiled(${target} "${fdcg_computing_level}" REUSE_FROM fdcg_computing_headers)
  else()
    fdcg_precompiled(${target} "${fdcg_test_level}" REUSE_FROM fdcg_test_main)
  endif()
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 600)
  endif()
  fdcg_in_tier(${arg_TIER} ${target})
  catch_discover_tests(${target} TEST_PREFIX "${name}: " DISCOVERY_MODE PRE_TEST
                       PROPERTIES TIMEOUT ${arg_TIMEOUT} LABELS ${arg_TIER} SKIP_REGULAR_EXPRESSION "skipped: "
                                  RUN_SERIAL ${arg_RUN_ALONE})
endfunction()

# fdcg_script_test(NAME TIER tier COMMAND ... [NEEDS target...] [ENVIRONMENT ...] [TIMEOUT seconds] [RUN_ALONE] [PROPERTIES ...]):
# any command as a test. NEEDS are built with its tier.
function(fdcg_script_test name)
  cmake_parse_arguments(arg "RUN_ALONE" "TIER;TIMEOUT" "COMMAND;NEEDS;ENVIRONMENT;PROPERTIES" ${ARGN})
  if(NOT arg_TIER)
    message(FATAL_ERROR "fdcg: test ${name} has no tier; the tiers are ${fdcg_tiers}")
  endif()
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 300)
  endif()
  add_test(NAME "${name}" COMMAND ${arg_COMMAND} COMMAND_EXPAND_LISTS)
  set_tests_properties("${name}" PROPERTIES TIMEOUT ${arg_TIMEOUT} LABELS ${arg_TIER} SKIP_REGULAR_EXPRESSION "OK \\(skipped="
                       RUN_SERIAL ${arg_RUN_ALONE} ENVIRONMENT "${arg_ENVIRONMENT}" ${arg_PROPERTIES})
  if(arg_NEEDS)
    fdcg_in_tier(${arg_TIER} ${arg_NEEDS})
  endif()
endfunction()
