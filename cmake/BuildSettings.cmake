# How this project compiles its own code. Nothing here is exported.

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Debug, Release, RelWithDebInfo or MinSizeRel" FORCE)
endif()

set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/bin")
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/lib")

# The installed program finds the library beside it, wherever both are moved.
if(UNIX AND NOT APPLE)
  set(CMAKE_INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}")
endif()

find_program(CCACHE_PROGRAM ccache)
mark_as_advanced(CCACHE_PROGRAM)
if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER "${CCACHE_PROGRAM}")
endif()

# Linked by every target of this project. PCL's components and VTK's modules name libraries that
# we do not use; --as-needed keeps them out of our files.
add_library(pcl_cosection_build_settings INTERFACE)
target_compile_options(pcl_cosection_build_settings INTERFACE -Wall -Wextra)
# Private headers are included as "pcl_cosection/<room>/<file>.h".
target_include_directories(pcl_cosection_build_settings INTERFACE "${PROJECT_SOURCE_DIR}")
if(UNIX AND NOT APPLE)
  target_link_options(pcl_cosection_build_settings INTERFACE -Wl,--as-needed)
  # Clang links its sanitizers into programs only, so that they are undefined in a library.
  if(NOT (PCL_COSECTION_SANITIZE AND CMAKE_CXX_COMPILER_ID MATCHES "Clang"))
    target_link_options(pcl_cosection_build_settings INTERFACE -Wl,--no-undefined)
  endif()
endif()

if(PCL_COSECTION_SANITIZE)
  # Functions compiled for several processors are chosen by the loader before the sanitizers are
  # ready, so there is one version only.
  # Eigen allocates otherwise when it sees a sanitizer, and PCL's libraries, which allocate what we free, do not.
  target_compile_definitions(pcl_cosection_build_settings INTERFACE
    PCL_COSECTION_NO_MULTIVERSIONING
    EIGEN_MALLOC_ALREADY_ALIGNED=1)
  set(sanitizers address,undefined)
  if(PCL_COSECTION_SANITIZE STREQUAL "thread")
    set(sanitizers thread)
  endif()
  target_compile_options(pcl_cosection_build_settings INTERFACE
    -fsanitize=${sanitizers} -fno-sanitize-recover=all -fno-omit-frame-pointer -g1)
  target_link_options(pcl_cosection_build_settings INTERFACE -fsanitize=${sanitizers})
endif()

# compile_several_files_at_a_time(<target>): for tests and what programs share, never for what is installed. Who sets
# CMAKE_UNITY_BUILD has what it says.
function(compile_several_files_at_a_time target)
  if(NOT PCL_COSECTION_UNITY_BUILD OR DEFINED CMAKE_UNITY_BUILD)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON)
  if(NOT DEFINED CMAKE_UNITY_BUILD_BATCH_SIZE)
    set_target_properties(${target} PROPERTIES UNITY_BUILD_BATCH_SIZE 6)
  endif()
  # GCC takes a test whose fixture is in an anonymous namespace for one of a header, as its file is an included one.
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endfunction()

if(PCL_COSECTION_FUZZER)
  if(NOT (PCL_COSECTION_SANITIZE AND CMAKE_CXX_COMPILER_ID MATCHES "Clang"))
    message(FATAL_ERROR "PCL_COSECTION_FUZZER needs Clang (-DCMAKE_CXX_COMPILER=clang++) and PCL_COSECTION_SANITIZE=ON")
  endif()
  target_compile_options(pcl_cosection_build_settings INTERFACE -fsanitize=fuzzer-no-link) # counts what is reached
endif()
