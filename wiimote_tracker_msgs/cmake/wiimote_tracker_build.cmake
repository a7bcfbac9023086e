# How the packages of the tracker are built. find_package(catkin ... wiimote_tracker_msgs) includes
# this file; a package then calls wiimote_tracker_package() and uses the functions below it.

set(WIIMOTE_TRACKER_CMAKE_DIR ${CMAKE_CURRENT_LIST_DIR})

# Build type, language, warnings and sanitizers of the package. Call it after find_package(catkin).
macro(wiimote_tracker_package)
  option(WIIMOTE_TRACKER_WERROR "Treat compiler warnings as errors" OFF)
  set(WIIMOTE_TRACKER_SANITIZE "" CACHE STRING "Sanitizers: address,undefined or thread")
  # Users need neither gtest nor rostest.
  if(CATKIN_ENABLE_TESTING)
    find_package(rostest QUIET)
    if(NOT GTEST_FOUND OR NOT rostest_FOUND)
      message(STATUS "No gtest or no rostest: ${PROJECT_NAME} is built without its tests")
      set(CATKIN_ENABLE_TESTING OFF)
    endif()
  endif()
  if(NOT CMAKE_BUILD_TYPE)
    set(CMAKE_BUILD_TYPE RelWithDebInfo)
  endif()
  set(CMAKE_CXX_STANDARD 17)
  set(CMAKE_CXX_STANDARD_REQUIRED ON)
  set(CMAKE_CXX_EXTENSIONS OFF)
  # Several sources in one compiler run: parsing Eigen and ROS takes more time than our own code.
  option(WIIMOTE_TRACKER_UNITY "Compile in groups, with a precompiled header" ON)
  set(CMAKE_UNITY_BUILD ${WIIMOTE_TRACKER_UNITY})
  set(CMAKE_UNITY_BUILD_BATCH_SIZE 12)
  add_compile_options(-fPIC)  # in programs, too: they share the precompiled header
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    # GCC looks for garbage above 128 MB, which the precompiled header almost fills.
    add_compile_options(--param=ggc-min-heapsize=600000)  # kB
  endif()
  add_compile_options(-Wall -Wextra -Wpedantic)
  if(WIIMOTE_TRACKER_WERROR)
    add_compile_options(-Werror)
  endif()
  if(WIIMOTE_TRACKER_SANITIZE)
    # The checks "null" and "alignment" double the compile time. The address sanitizer stops at a
    # null access, and an assertion of Eigen at misaligned memory.
    add_compile_options(-fsanitize=${WIIMOTE_TRACKER_SANITIZE} -fno-sanitize=null,alignment
      -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
    set(CMAKE_EXE_LINKER_FLAGS "${CMAKE_EXE_LINKER_FLAGS} -fsanitize=${WIIMOTE_TRACKER_SANITIZE}")
    set(CMAKE_SHARED_LINKER_FLAGS
      "${CMAKE_SHARED_LINKER_FLAGS} -fsanitize=${WIIMOTE_TRACKER_SANITIZE}")
  endif()
  find_package(Eigen3 QUIET)
  if(WIIMOTE_TRACKER_UNITY AND EIGEN3_FOUND AND NOT CMAKE_VERSION VERSION_LESS 3.16
      AND NOT TARGET wiimote_tracker_precompiled)
    add_subdirectory(${WIIMOTE_TRACKER_CMAKE_DIR}/precompiled
      ${CMAKE_CURRENT_BINARY_DIR}/precompiled)
  endif()
  wiimote_tracker_import_libraries()
endmacro()

# Splits catkin_LIBRARIES. The libraries of the tracker's other packages can be linked by name, as
# the targets that they are in a common build and as imported ones when they are installed. All
# others are in ROS_LIBRARIES; the keyword ROS below links them.
macro(wiimote_tracker_import_libraries)
  set(ROS_LIBRARIES ${catkin_LIBRARIES})
  list(FILTER ROS_LIBRARIES EXCLUDE REGEX "wiimote_tracker_")
  foreach(library ${catkin_LIBRARIES})
    if(library MATCHES "/lib(wiimote_tracker_[a-z_]+)\\.so$" AND NOT TARGET ${CMAKE_MATCH_1})
      add_library(${CMAKE_MATCH_1} SHARED IMPORTED)
      set_target_properties(${CMAKE_MATCH_1} PROPERTIES IMPORTED_LOCATION ${library})
    endif()
  endforeach()
endmacro()

# In the functions below, ROS links what find_package(catkin) found, and LIBRARIES everything else.
macro(_wiimote_tracker_parse)
  cmake_parse_arguments(ARG "ROS;STATIC" "" "LIBRARIES" ${ARGN})
  set(sources ${ARG_UNPARSED_ARGUMENTS})
endmacro()
macro(_wiimote_tracker_link name precompiled)
  if(TARGET ${precompiled})
    target_precompile_headers(${name} REUSE_FROM ${precompiled})
  endif()
  target_link_libraries(${name} ${ARG_LIBRARIES})
  if(ARG_ROS)
    add_dependencies(${name} ${catkin_EXPORTED_TARGETS})
    target_link_libraries(${name} ${ROS_LIBRARIES})
  endif()
endmacro()
macro(_wiimote_tracker_link_test name)
  # GCC takes a fifth less time than with -O2, but then warns falsely of Eigen's variables. The
  # libraries under test stay as users run them.
  target_compile_options(${name} PRIVATE -O1
    $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  target_include_directories(${name} PRIVATE ${WIIMOTE_TRACKER_CMAKE_DIR}/../test_support)
  _wiimote_tracker_link(${name} wiimote_tracker_precompiled_for_tests)
endmacro()

# wiimote_tracker_add_library(NAME SOURCE... [ROS] [STATIC] [LIBRARIES LIBRARY...])
# Adds a library and installs it. A static one, for a program and its tests, is not installed.
function(wiimote_tracker_add_library name)
  _wiimote_tracker_parse(${ARGN})
  if(ARG_STATIC)
    add_library(${name} STATIC ${sources})
  else()
    add_library(${name} ${sources})
    install(TARGETS ${name}
      ARCHIVE DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
      LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
      RUNTIME DESTINATION ${CATKIN_GLOBAL_BIN_DESTINATION})
  endif()
  _wiimote_tracker_link(${name} wiimote_tracker_precompiled)
endfunction()

# wiimote_tracker_add_program(NAME SOURCE... [ROS] [LIBRARIES LIBRARY...]): adds and installs it.
function(wiimote_tracker_add_program name)
  _wiimote_tracker_parse(${ARGN})
  add_executable(${name} ${sources})
  install(TARGETS ${name} RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
  _wiimote_tracker_link(${name} wiimote_tracker_precompiled)
endfunction()

# wiimote_tracker_add_gtest(NAME SOURCE... [ROS] [LIBRARIES LIBRARY...]): a test without a master.
function(wiimote_tracker_add_gtest name)
  _wiimote_tracker_parse(${ARGN})
  catkin_add_gtest(${name} ${sources})
  list(APPEND ARG_LIBRARIES gtest_main gtest)
  _wiimote_tracker_link_test(${name})
endfunction()

# wiimote_tracker_add_node_test(NAME LAUNCH SOURCE... [LIBRARIES LIBRARY...] [NODES TARGET...])
# A gtest that the launch file starts together with these nodes of ours. A test without main() gets
# that of node_test_main.cpp. The target wiimote_tracker_node_tests builds all of them.
function(wiimote_tracker_add_node_test name launch)
  cmake_parse_arguments(ARG "" "" "LIBRARIES;NODES" ${ARGN})
  add_rostest_gtest(${name} ${launch} ${ARG_UNPARSED_ARGUMENTS})
  if(NOT TARGET wiimote_tracker_node_test_main)
    add_library(wiimote_tracker_node_test_main STATIC EXCLUDE_FROM_ALL
      ${WIIMOTE_TRACKER_CMAKE_DIR}/../test_support/node_test_main.cpp)
  endif()
  set(ARG_ROS ON)
  list(APPEND ARG_LIBRARIES wiimote_tracker_node_test_main gtest)
  _wiimote_tracker_link_test(${name})
  if(ARG_NODES)
    add_dependencies(${name} ${ARG_NODES})
  endif()
  if(NOT TARGET wiimote_tracker_node_tests)
    add_custom_target(wiimote_tracker_node_tests)
  endif()
  add_dependencies(wiimote_tracker_node_tests ${name})
endfunction()

# wiimote_tracker_check_parameters(NAME): gives this test the function of documented_parameters.h,
# compiled once for all packages of a build, and the package's folder config as CONFIG_FOLDER. The
# package has found yaml-cpp.
function(wiimote_tracker_check_parameters name)
  if(NOT TARGET wiimote_tracker_documented_parameters)
    add_library(wiimote_tracker_documented_parameters STATIC EXCLUDE_FROM_ALL
      ${WIIMOTE_TRACKER_CMAKE_DIR}/../test_support/documented_parameters.cpp)
    target_link_libraries(wiimote_tracker_documented_parameters ${YAML_CPP_LIBRARIES} gtest)
  endif()
  target_link_libraries(${name} wiimote_tracker_documented_parameters)
  target_compile_definitions(${name} PRIVATE CONFIG_FOLDER="${PROJECT_SOURCE_DIR}/config")
endfunction()

# wiimote_tracker_add_pytest(NAME FILE [REAL_TIME] [ENVIRONMENT VARIABLE=VALUE...]
#   [DEPENDENCIES TARGET...])
# REAL_TIME: it starts nodes, or waits for other programs, so nothing may delay it for long.
function(wiimote_tracker_add_pytest name file)
  cmake_parse_arguments(ARG "REAL_TIME" "" "ENVIRONMENT;DEPENDENCIES" ${ARGN})
  get_filename_component(file ${file} ABSOLUTE)
  set(type pytest)
  if(ARG_REAL_TIME)
    set(type pytest-real-time)
  endif()
  set(results ${CATKIN_TEST_RESULTS_DIR}/${PROJECT_NAME}/pytest-${name}.xml)
  string(REPLACE ";" " " environment "${ARG_ENVIRONMENT}")
  catkin_run_tests_target(${type} ${name} pytest-${name}.xml
    COMMAND "${CMAKE_COMMAND} -E env ${environment} ${PYTHON_EXECUTABLE} -m pytest -p no:cacheprovider ${file} --junit-xml=${results}"
    DEPENDENCIES ${ARG_DEPENDENCIES})
endfunction()
