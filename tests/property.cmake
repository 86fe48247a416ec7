# SPDX-License-Identifier: Apache-2.0
# Properties of the step over many meshes and walks. FDCG_STEPS in the environment sets the steps of each walk.
add_library(fdcg_test_property_support STATIC support/contact_rig.cpp support/hip_loop.cpp support/hip_walk.cpp support/lockstep.cpp)
target_compile_options(fdcg_test_property_support PRIVATE -O2)
target_include_directories(fdcg_test_property_support PUBLIC support)
target_link_libraries(fdcg_test_property_support PUBLIC fdcg_bake fdcg_test_meshes fdcg_test_reference fdcg_runtime PRIVATE fdcg_flags)

# What the references compute in one tick the step may carry over to later ones: here it has all the work it wants. Its one
# function then comes from here, the rest of the runtime as it ships.
set(all_the_work FDCG_RULE_WORK=1000000000 FDCG_SWEEP_WORK=1000000000 FDCG_UPKEEP_WORK=1000000000)
function(fdcg_step_variant name source)
  add_library(${name} OBJECT ${PROJECT_SOURCE_DIR}/runtime/src/${source})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/runtime/src ${PROJECT_SOURCE_DIR}/runtime ${PROJECT_SOURCE_DIR}/runtime/include)
  target_compile_definitions(${name} PRIVATE $<TARGET_PROPERTY:fdcg_runtime,COMPILE_DEFINITIONS> ${all_the_work} ${ARGN})
  target_compile_options(${name} PRIVATE $<TARGET_PROPERTY:fdcg_runtime,COMPILE_OPTIONS>)
  target_link_libraries(${name} PRIVATE fdcg_flags)
endfunction()
fdcg_step_variant(fdcg_test_unbounded_step step/servo_step.cpp)
fdcg_step_variant(fdcg_test_unbounded_deform_step deform/deform_step.cpp)
fdcg_step_variant(fdcg_test_second_step step/servo_step.cpp fdcg_step=fdcg_step_unbounded)
set(unbounded $<TARGET_OBJECTS:fdcg_test_unbounded_step>)

fdcg_test(reference_agreement SOURCES runtime/step/reference_agreement_test.cpp ${unbounded} LIBRARIES fdcg_test_property_support TIMEOUT 36000)
fdcg_test(contact_properties SOURCES runtime/step/closest_point_test.cpp runtime/step/corner_friction_test.cpp runtime/step/friction_curve_test.cpp runtime/step/friction_test.cpp runtime/step/invariance_test.cpp runtime/step/energy_test.cpp ${unbounded}
          LIBRARIES fdcg_test_property_support)
fdcg_test(materials SOURCES runtime/step/materials_test.cpp runtime/step/materials_felt_test.cpp LIBRARIES fdcg_test_property_support fdcg_test_mesh_writers)
fdcg_test(rule_bound SOURCES runtime/step/rule_bound_test.cpp $<TARGET_OBJECTS:fdcg_test_second_step> LIBRARIES fdcg_test_property_support)
fdcg_test(sweep SOURCES runtime/step/sweep_bound_test.cpp LIBRARIES fdcg_test_property_support)
fdcg_test(deform_motion SOURCES runtime/deform/deform_motion_test.cpp runtime/deform/deform_test.cpp LIBRARIES fdcg_test_property_support TIMEOUT 36000)
fdcg_test(deform SOURCES runtime/deform/deform_upkeep_test.cpp runtime/deform/deform_ball_test.cpp ${unbounded} $<TARGET_OBJECTS:fdcg_test_unbounded_deform_step>
          LIBRARIES fdcg_test_property_support TIMEOUT 36000)
target_include_directories(fdcg_test_deform PRIVATE ${PROJECT_SOURCE_DIR}/runtime/src)
fdcg_test(deform_scene SOURCES runtime/deform/deform_scene_test.cpp LIBRARIES fdcg_test_property_support)
fdcg_test(clear_ball SOURCES runtime/step/clear_ball_test.cpp ${unbounded} LIBRARIES fdcg_test_property_support)
fdcg_test(contact_rules SOURCES runtime/step/contact_rules_test.cpp runtime/step/stress_cases_test.cpp ${unbounded} LIBRARIES fdcg_test_property_support)
find_package(Threads REQUIRED)
fdcg_test(scene SOURCES runtime/scene/scene_test.cpp bench/heap_count.cpp LIBRARIES fdcg_test_property_support Threads::Threads)
target_include_directories(fdcg_test_scene PRIVATE bench)
fdcg_test(moving_objects SOURCES runtime/scene/moving_objects_test.cpp runtime/scene/scene_skips_test.cpp LIBRARIES fdcg_test_property_support)

find_package(nlohmann_json REQUIRED)
fdcg_test(surface SOURCES runtime/surface/surface_test.cpp runtime/surface/surface_deep_test.cpp runtime/surface/surface_rules_test.cpp runtime/surface/surface_scene_test.cpp runtime/surface/surface_tessellation_test.cpp
          runtime/surface/surface_way_test.cpp runtime/surface/surface_shape_test.cpp LIBRARIES fdcg_test_property_support)

