# Installs the build to a folder of its own, builds the consumer against that folder alone, and runs it and
# the installed command. -DBUILD -DSOURCE -DFOLDER -DGENERATOR -DCOMPILER -DTYPE -DSANITIZE
cmake_minimum_required(VERSION 3.22)
if(SANITIZE)
  message("SKIPPED: libraries with sanitizers are not for installing.")
  return()
endif()
file(REMOVE_RECURSE ${FOLDER})
set(prefix ${FOLDER}/prefix)

function(run what)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE text ERROR_VARIABLE text
                  WORKING_DIRECTORY ${FOLDER})
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${what} failed (${result}):\n${text}")
  endif()
  set(output "${text}" PARENT_SCOPE)
endfunction()

file(MAKE_DIRECTORY ${FOLDER})
run("Installing (is everything built?)" ${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix})

# The package must not lead back to the source or build tree.
file(GLOB_RECURSE package ${prefix}/*.cmake)
foreach(file IN LISTS package)
  file(READ ${file} text)
  foreach(tree ${SOURCE}/ ${BUILD})
    string(FIND "${text}" "${tree}" found)
    if(NOT found EQUAL -1)
      message(FATAL_ERROR "${file} names ${tree}")
    endif()
  endforeach()
endforeach()

file(COPY ${CMAKE_CURRENT_LIST_DIR}/CMakeLists.txt ${CMAKE_CURRENT_LIST_DIR}/main.cpp
     DESTINATION ${FOLDER}/consumer)
run("Configuring the consumer" ${CMAKE_COMMAND} -S ${FOLDER}/consumer -B ${FOLDER}/consumer/build
    -G ${GENERATOR} -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_CXX_COMPILER=${COMPILER}
    -DCMAKE_BUILD_TYPE=${TYPE})
run("Building the consumer" ${CMAKE_COMMAND} --build ${FOLDER}/consumer/build)
run("Running the consumer" ${FOLDER}/consumer/build/two_inertias)
message("${output}")
if(EXISTS ${prefix}/bin/drev)
  run("Running the installed command" ${prefix}/bin/drev --help)
endif()
