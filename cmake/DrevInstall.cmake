# Installs the libraries of the rooms, the public headers, and what find_package(drev) and pkg-config read.
# (app/CMakeLists.txt installs the command, and the
# libraries of model files and reports.)
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(drev_cmake_dir ${CMAKE_INSTALL_LIBDIR}/cmake/drev)
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME development)

install(TARGETS drev_core drev_elements drev_solvers drev_models drev_advice EXPORT drevTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT drevTargets NAMESPACE drev:: DESTINATION ${drev_cmake_dir})
foreach(header IN LISTS DREV_PUBLIC_HEADERS)
  get_filename_component(folder ${header} DIRECTORY)
  install(FILES ${PROJECT_SOURCE_DIR}/${header} DESTINATION include/drev/${folder})
endforeach()
install(FILES ${DREV_HEADERS_STAMP} DESTINATION include/drev)

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/drevConfig.cmake.in
  ${PROJECT_BINARY_DIR}/drevConfig.cmake INSTALL_DESTINATION ${drev_cmake_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/drevConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/drevConfig.cmake ${PROJECT_BINARY_DIR}/drevConfigVersion.cmake
  ${PROJECT_SOURCE_DIR}/cmake/DrevDependencies.cmake DESTINATION ${drev_cmake_dir})

# Relative to the file's own place, so that an installed tree can be moved.
file(RELATIVE_PATH drev_pc_to_prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
string(REGEX REPLACE "/$" "" drev_pc_to_prefix ${drev_pc_to_prefix})
foreach(package drev drev-report)
  configure_file(${PROJECT_SOURCE_DIR}/cmake/${package}.pc.in ${PROJECT_BINARY_DIR}/${package}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/${package}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endforeach()
