# add_cosection_library(<name> PUBLIC <target>... PRIVATE <target>...): a library of this project, to which the folders of
# pcl_cosection/ add their sources by target_sources(<name>_objects PRIVATE ...). Three targets come of it: <name>_objects,
# what is compiled; <name>, the shared library that is installed; <name>_static, the same objects for tests and programs,
# which see private headers as well. The names of other libraries of this project stand for the target of the same kind.
set(cosection_libraries "" CACHE INTERNAL "Names of this project's libraries")

function(add_cosection_library name)
  cmake_parse_arguments(PARSE_ARGV 1 link "" "" "PUBLIC;PRIVATE")
  set(libraries ${cosection_libraries})
  foreach(kind IN ITEMS objects shared static)
    foreach(dependency IN LISTS link_PUBLIC)
      if(dependency IN_LIST libraries AND kind STREQUAL "static")
        string(APPEND dependency _static)
      endif()
      list(APPEND public_${kind} ${dependency})
    endforeach()
  endforeach()

  add_library(${name}_objects OBJECT)
  set_target_properties(${name}_objects PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_compile_definitions(${name}_objects PRIVATE PCL_COSECTION_BUILDING)
  add_library(${name} SHARED $<TARGET_OBJECTS:${name}_objects>)
  add_library(pcl_cosection::${name} ALIAS ${name})
  set_target_properties(${name} PROPERTIES
    VERSION ${PROJECT_VERSION}
    SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  add_library(${name}_static STATIC $<TARGET_OBJECTS:${name}_objects>)
  foreach(target IN ITEMS ${name}_objects ${name} ${name}_static)
    target_compile_features(${target} PUBLIC cxx_std_17)
    target_include_directories(${target} PUBLIC
      "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>"
      "$<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include>"
      "$<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>")
  endforeach()
  target_link_libraries(${name}_objects PUBLIC ${public_objects} PRIVATE ${link_PRIVATE} pcl_cosection_build_settings)
  target_link_libraries(${name} PUBLIC ${public_shared} PRIVATE ${link_PRIVATE} pcl_cosection_build_settings)
  target_link_libraries(${name}_static PUBLIC ${public_static} PRIVATE ${link_PRIVATE} pcl_cosection_build_settings)
  set(cosection_libraries ${libraries} ${name} CACHE INTERNAL "Names of this project's libraries")
endfunction()
