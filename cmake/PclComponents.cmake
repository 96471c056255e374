# find_pcl_components(<version> <component>...)
#
# Find PCL and set PCL_<component>_TARGET to the imported target of each component, whether this PCL
# calls it PCL::<component> or pcl_<component>. PCL_LIBRARIES would link all of VTK and the drivers
# of every camera.
macro(find_pcl_components version)
  find_package(PCL ${version} QUIET REQUIRED COMPONENTS ${ARGN})
  foreach(component IN ITEMS ${ARGN})
    if(TARGET PCL::${component})
      set(PCL_${component}_TARGET PCL::${component})
    elseif(TARGET pcl_${component})
      set(PCL_${component}_TARGET pcl_${component})
    else()
      message(FATAL_ERROR "PCL ${PCL_VERSION} has no component ${component}")
    endif()
  endforeach()
endmacro()