fdcg_test(primitives SOURCES lib/graph/primitives_test.cpp LIBRARIES fdcg_bake fdcg_test_meshes fdcg_test_walker)
fdcg_test(verdict SOURCES lib/validate/verdict_test.cpp LIBRARIES fdcg_bake nlohmann_json::nlohmann_json TIMEOUT 36000)

# Each rule taken out of a copy of the runtime must make its test fail.
find_package(Python3 REQUIRED COMPONENTS Interpreter)
add_library(fdcg_test_contact_rules_objects OBJECT runtime/step/contact_rules_test.cpp)
target_link_libraries(fdcg_test_contact_rules_objects PRIVATE fdcg_test_main fdcg_test_property_support)
if(NOT "${CMAKE_CXX_FLAGS}" MATCHES "-fsanitize") # the mutants are built without
  add_test(NAME rules_matter
    COMMAND Python3::Interpreter ${CMAKE_CURRENT_SOURCE_DIR}/runtime/step/rules_matter.py --source ${PROJECT_SOURCE_DIR}
      --work ${CMAKE_CURRENT_BINARY_DIR}/rules_matter --compiler ${CMAKE_CXX_COMPILER}
      --link $<TARGET_OBJECTS:fdcg_test_contact_rules_objects> $<TARGET_FILE:fdcg_test_main>
      $<TARGET_FILE:fdcg_test_property_support> $<TARGET_FILE:fdcg_test_meshes> $<TARGET_FILE:fdcg_test_reference>
      $<TARGET_FILE:fdcg_bake> -lcrypto -lmpfr -lgmp -lpthread
    COMMAND_EXPAND_LISTS)
  set_tests_properties(rules_matter PROPERTIES TIMEOUT 1200)
endif()

# Validation of meshes with planted defects, through files.
add_library(fdcg_test_seeding STATIC support/clean_mesh.cpp support/mesh_files.cpp support/seeder.cpp
            support/seeder_kinds.cpp)
target_compile_options(fdcg_test_seeding PRIVATE -O2)
target_include_directories(fdcg_test_seeding PUBLIC support ${PROJECT_SOURCE_DIR}/lib/include PRIVATE ${PROJECT_SOURCE_DIR}/lib/src)
target_link_libraries(fdcg_test_seeding PUBLIC fdcg_test_meshes fdcg_test_mesh_writers PRIVATE fdcg_flags)
fdcg_test(seeded_defects SOURCES lib/validate/seeded_defects_test.cpp LIBRARIES fdcg_test_seeding fdcg_bake TIMEOUT 36000)

# Mesh files of other people. Debian's libcgal-demo has them in an archive.
set(cgal_archive /usr/share/doc/libcgal-dev/data.tar.gz)
set(cgal_data ${PROJECT_BINARY_DIR}/cgal_data)
if(EXISTS ${cgal_archive} AND NOT EXISTS ${cgal_data})
  file(ARCHIVE_EXTRACT INPUT ${cgal_archive} DESTINATION ${cgal_data})
endif()
find_package(CGAL REQUIRED QUIET)
fdcg_test(real_files SOURCES lib/validate/real_files_test.cpp support/plain_recount.cpp LIBRARIES fdcg_bake CGAL::CGAL TIMEOUT 3600)
target_compile_definitions(fdcg_test_real_files PRIVATE FDCG_SOURCE_DIR="${PROJECT_SOURCE_DIR}" FDCG_CGAL_DATA="${cgal_data}")
fdcg_test(seeded_repair SOURCES lib/repair/seeded_repair_test.cpp LIBRARIES fdcg_test_seeding fdcg_bake TIMEOUT 3600)
fdcg_test(conversion SOURCES lib/import/conversion_test.cpp LIBRARIES fdcg_test_seeding fdcg_bake TIMEOUT 3600)
target_compile_definitions(fdcg_test_conversion PRIVATE FDCG_SOURCE_DIR="${PROJECT_SOURCE_DIR}" FDCG_CGAL_DATA="${cgal_data}")
fdcg_test(self_intersection_cgal SOURCES lib/validate/self_intersection_cgal_test.cpp LIBRARIES fdcg_bake fdcg_test_meshes CGAL::CGAL TIMEOUT 3600)
target_include_directories(fdcg_test_self_intersection_cgal PRIVATE ${PROJECT_SOURCE_DIR}/lib/src)
target_compile_definitions(fdcg_test_self_intersection_cgal PRIVATE FDCG_SOURCE_DIR="${PROJECT_SOURCE_DIR}" FDCG_CGAL_DATA="${cgal_data}")

# Segments against an exact judge. FDCG_SEGMENTS sets how many.
fdcg_test(leak SOURCES runtime/step/leak_test.cpp support/exact_solid.cpp LIBRARIES fdcg_test_property_support CGAL::CGAL gmp mpfr TIMEOUT 86400)
target_compile_options(fdcg_test_leak PRIVATE -O2)
