# Finds what drev links: Eigen, CHOLMOD and KLU (SuiteSparse), ARPACK and LAPACK, as Debian packages them, and HDF5 for
# drev::report. Used by the build and, installed, by find_package(drev). SuiteSparse 5 ships no CMake package
# files, and CMake's own module for HDF5 wants a C compiler, so libraries are found by name.
function(drev_find_library target header)  # names of the library
  if(TARGET drev_deps::${target})
    return()
  endif()
  find_path(DREV_${target}_INCLUDE ${header} PATH_SUFFIXES suitesparse arpack arpack-ng hdf5/serial)
  find_library(DREV_${target}_LIBRARY NAMES ${ARGN} PATH_SUFFIXES hdf5/serial)
  mark_as_advanced(DREV_${target}_INCLUDE DREV_${target}_LIBRARY)
  if(NOT DREV_${target}_INCLUDE OR NOT DREV_${target}_LIBRARY)
    set(DREV_MISSING ${DREV_MISSING} "${ARGV2} (${header})" PARENT_SCOPE)
    return()
  endif()
  add_library(drev_deps::${target} INTERFACE IMPORTED GLOBAL)
  set_target_properties(drev_deps::${target} PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${DREV_${target}_INCLUDE}"
    INTERFACE_LINK_LIBRARIES "${DREV_${target}_LIBRARY}")
endfunction()

set(DREV_MISSING "")
find_package(Threads REQUIRED)
find_package(Eigen3 3.4 QUIET NO_MODULE)
if(NOT TARGET Eigen3::Eigen)
  list(APPEND DREV_MISSING "Eigen 3.4 (Eigen3Config.cmake)")
endif()
drev_find_library(cholmod cholmod.h cholmod)
drev_find_library(klu klu.h klu)
drev_find_library(arpack arpack.h arpack)
# CHOLMOD and ARPACK stand on LAPACK: it is there where they are. It has no header (core/dense/lapack.hpp).
find_library(DREV_lapack_LIBRARY lapack)
mark_as_advanced(DREV_lapack_LIBRARY)
if(NOT DREV_lapack_LIBRARY)
  list(APPEND DREV_MISSING "LAPACK")
elseif(NOT TARGET drev_deps::lapack)
  add_library(drev_deps::lapack INTERFACE IMPORTED GLOBAL)
  set_target_properties(drev_deps::lapack PROPERTIES INTERFACE_LINK_LIBRARIES "${DREV_lapack_LIBRARY}")
endif()
if(DREV_MISSING)
  list(JOIN DREV_MISSING ", " DREV_MISSING)
  set(DREV_MISSING "drev needs ${DREV_MISSING}; on Debian or Ubuntu: \
apt-get install libeigen3-dev libsuitesparse-dev libarpack2-dev liblapack-dev")
  if(NOT CMAKE_FIND_PACKAGE_NAME STREQUAL "drev")
    message(FATAL_ERROR "${DREV_MISSING}")
  endif()
endif()
# Only drev::report needs it: who does without that may do without this.
set(drev_missing "${DREV_MISSING}")
drev_find_library(hdf5 hdf5.h hdf5_serial hdf5)
set(DREV_MISSING "${drev_missing}")
