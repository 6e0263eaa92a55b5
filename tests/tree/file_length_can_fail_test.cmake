# Proves that file_length_test.cmake can fail, on a tree without git: 500 lines pass, 501 do not, data may be
# longer. -DSCRIPT=file_length_test.cmake -DFOLDER=<scratch>
cmake_minimum_required(VERSION 3.22)
string(REPEAT "x; [\n" 500 limit)

function(expect what outcome file)
  execute_process(COMMAND ${CMAKE_COMMAND} -DROOT=${FOLDER} -P ${SCRIPT}
                  RESULT_VARIABLE result OUTPUT_VARIABLE text ERROR_VARIABLE text)
  if(outcome STREQUAL "pass" AND NOT result EQUAL 0)
    message(FATAL_ERROR "${what} should pass:\n${text}")
  elseif(outcome STREQUAL "fail" AND (result EQUAL 0 OR NOT text MATCHES "  ${file}: 501 lines"))
    message(FATAL_ERROR "${what} should fail and name ${file} (exit ${result}):\n${text}")
  endif()
endfunction()

file(REMOVE_RECURSE ${FOLDER})
file(WRITE ${FOLDER}/core/a.cpp "${limit}")
file(WRITE ${FOLDER}/models/m/data/table.csv "${limit}${limit}")
file(WRITE ${FOLDER}/build/release/generated.cpp "${limit}${limit}")
expect("a tree at the limit" pass "")
foreach(file core/b.hpp docs/theory.md scripts/run.sh .ci/run)
  file(WRITE ${FOLDER}/${file} "${limit}\n")
  expect("a longer ${file}" fail ${file})
  file(REMOVE ${FOLDER}/${file})
endforeach()
file(REMOVE_RECURSE ${FOLDER})
file(MAKE_DIRECTORY ${FOLDER})
execute_process(COMMAND ${CMAKE_COMMAND} -DROOT=${FOLDER} -P ${SCRIPT} RESULT_VARIABLE result
                OUTPUT_QUIET ERROR_QUIET)
if(result EQUAL 0)
  message(FATAL_ERROR "An empty tree should fail: nothing is checked there.")
endif()
