# Installs the library, its headers and the files that find_package(pcl_cosection) needs.

include(CMakePackageConfigHelpers)

set(package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/pcl_cosection")

set(libraries pcl_cosection pcl_cosection_dnn pcl_cosection_rgbd)
if(TARGET pcl_cosection_visualization)
  list(APPEND libraries pcl_cosection_visualization)
endif()
install(TARGETS ${libraries}
  EXPORT pcl_cosection-targets
  LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}"
  ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}"
  RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}")
install(DIRECTORY "${PROJECT_SOURCE_DIR}/include/" "${PROJECT_BINARY_DIR}/include/"
  DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}"
  FILES_MATCHING PATTERN "*.h")

install(EXPORT pcl_cosection-targets
  NAMESPACE pcl_cosection::
  DESTINATION "${package_dir}")
configure_package_config_file("${PROJECT_SOURCE_DIR}/cmake/pcl_cosection-config.cmake.in"
  "${PROJECT_BINARY_DIR}/pcl_cosection-config.cmake"
  INSTALL_DESTINATION "${package_dir}")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/pcl_cosection-config-version.cmake"
  COMPATIBILITY SameMinorVersion)
install(FILES
    "${PROJECT_BINARY_DIR}/pcl_cosection-config.cmake"
    "${PROJECT_BINARY_DIR}/pcl_cosection-config-version.cmake"
  DESTINATION "${package_dir}")

install(FILES "${PROJECT_SOURCE_DIR}/package.xml" DESTINATION "${CMAKE_INSTALL_DATADIR}/pcl_cosection")
install(FILES "${PROJECT_SOURCE_DIR}/models/completion.onnx" DESTINATION "${CMAKE_INSTALL_DATADIR}/pcl_cosection")
# Where programs in the build tree look for it.
configure_file("${PROJECT_SOURCE_DIR}/models/completion.onnx"
  "${PROJECT_BINARY_DIR}/share/pcl_cosection/completion.onnx" COPYONLY)
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION "${CMAKE_INSTALL_DOCDIR}")
