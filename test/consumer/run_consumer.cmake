# Installs the build in BUILD_DIR below WORK_DIR, builds the project in this folder against what was
# installed, and runs it; installs it in part, and asks which components are found. Started by CTest with -D for each of
#   SOURCE_DIR  BUILD_DIR  WORK_DIR  GENERATOR  CXX_COMPILER  CXX_LAUNCHER  BUILD_TYPE  VERSION  TOOL  PYTHON  VIEWER

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
  foreach(suffix IN ITEMS "" _evaluate _export _fusion _report _segment _simulate _viewer)
    run("${WORK_DIR}/prefix/${TOOL}${suffix}" --version)
    if(NOT run_output MATCHES "${VERSION}")
      message(FATAL_ERROR "the installed program ${TOOL}${suffix} says '${run_output}', not ${VERSION}")
    endif()
  endforeach()
endif()

# The installed module finds the installed network.
file(GLOB module "${WORK_DIR}/prefix/lib/python3/dist-packages/pcl_cosection/__init__.py")
if(PYTHON AND module)
  run("${CMAKE_COMMAND}" -E env "PYTHONPATH=${WORK_DIR}/prefix/lib/python3/dist-packages"
    "${PYTHON}" "${CMAKE_CURRENT_LIST_DIR}/../packages_python.py")
  if(NOT run_output MATCHES "network: ${WORK_DIR}/prefix/share/pcl_cosection/completion.onnx")
    message(FATAL_ERROR "the installed Python module does without the network:\n${run_output}")
  endif()
endif()

# --- Components ------------------------------------------------------------------------------------------------------
# Configures the project in components/, which asks for components of what is installed at <prefix>.
macro(request_components prefix request)
  execute_process(COMMAND "${CMAKE_COMMAND}"
    -G "${GENERATOR}" -S "${CMAKE_CURRENT_LIST_DIR}/components" -B "${WORK_DIR}/components"
    "-DCMAKE_PREFIX_PATH=${prefix}"
    "-Dpcl_cosection_DIR=NOTFOUND" # look again
    "-DCMAKE_CXX_COMPILER=${CXX_COMPILER}"
    "-DREQUEST=${request}"
    RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  string(REGEX REPLACE "[ \n]+" " " output "${output}") # CMake breaks the lines of messages
endmacro()

function(expect_components prefix request is_found components)
  request_components("${prefix}" "${request}")
  set(targets "${components}")
  if(NOT is_found)
    set(targets "")
  endif()
  string(REPLACE "  " " " expected "pcl_cosection: ${is_found} -- found: ${components} -- targets: ${targets}")
  if(NOT result EQUAL 0 OR NOT output MATCHES "${expected}")
    message(FATAL_ERROR "find_package (pcl_cosection ${request}) in ${prefix}: not ${is_found}, ${components}:\n${output}")
  endif()
endfunction()

function(expect_error prefix request message)
  request_components("${prefix}" "${request}")
  if(result EQUAL 0 OR NOT output MATCHES "${message}")
    message(FATAL_ERROR "find_package (pcl_cosection ${request}) in ${prefix}: not '${message}':\n${output}")
  endif()
endfunction()

set(complete "${WORK_DIR}/prefix")
set(all_components core dnn rgbd)
if(VIEWER)
  list(APPEND all_components visualization)
endif()
expect_components("${complete}" "REQUIRED" 1 "${all_components}")
expect_components("${complete}" "REQUIRED COMPONENTS ${all_components}" 1 "${all_components}")
expect_components("${complete}" "REQUIRED COMPONENTS core OPTIONAL_COMPONENTS nonsense" 1 "${all_components}")
expect_components("${complete}" "QUIET COMPONENTS core nonsense" 0 "${all_components}")
expect_error("${complete}" "REQUIRED COMPONENTS core nonsense"
  "has no component 'nonsense', but core, dnn, rgbd, visualization")

# The headers of the window are there, its library is not.
set(partial "${WORK_DIR}/partial")
foreach(component IN ITEMS library development visualization_development)
  run("${CMAKE_COMMAND}" --install "${BUILD_DIR}" --prefix "${partial}" --component ${component})
endforeach()
expect_components("${partial}" "REQUIRED" 1 "core;dnn;rgbd")
expect_components("${partial}" "REQUIRED COMPONENTS rgbd OPTIONAL_COMPONENTS visualization" 1 "core;dnn;rgbd")
expect_components("${partial}" "QUIET COMPONENTS visualization" 0 "core;dnn;rgbd")
expect_error("${partial}" "REQUIRED COMPONENTS dnn visualization" "component 'visualization' of pcl_cosection is not installed")

# Only what CMake needs is there.
set(empty "${WORK_DIR}/empty")
run("${CMAKE_COMMAND}" --install "${BUILD_DIR}" --prefix "${empty}" --component development)
expect_components("${empty}" "QUIET" 0 "")
expect_error("${empty}" "REQUIRED" "component 'core' of pcl_cosection is not installed")
message(STATUS "components: found where they are installed")
