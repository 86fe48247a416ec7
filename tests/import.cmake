# SPDX-License-Identifier: Apache-2.0
# Tests, fuzz targets and the benchmark of the readers, and the tests of the writers. They link nothing but these two.
if(FDCG_BUILD_TESTS)
  find_package(OpenMesh REQUIRED)
  add_library(fdcg_import_testing INTERFACE)
  target_include_directories(fdcg_import_testing INTERFACE ${PROJECT_SOURCE_DIR}/lib/src ${CMAKE_CURRENT_SOURCE_DIR})
  target_compile_definitions(fdcg_import_testing INTERFACE FDCG_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  fdcg_test(text_scanner SOURCES lib/import/text_scanner_test.cpp LIBRARIES fdcg_import fdcg_import_testing)
  fdcg_test(import SOURCES lib/import/import_test.cpp lib/import/import_off_test.cpp lib/import/import_obj_test.cpp lib/import/import_ply_test.cpp
            lib/import/import_ply_binary_test.cpp lib/import/import_stl_test.cpp LIBRARIES fdcg_import fdcg_import_testing)
  fdcg_test(guarded_child SOURCES lib/import/guarded_child_test.cpp LIBRARIES fdcg_import fdcg_import_testing)
  fdcg_test(import_drc SOURCES lib/import/import_drc_test.cpp LIBRARIES fdcg_import fdcg_import_testing fdcg_test_mesh_writers)
  fdcg_test(import_gltf SOURCES lib/import/import_gltf_test.cpp lib/import/import_gltf_scene_test.cpp lib/import/import_gltf_refusal_test.cpp LIBRARIES fdcg_import fdcg_import_testing fdcg_test_mesh_writers
            nlohmann_json::nlohmann_json)
  fdcg_test(import_corpus SOURCES lib/import/import_corpus_test.cpp LIBRARIES fdcg_import fdcg_import_testing)
  fdcg_test(import_allocation SOURCES lib/import/import_allocation_test.cpp LIBRARIES fdcg_import fdcg_import_testing)
  fdcg_test(import_openmesh SOURCES lib/import/import_openmesh_test.cpp LIBRARIES fdcg_import fdcg_import_testing OpenMeshCore)
  fdcg_test(export SOURCES lib/export/export_test.cpp LIBRARIES fdcg_export fdcg_import fdcg_import_testing OpenMeshCore)
  # with sanitizers GCC 12 sees OpenMesh's vectors copied before they are set
  foreach(test import_openmesh export)
    target_compile_options(fdcg_test_${test} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  endforeach()
endif()

if(FDCG_BUILD_FUZZERS)
  # One target a reader. Run: fdcg_fuzz_import_ply testdata/fuzz/import_ply
  foreach(format off obj ply stl gltf glb drc)
    add_executable(fdcg_fuzz_import_${format} fuzz/fuzz_import_${format}.cpp)
    target_link_libraries(fdcg_fuzz_import_${format} PRIVATE fdcg_import fdcg_flags)
    target_link_options(fdcg_fuzz_import_${format} PRIVATE -fsanitize=fuzzer)
  endforeach()
  target_include_directories(fdcg_fuzz_import_drc PRIVATE ${PROJECT_SOURCE_DIR}/lib/src)
endif()

if(FDCG_BUILD_BENCHMARKS)
  find_package(benchmark REQUIRED)
  find_package(OpenMesh REQUIRED)
  add_executable(fdcg_bench_import bench/import_bench.cpp)
  target_link_libraries(fdcg_bench_import PRIVATE fdcg_import fdcg_flags OpenMeshCore benchmark::benchmark)
endif()
