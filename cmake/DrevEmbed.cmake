# drev_embed(<target> <file> <symbol>)
#
# Builds a text file (CSV, TOML; up to some 100 kB) into a target, so that a program finds its data
# installed or not, and from any working directory. The text is, byte for byte,
#
#   namespace drev::data { extern const std::string_view <symbol>; }
#
# which a source that reads it declares like this (with #include <string_view>). It is generated at
# build time, again whenever the file changes. The view ends in a zero byte past its last character.
#
# models/CMakeLists.txt does this for every models/<name>/data/*.csv and *.toml, as <name>_<file>:
# models/camshaft/data/cams.csv is drev::data::camshaft_cams.
set(DREV_EMBED_SCRIPT ${CMAKE_CURRENT_LIST_DIR}/embed.cmake)
function(drev_embed target file symbol)
  if(NOT symbol MATCHES "^[A-Za-z_][A-Za-z0-9_]*$")
    message(FATAL_ERROR "drev_embed: '${symbol}' is not a C++ name")
  endif()
  get_filename_component(file ${file} ABSOLUTE)
  set(output ${PROJECT_BINARY_DIR}/generated/data/${symbol}.cpp)
  add_custom_command(OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DFILE=${file} -DSYMBOL=${symbol} -DOUTPUT=${output}
            -P ${DREV_EMBED_SCRIPT}
    DEPENDS ${file} ${DREV_EMBED_SCRIPT} COMMENT "Embedding ${symbol}" VERBATIM)
  # A target of another folder takes the source, but knows its rule only through a target of this one.
  add_custom_target(drev_data_${symbol} DEPENDS ${output})
  set_source_files_properties(${output} TARGET_DIRECTORY ${target} PROPERTIES
    GENERATED ON SKIP_PRECOMPILE_HEADERS ON)
  target_sources(${target} PRIVATE ${output})
  add_dependencies(${target} drev_data_${symbol})
endfunction()
