# Debian packages by CPack, one for each component of the installation: `cmake --preset package`, then
# `cmake --build --preset package`. What each of them holds is said by COMPONENT in the install () rules.

if(NOT CMAKE_INSTALL_PREFIX STREQUAL "/usr")
  message(FATAL_ERROR "Packages install to /usr: configure with `cmake --preset package`, or -DCMAKE_INSTALL_PREFIX=/usr")
endif()

# --- What all of them say --------------------------------------------------------------------------------------------
set(PCL_COSECTION_PACKAGE_MAINTAINER "the pcl_cosection authors <maintainers@pcl-cosection.invalid>" CACHE STRING
  "Who answers for the packages, with an address of electronic mail")

set(CPACK_GENERATOR DEB)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_PACKAGE_NAME pcl-cosection)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "") # each package has one of its own
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS # whatever the umask says
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY ">=")
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "${PCL_COSECTION_PACKAGE_MAINTAINER}")
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS "${CMAKE_LIBRARY_OUTPUT_DIRECTORY}") # one package's library needs another's
set(CPACK_DEBIAN_PACKAGE_SOURCE pcl-cosection)
set(CPACK_POST_BUILD_SCRIPTS "${PROJECT_SOURCE_DIR}/cmake/packages/use_triggers.cmake")

# A build for one release of Debian depends on its libraries, so that the release is in the version.
set(release 1)
if(EXISTS /etc/os-release)
  file(STRINGS /etc/os-release system REGEX "^VERSION_ID=")
  string(REGEX MATCH "[0-9.]+" system "${system}")
  if(system)
    string(APPEND release "+deb${system}")
  endif()
endif()
set(CPACK_DEBIAN_PACKAGE_RELEASE ${release})
set(package_version "${PROJECT_VERSION}-${release}")

set(packaging_dir "${PROJECT_BINARY_DIR}/packages")
configure_file(cmake/packages/changelog.in "${packaging_dir}/changelog.Debian" @ONLY)
execute_process(COMMAND gzip -9 --no-name --force --keep "${packaging_dir}/changelog.Debian" COMMAND_ERROR_IS_FATAL ANY)

# --- The packages ----------------------------------------------------------------------------------------------------
# add_package(<component> <name> <section> <summary> <text>): a package of a component, with what every package has.
function(add_package component name section summary text)
  string(TOUPPER "${component}" variable)
  set(CPACK_DEBIAN_${variable}_PACKAGE_NAME ${name} PARENT_SCOPE)
  set(CPACK_DEBIAN_${variable}_PACKAGE_SECTION ${section} PARENT_SCOPE)
  set(CPACK_DEBIAN_${variable}_DESCRIPTION "${summary}\n${text}" PARENT_SCOPE)
  set(package_components ${package_components} ${component} PARENT_SCOPE)
  set(doc_dir "${CMAKE_INSTALL_DATADIR}/doc/${name}")
  install(FILES "${PROJECT_SOURCE_DIR}/cmake/packages/copyright" "${packaging_dir}/changelog.Debian.gz"
    DESTINATION "${doc_dir}"
    COMPONENT ${component})
  if(EXISTS "${PROJECT_SOURCE_DIR}/cmake/packages/${component}.lintian-overrides")
    install(FILES "${PROJECT_SOURCE_DIR}/cmake/packages/${component}.lintian-overrides"
      DESTINATION "${CMAKE_INSTALL_DATADIR}/lintian/overrides"
      RENAME ${name}
      COMPONENT ${component})
  endif()
endfunction()

