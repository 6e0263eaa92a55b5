# How drev's own targets are compiled. Nothing of it reaches a project that uses drev.
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES AND PROJECT_IS_TOP_LEVEL)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()
if(PROJECT_IS_TOP_LEVEL)
  set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
  set(CMAKE_ARCHIVE_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib)
endif()
set(CMAKE_CXX_EXTENSIONS OFF)

find_program(DREV_CCACHE_PROGRAM ccache)
mark_as_advanced(DREV_CCACHE_PROGRAM)
if(DREV_CCACHE AND DREV_CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # Precompiled headers need this laxity, or ccache stores nothing.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env
      CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime
      ${DREV_CCACHE_PROGRAM})
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    add_compile_options(-fpch-preprocess)
  endif()
endif()

if(DREV_SANITIZE)
  # A null pointer ends the program all the same, alignment is asserted by Eigen; without these two checks
  # the build takes three quarters of its time.
  add_compile_options(-fsanitize=${DREV_SANITIZE} -fno-sanitize=null,alignment
    -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${DREV_SANITIZE})
endif()

# g++ clears away no memory before it has used 1 GiB, where that much is there for each processor: a tenth of the time.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  cmake_host_system_information(RESULT memory QUERY TOTAL_PHYSICAL_MEMORY)  # MiB
  cmake_host_system_information(RESULT processors QUERY NUMBER_OF_LOGICAL_CORES)
  math(EXPR each "${memory} / ${processors}")
  if(each GREATER 3000)
    add_compile_options("SHELL:--param ggc-min-heapsize=1048576")
  endif()
endif()

# "text" + std::string makes g++ 12 and 13 warn of overlaps and sizes that cannot occur (GCC bug 105651).
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 14)
  set(DREV_NO_WARNINGS -Wno-restrict -Wno-stringop-overflow -Wno-array-bounds)
endif()

# Headers that are slow to read and never change. Sources include what they use all the same; build
# with -DDREV_PRECOMPILE=OFF to see that they do.
set(DREV_PRECOMPILED <Eigen/Dense> <Eigen/SparseCore> <functional> <memory> <string> <vector>)
if(SKBUILD)  # Nothing changes between pip's units: what most of them read of drev itself is precompiled, too.
  list(APPEND DREV_PRECOMPILED <drev/core/assembler.hpp>)
endif()

# Whose precompiled header those use that compute little.
set(DREV_COLD drev_core)

# Language level and warnings; further arguments: what to precompile, or REUSE_FROM <target>.
function(drev_compile target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  if(NOT SKBUILD)  # pip install has someone waiting.
    target_compile_options(${target} PRIVATE -Wall -Wextra -Wconversion ${DREV_NO_WARNINGS}
      $<$<BOOL:${DREV_WARNINGS_AS_ERRORS}>:-Werror>)
  endif()
  if(ARGV2 STREQUAL "drev_cold")
    target_compile_options(${target} PRIVATE ${DREV_COLD_OPTIONS})
  endif()
  if(NOT DREV_PRECOMPILE OR NOT ARGN)
    return()
  elseif(ARGV1 STREQUAL "REUSE_FROM")
    target_precompile_headers(${target} REUSE_FROM ${ARGV2})
  else()
    target_precompile_headers(${target} PRIVATE ${ARGN})
  endif()
endfunction()

# pip install has someone waiting for it: what computes little is compiled with -O1, without the passes of it that take
# longest (a quarter of the time). g++ takes the level from a precompiled header, whatever the command line says, so it
# has one of its own, which reads what all of them read.
set(DREV_COLD_OPTIONS -O1 -fno-tree-pta -fno-inline-functions-called-once)
function(drev_make_cold)
  find_package(nlohmann_json REQUIRED)
  file(WRITE ${PROJECT_BINARY_DIR}/generated/drev_cold.cpp "// drev_cold is a precompiled header.\n")
  add_library(drev_cold OBJECT ${PROJECT_BINARY_DIR}/generated/drev_cold.cpp)
  set_target_properties(drev_cold PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_link_libraries(drev_cold PRIVATE Eigen3::Eigen nlohmann_json::nlohmann_json)
  target_compile_definitions(drev_cold PRIVATE $<TARGET_PROPERTY:drev_core,INTERFACE_COMPILE_DEFINITIONS>)
  target_include_directories(drev_cold PRIVATE $<TARGET_PROPERTY:drev_core,INTERFACE_INCLUDE_DIRECTORIES>)
  target_compile_options(drev_cold PRIVATE ${DREV_COLD_OPTIONS})
  drev_compile(drev_cold ${DREV_PRECOMPILED} <nlohmann/json.hpp>)
endfunction()

# drev_part(<target> <part> <type> <sources>): a library <target>_<part> of those of the target's sources.
function(drev_part target part type)
  get_target_property(sources ${target} SOURCES)
  list(REMOVE_ITEM sources ${ARGN})
  set_target_properties(${target} PROPERTIES SOURCES "${sources}")
  add_library(${target}_${part} ${type} ${ARGN})
  foreach(property POSITION_INDEPENDENT_CODE UNITY_BUILD UNITY_BUILD_MODE INCLUDE_DIRECTORIES COMPILE_DEFINITIONS LINK_LIBRARIES)
    get_target_property(value ${target} ${property})
    if(value)
      set_target_properties(${target}_${part} PROPERTIES ${property} "${value}")
    endif()
  endforeach()
  add_dependencies(${target}_${part} drev_headers_stamp)
endfunction()

# drev_cold_part(<target> <sources>): those of its sources are compiled so. They are an archive of their own behind the
# target's: of two instances of a template the linker takes the first, and that shall be the fast one.
function(drev_cold_part target)
  drev_part(${target} cold STATIC ${ARGN})
  target_link_libraries(${target}_cold PRIVATE ${target})
  target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:${target}_cold>)
  drev_compile(${target}_cold REUSE_FROM drev_cold)
endfunction()
