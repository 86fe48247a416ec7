# SPDX-License-Identifier: Apache-2.0
# docs/internals against the code that it speaks of, and the citations in code.
find_program(FDCG_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH)
find_program(FDCG_PYTHON python3 REQUIRED)

set(files citations_test architecture)
if(TARGET fdcg AND TARGET fdcg-servo)
  list(APPEND files model_test)
endif()
foreach(file ${files})
  add_test(NAME "docs: ${file}" COMMAND ${FDCG_PYTHON} -B ${CMAKE_CURRENT_LIST_DIR}/${file}.py)
  set_tests_properties("docs: ${file}" PROPERTIES TIMEOUT 120 LABELS fast)
endforeach()
if(TARGET fdcg AND TARGET fdcg-servo)
  set_tests_properties("docs: model_test" PROPERTIES ENVIRONMENT "FDCG=$<TARGET_FILE:fdcg>;FDCG_SERVO=$<TARGET_FILE:fdcg-servo>")
endif()