set(method_text "pcl_cosection completes the surfaces of objects that a depth camera saw only in
part, as closed meshes that fit the space around them: what a ray crossed is
free, and what another object fills is taken (Co-Section, CVPR 2020).
")
set(soversion ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(package_components "")

add_package(library libpcl-cosection${soversion} libs
  "completes hidden surfaces in point clouds - shared libraries"
  "${method_text}
This package has the libraries: the method, networks that segment, and
sequences of images.")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA "${PROJECT_SOURCE_DIR}/cmake/packages/ldconfig/triggers")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_RECOMMENDS pcl-cosection-data) # the method does without the network, if less well

add_package(development libpcl-cosection-dev libdevel
  "completes hidden surfaces in point clouds - development files"
  "${method_text}
This package has the headers, and what find_package(pcl_cosection) of CMake
needs.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libeigen3-dev, libpcl-dev")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS "pcl-cosection-doc")
set(CPACK_COMPONENT_DEVELOPMENT_DEPENDS library)

add_package(data pcl-cosection-data science
  "completes hidden surfaces in point clouds - network and samples"
  "${method_text}
This package has the network that guesses hidden sides, and the input of the
demonstration.")
set(CPACK_DEBIAN_DATA_PACKAGE_ARCHITECTURE all)

add_package(documentation pcl-cosection-doc doc
  "completes hidden surfaces in point clouds - documentation"
  "${method_text}
This package has the manual: the method, its results, the programs, tutorials
and examples.")
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_ARCHITECTURE all)
# With the folders of the source, so that links are right.
set(doc_dir "${CMAKE_INSTALL_DATADIR}/doc/pcl-cosection-doc/manual")
install(FILES README.md CHANGES.md CITATION.cff DESTINATION "${doc_dir}" COMPONENT documentation)
install(FILES models/README.md DESTINATION "${doc_dir}/models" COMPONENT documentation)
install(DIRECTORY python/examples DESTINATION "${doc_dir}/python" COMPONENT documentation FILES_MATCHING PATTERN "*.py")
install(DIRECTORY doc/ DESTINATION "${doc_dir}/doc" COMPONENT documentation
  FILES_MATCHING PATTERN "*.md" PATTERN "*.cpp" PATTERN "*.png" PATTERN "*.svg" PATTERN "*.jpg"
  PATTERN demo EXCLUDE)

if(TARGET pcl_cosection_visualization)
  add_package(visualization libpcl-cosection-visualization${soversion} libs
    "completes hidden surfaces in point clouds - library of the window"
    "${method_text}
This package has the library of the window, which needs X11 and OpenGL.")
  set(CPACK_DEBIAN_VISUALIZATION_PACKAGE_CONTROL_EXTRA "${PROJECT_SOURCE_DIR}/cmake/packages/ldconfig/triggers")
  set(CPACK_COMPONENT_VISUALIZATION_DEPENDS library)
  add_package(visualization_development libpcl-cosection-visualization-dev libdevel
    "completes hidden surfaces in point clouds - development files of the window"
    "${method_text}
This package has the headers of the window, and what find_package(pcl_cosection
COMPONENTS visualization) of CMake needs.")
  set(CPACK_COMPONENT_VISUALIZATION_DEVELOPMENT_DEPENDS development visualization)
endif()

if(PCL_COSECTION_BUILD_TOOLS)
  add_package(tools pcl-cosection science
    "completes hidden surfaces in point clouds - programs"
    "${method_text}
This package has the programs: they find and complete the objects of views and
of RGB-D sequences, show and evaluate the results, and make rigid bodies for
simulators of them.")
  set(CPACK_DEBIAN_TOOLS_PACKAGE_SUGGESTS pcl-cosection-doc)
  set(CPACK_COMPONENT_TOOLS_DEPENDS data)
endif()

# The module for Python is built where it is asked for.
get_cmake_property(components COMPONENTS)
if(python IN_LIST components)
  find_package(Python3 REQUIRED COMPONENTS Interpreter)
  math(EXPR next_minor "${Python3_VERSION_MINOR} + 1")
  add_package(python python3-pcl-cosection python
    "completes hidden surfaces in point clouds - module for Python"
    "${method_text}
This package has the module pcl_cosection for Python.")
  string(CONCAT CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS # what is compiled is for this one
    "python3 (>= ${Python3_VERSION_MAJOR}.${Python3_VERSION_MINOR}~), "
    "python3 (<< ${Python3_VERSION_MAJOR}.${next_minor}), python3-numpy")
  # To run the programs on many inputs at once.
  set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "pcl-cosection, python3-distributed")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA # what Python compiles is removed with it
    "${PROJECT_SOURCE_DIR}/cmake/packages/python/postinst" "${PROJECT_SOURCE_DIR}/cmake/packages/python/prerm")
  set(CPACK_COMPONENT_PYTHON_DEPENDS data)
endif()

set(CPACK_COMPONENTS_ALL ${package_components})
include(CPack)
