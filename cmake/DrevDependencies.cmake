# Finds what drev links: Eigen, CHOLMOD, KLU, UMFPACK (SuiteSparse) and ARPACK, as Debian packages them.
# SuiteSparse 5 ships no CMake package files, so its libraries are found by name.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
function(drev_find_library target header library)
  if(TARGET drev_deps::${target})
    return()
  endif()
  find_path(DREV_${target}_INCLUDE ${header} PATH_SUFFIXES suitesparse arpack)
  find_library(DREV_${target}_LIBRARY ${library})
  if(NOT DREV_${target}_INCLUDE OR NOT DREV_${target}_LIBRARY)
    message(FATAL_ERROR "drev needs ${library} (${header}); on Debian: apt install libsuitesparse-dev libarpack2-dev")
  endif()
  add_library(drev_deps::${target} INTERFACE IMPORTED)
  set_target_properties(drev_deps::${target} PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${DREV_${target}_INCLUDE}"
    INTERFACE_LINK_LIBRARIES "${DREV_${target}_LIBRARY}")
endfunction()
drev_find_library(cholmod cholmod.h cholmod)
drev_find_library(klu klu.h klu)
drev_find_library(umfpack umfpack.h umfpack)
drev_find_library(arpack arpack.h arpack)
