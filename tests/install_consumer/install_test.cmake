# Installs the build to a folder of its own, builds the consumer against that folder alone, by find_package and
# by pkg-config, and runs it and the installed command; makes the Debian packages and runs the command in them.
# -DBUILD -DSOURCE -DFOLDER -DGENERATOR -DCOMPILER -DTYPE -DSANITIZE
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

find_program(PKG_CONFIG pkg-config)
if(PKG_CONFIG)
  file(GLOB_RECURSE pc ${prefix}/*/drev.pc)
  get_filename_component(folder ${pc} DIRECTORY)
  run("pkg-config" ${CMAKE_COMMAND} -E env PKG_CONFIG_PATH=${folder} ${PKG_CONFIG} --cflags --libs drev)
  separate_arguments(flags UNIX_COMMAND "${output}")
  # For this machine's instructions, which drev is not built for: both must still free each other's vectors.
  run("Building by pkg-config" ${COMPILER} -O1 -march=native ${FOLDER}/consumer/main.cpp ${flags}
      -o ${FOLDER}/by_pkg_config)
  run("Running what pkg-config built" ${FOLDER}/by_pkg_config)
else()
  message("no pkg-config here: not tried")
endif()

if(NOT EXISTS ${prefix}/bin/drev)
  return()
endif()
set(job run camshaft --set duration_s=0.05)
run("Running the installed command" ${prefix}/bin/drev ${job})
find_program(DPKG_DEB dpkg-deb)
find_program(DPKG_SHLIBDEPS dpkg-shlibdeps)
if(DPKG_DEB AND DPKG_SHLIBDEPS)
  run("Packing" ${CMAKE_CPACK_COMMAND} --config ${BUILD}/CPackConfig.cmake -B ${FOLDER}/packages)
  file(GLOB packages ${FOLDER}/packages/*.deb)
  foreach(package IN LISTS packages)
    run("Unpacking" ${DPKG_DEB} -x ${package} ${FOLDER}/unpacked)
  endforeach()
  run("Running the packed command" ${FOLDER}/unpacked/usr/bin/drev ${job})
  foreach(file include/drev/core/model.hpp share/doc/drev/copyright share/drev/results.schema.json
         share/bash-completion/completions/drev)
    if(NOT EXISTS ${FOLDER}/unpacked/usr/${file})
      message(FATAL_ERROR "the packages lack ${file}")
    endif()
  endforeach()
else()
  message("no dpkg-deb or dpkg-shlibdeps here: packages not tried")
endif()
