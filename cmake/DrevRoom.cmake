# Public headers are included as <drev/core/model.hpp>, inside as outside: the build tree's include/drev holds a
# link to each of those in public_headers.txt, and to the parts of them in public_parts.txt, in the folders that they
# are installed in.
set(DREV_PUBLIC_HEADERS "")
foreach(list public_headers public_parts)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/${list}.txt)
  file(STRINGS ${CMAKE_CURRENT_LIST_DIR}/${list}.txt listed REGEX "^[^#]")
  list(APPEND DREV_PUBLIC_HEADERS ${listed})
endforeach()
file(GLOB linked ${PROJECT_BINARY_DIR}/include/drev/*)
list(REMOVE_ITEM linked ${PROJECT_BINARY_DIR}/include/drev/headers_stamp.hpp)
if(linked)
  file(REMOVE_RECURSE ${linked})
endif()
foreach(header IN LISTS DREV_PUBLIC_HEADERS)
  get_filename_component(folder ${header} DIRECTORY)
  file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/include/drev/${folder})
  file(CREATE_LINK ${PROJECT_SOURCE_DIR}/${header} ${PROJECT_BINARY_DIR}/include/drev/${header} SYMBOLIC)
endforeach()
# <drev/headers_stamp.hpp>: made again where one of them changes.
set(DREV_HEADERS_STAMP ${PROJECT_BINARY_DIR}/include/drev/headers_stamp.hpp)
list(TRANSFORM DREV_PUBLIC_HEADERS PREPEND ${PROJECT_SOURCE_DIR}/ OUTPUT_VARIABLE stamped)
add_custom_command(OUTPUT ${DREV_HEADERS_STAMP}
  COMMAND ${CMAKE_COMMAND} -DROOT=${PROJECT_SOURCE_DIR} -DFILE=${DREV_HEADERS_STAMP} -P ${CMAKE_CURRENT_LIST_DIR}/headers_stamp.cmake
  DEPENDS ${stamped} ${CMAKE_CURRENT_LIST_DIR}/headers_stamp.cmake VERBATIM)
add_custom_target(drev_headers_stamp DEPENDS ${DREV_HEADERS_STAMP})

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
                                                 $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include>
                                                 $<INSTALL_INTERFACE:include>)
  target_link_libraries(drev_${room} PUBLIC ${ARGN})
  # Vectors begin where a cache line does, and memory passes between drev and its user whatever
  # instructions each is compiled for.
  target_compile_definitions(drev_${room} PUBLIC EIGEN_MAX_ALIGN_BYTES=64)
  add_dependencies(drev_${room} drev_headers_stamp)
  if(room STREQUAL "core")
    drev_compile(drev_core ${DREV_PRECOMPILED})
  elseif(room MATCHES "models|advice")
    drev_compile(drev_${room} REUSE_FROM ${DREV_COLD})
  else()
    drev_compile(drev_${room} REUSE_FROM drev_core)
  endif()
endfunction()
