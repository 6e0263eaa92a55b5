# drev_room(<room> <linked targets>): the library drev::<room> of the folder <room>/. Programs are not
# part of it: a model's main.cpp is its example. A room of headers alone is a library, too.
function(drev_room room)
  set(folder ${PROJECT_SOURCE_DIR}/${room})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${folder}/*.cpp)
  list(FILTER sources EXCLUDE REGEX "/main\\.cpp$")
  set(anchor ${PROJECT_BINARY_DIR}/generated/drev_${room}.cpp)
  if(NOT EXISTS ${anchor})
    file(WRITE ${anchor} "// drev::${room} has at least one source.\n")
  endif()
  add_library(drev_${room} STATIC ${sources} ${anchor})
  add_library(drev::${room} ALIAS drev_${room})
  set_target_properties(drev_${room} PROPERTIES EXPORT_NAME ${room} POSITION_INDEPENDENT_CODE ON)
  target_include_directories(drev_${room} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
                                                 $<INSTALL_INTERFACE:include/drev>)
  target_link_libraries(drev_${room} PUBLIC ${ARGN})
  # Vectors begin where a cache line does, and memory passes between drev and its user whatever
  # instructions each is compiled for.
  target_compile_definitions(drev_${room} PUBLIC EIGEN_MAX_ALIGN_BYTES=64)
  if(room STREQUAL "core")
    drev_compile(drev_core ${DREV_PRECOMPILED})
  else()
    drev_compile(drev_${room} REUSE_FROM drev_core)
  endif()
endfunction()
