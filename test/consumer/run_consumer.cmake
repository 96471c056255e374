# Installs the build in BUILD_DIR below WORK_DIR, builds the project in this folder against what was
# installed, and runs it. Started by CTest with -D for each of
#   SOURCE_DIR  BUILD_DIR  WORK_DIR  GENERATOR  CXX_COMPILER  CXX_LAUNCHER  BUILD_TYPE  VERSION  TOOL  VIEWER

# Fails with what the command said unless it succeeds.
function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    list(JOIN ARGV " " command)
    message(FATAL_ERROR "${command}: ${result}\n${output}")
  endif()
  set(run_output "${output}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE "${WORK_DIR}")
# The package must not depend on where it was meant to be installed.
run("${CMAKE_COMMAND}" --install "${BUILD_DIR}" --prefix "${WORK_DIR}/staged")
file(RENAME "${WORK_DIR}/staged" "${WORK_DIR}/prefix")

# What is installed is the public headers, and no other.
file(GLOB_RECURSE public_headers RELATIVE "${SOURCE_DIR}/include" "${SOURCE_DIR}/include/*")
list(APPEND public_headers pcl/cosection/version.h)
file(GLOB_RECURSE installed_headers RELATIVE "${WORK_DIR}/prefix/include" "${WORK_DIR}/prefix/include/*")
list(SORT public_headers)
list(SORT installed_headers)
if(NOT installed_headers STREQUAL public_headers)
  message(FATAL_ERROR "installed:\n${installed_headers}\ninstead of\n${public_headers}")
endif()

run("${CMAKE_COMMAND}"
  -G "${GENERATOR}" -S "${CMAKE_CURRENT_LIST_DIR}" -B "${WORK_DIR}/build"
  "-DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix"
  "-DCMAKE_CXX_COMPILER=${CXX_COMPILER}"
  "-DCMAKE_CXX_COMPILER_LAUNCHER=${CXX_LAUNCHER}"
  "-DCMAKE_BUILD_TYPE=${BUILD_TYPE}")
run("${CMAKE_COMMAND}" --build "${WORK_DIR}/build")
set(programs consumer detect_objects reconstruct_sphere remove_ghost simulate_sphere)
if(VIEWER)
  list(APPEND programs draw_scene)
endif()
foreach(program IN LISTS programs)
  run("${WORK_DIR}/build/${program}")
  message(STATUS "${run_output}")
endforeach()

if(TOOL)
  foreach(suffix IN ITEMS "" _evaluate _report _segment _simulate _viewer)
    run("${WORK_DIR}/prefix/${TOOL}${suffix}" --version)
    if(NOT run_output MATCHES "${VERSION}")
      message(FATAL_ERROR "the installed program ${TOOL}${suffix} says '${run_output}', not ${VERSION}")
    endif()
  endforeach()
endif()
