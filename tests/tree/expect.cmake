# For proofs that a check of the tree can fail. ${SCRIPT} is the check, ${FOLDER} the tree that it is given.

# expect(<what> pass|fail <text>): whether it passes, or fails with a finding that holds the text: the file, and what of
# it.
function(expect what outcome finding)
  execute_process(COMMAND ${CMAKE_COMMAND} -DROOT=${FOLDER} -P ${SCRIPT}
                  RESULT_VARIABLE result OUTPUT_VARIABLE text ERROR_VARIABLE text)
  if(outcome STREQUAL "pass" AND NOT result EQUAL 0)
    message(FATAL_ERROR "${what} should pass:\n${text}")
  elseif(outcome STREQUAL "fail" AND (result EQUAL 0 OR NOT text MATCHES "  [^\n]*${finding}"))
    message(FATAL_ERROR "${what} should fail and name ${finding} (exit ${result}):\n${text}")
  endif()
endfunction()

# An empty tree must fail: nothing is checked there.
function(expect_empty_tree_fails)
  file(REMOVE_RECURSE ${FOLDER})
  file(MAKE_DIRECTORY ${FOLDER}/core)
  execute_process(COMMAND ${CMAKE_COMMAND} -DROOT=${FOLDER} -P ${SCRIPT} RESULT_VARIABLE result
                  OUTPUT_QUIET ERROR_QUIET)
  if(result EQUAL 0)
    message(FATAL_ERROR "An empty tree should fail: nothing is checked there.")
  endif()
endfunction()
