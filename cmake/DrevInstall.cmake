# Installs the rooms' libraries and headers, and what find_package(drev) reads. Headers keep their room:
# #include "core/model.hpp" inside and outside. (app/CMakeLists.txt installs the command.)
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(drev_cmake_dir ${CMAKE_INSTALL_LIBDIR}/cmake/drev)

install(TARGETS drev_core drev_elements drev_solvers drev_models EXPORT drevTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT drevTargets NAMESPACE drev:: DESTINATION ${drev_cmake_dir})
foreach(room core elements solvers models)
  file(GLOB headers CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}
       ${PROJECT_SOURCE_DIR}/${room}/*.hpp ${PROJECT_SOURCE_DIR}/${room}/*/*.hpp)
  foreach(header IN LISTS headers)
    get_filename_component(folder ${header} DIRECTORY)
    install(FILES ${PROJECT_SOURCE_DIR}/${header} DESTINATION include/drev/${folder})
  endforeach()
endforeach()

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/drevConfig.cmake.in
  ${PROJECT_BINARY_DIR}/drevConfig.cmake INSTALL_DESTINATION ${drev_cmake_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/drevConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/drevConfig.cmake ${PROJECT_BINARY_DIR}/drevConfigVersion.cmake
  ${PROJECT_SOURCE_DIR}/cmake/DrevDependencies.cmake DESTINATION ${drev_cmake_dir})
