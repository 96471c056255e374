# Installs the libraries, their headers and the files that find_package(pcl_cosection) needs. The components are what
# cmake/Packages.cmake makes packages of; `cmake --install` without a component installs all of them.

include(CMakePackageConfigHelpers)

set(package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/pcl_cosection")

# install_library(<name> <part> <component> <development component>): <part> is what find_package calls it. Each part has
# an export of its own, so that what is not installed is missed by nobody but those who ask for it.
function(install_library name part component development)
  install(TARGETS ${name}
    EXPORT pcl_cosection-${part}-targets
    LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT ${component} NAMELINK_COMPONENT ${development}
    ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT ${development}
    RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT ${component})
  install(EXPORT pcl_cosection-${part}-targets
    NAMESPACE pcl_cosection::
    DESTINATION "${package_dir}"
    COMPONENT ${development})
endfunction()
install_library(pcl_cosection core library development)
install_library(pcl_cosection_dnn dnn library development)
install_library(pcl_cosection_rgbd rgbd library development)
if(TARGET pcl_cosection_visualization)
  install_library(pcl_cosection_visualization visualization visualization visualization_development)
endif()

set(window_headers pcl/cosection/visualization)
install(DIRECTORY "${PROJECT_SOURCE_DIR}/include/" "${PROJECT_BINARY_DIR}/include/"
  DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}"
  COMPONENT development
  FILES_MATCHING PATTERN "*.h"
  PATTERN "${window_headers}" EXCLUDE)
install(DIRECTORY "${PROJECT_SOURCE_DIR}/include/${window_headers}/"
  DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/${window_headers}"
  COMPONENT visualization_development
  FILES_MATCHING PATTERN "*.h")

configure_package_config_file("${PROJECT_SOURCE_DIR}/cmake/pcl_cosection-config.cmake.in"
  "${PROJECT_BINARY_DIR}/pcl_cosection-config.cmake"
  INSTALL_DESTINATION "${package_dir}"
  PATH_VARS CMAKE_INSTALL_LIBDIR)
write_basic_package_version_file("${PROJECT_BINARY_DIR}/pcl_cosection-config-version.cmake"
  COMPATIBILITY SameMinorVersion)
install(FILES
    "${PROJECT_BINARY_DIR}/pcl_cosection-config.cmake"
    "${PROJECT_BINARY_DIR}/pcl_cosection-config-version.cmake"
  DESTINATION "${package_dir}"
  COMPONENT development)

set(data_dir "${CMAKE_INSTALL_DATADIR}/pcl_cosection")
install(FILES "${PROJECT_SOURCE_DIR}/package.xml" DESTINATION "${data_dir}" COMPONENT development)
install(FILES "${PROJECT_SOURCE_DIR}/models/completion.onnx" DESTINATION "${data_dir}" COMPONENT data)
install(FILES "${PROJECT_SOURCE_DIR}/doc/demo/table.pcd" "${PROJECT_SOURCE_DIR}/doc/demo/playground.json"
  DESTINATION "${data_dir}/demo"
  COMPONENT data)
# Where programs in the build tree look for it.
configure_file("${PROJECT_SOURCE_DIR}/models/completion.onnx"
  "${PROJECT_BINARY_DIR}/share/pcl_cosection/completion.onnx" COPYONLY)
# Packages have a file of copyrights in its place.
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT licence)
