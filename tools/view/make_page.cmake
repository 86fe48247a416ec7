# SPDX-License-Identifier: Apache-2.0
# cmake -DSOURCE=tools/view -DFOLDER=... -DWASM=fdcg.wasm -DOUTPUT=viewer.html -DNPM=npm -DNODE=node -DREQUIRED=ON
#       -P make_page.cmake
# Fetches the packages of package-lock.json, checks the types and bundles the viewer. Where the packages cannot be fetched and
# the viewer is not required, OUTPUT says why, and is old, so that the next build tries again.
cmake_minimum_required(VERSION 3.22)
file(COPY ${SOURCE}/ DESTINATION ${FOLDER} PATTERN node_modules EXCLUDE)

function(run_in_folder step)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${FOLDER} RESULT_VARIABLE code OUTPUT_VARIABLE said ERROR_VARIABLE said)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "fdcg: the viewer's ${step} failed (${code})\n${said}")
  endif()
endfunction()

# what is there already is that of this lock
set(stamp ${FOLDER}/node_modules/.fdcg-lock)
file(SHA256 ${SOURCE}/package-lock.json wanted)
set(present "")
if(EXISTS ${stamp})
  file(READ ${stamp} present)
endif()
if(NOT present STREQUAL wanted)
  execute_process(COMMAND ${NPM} ci --ignore-scripts --no-audit --no-fund --fetch-retries=1 WORKING_DIRECTORY ${FOLDER}
                  RESULT_VARIABLE code OUTPUT_VARIABLE said ERROR_VARIABLE said)
  if(NOT code EQUAL 0)
    if(REQUIRED)
      message(FATAL_ERROR "fdcg: npm could not fetch the viewer's packages\n${said}")
    endif()
    message(WARNING "fdcg: npm could not fetch the viewer's packages; fdcg view will say so\n${said}")
    file(WRITE ${OUTPUT} "missing: npm could not fetch its packages when the program was built")
    execute_process(COMMAND touch -d @0 ${OUTPUT})
    return()
  endif()
  file(WRITE ${stamp} "${wanted}")
endif()
run_in_folder("type check" ${NODE} node_modules/typescript/bin/tsc -p .)
run_in_folder("bundling" ${NODE} bundle.mjs ${WASM} ${OUTPUT})
