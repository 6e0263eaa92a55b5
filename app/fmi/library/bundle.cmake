# Copies the libraries that drev_fmu.so needs beside it, so that an FMU holds them: all but those that every Linux of
# the same kind has.   cmake -DLIBRARY=drev_fmu.so -P bundle.cmake
get_filename_component(folder ${LIBRARY} DIRECTORY)
file(GLOB old ${folder}/*.so.*)
if(old)
  file(REMOVE ${old})
endif()
file(GET_RUNTIME_DEPENDENCIES LIBRARIES ${LIBRARY} RESOLVED_DEPENDENCIES_VAR found UNRESOLVED_DEPENDENCIES_VAR missing
  PRE_EXCLUDE_REGEXES "^ld-linux" "^lib(c|m|dl|pthread|gcc_s)\\.so")
if(missing)
  message(FATAL_ERROR "drev_fmu.so needs ${missing}")
endif()
foreach(library IN LISTS found)
  # One file a library, under the name that it is asked for by.
  get_filename_component(name ${library} NAME)
  file(REAL_PATH ${library} real)
  configure_file(${real} ${folder}/${name} COPYONLY)
endforeach()
