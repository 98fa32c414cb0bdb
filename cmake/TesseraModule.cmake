# One way to declare a module, a test and a benchmark, so that flags are defined once.
include(GNUInstallDirs)
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)

add_library(tessera_flags INTERFACE)
# Sources that are compiled together share unnamed namespaces, so a local name may equal one of those. The
# presets that compile each source on its own warn about shadowing.
target_compile_options(tessera_flags INTERFACE -Wall -Wextra -Wpedantic -Wconversion -Wno-sign-conversion -Werror
  $<$<NOT:$<BOOL:${CMAKE_UNITY_BUILD}>>:-Wshadow>
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)  # g++ 12 reports it wrongly for string concatenation (GCC bug
                                            # 105651)
if(TESSERA_SANITIZE)
  add_compile_options(-fsanitize=${TESSERA_SANITIZE} -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${TESSERA_SANITIZE})
  # g++ 12 reports it wrongly for std::regex in instrumented code.
  target_compile_options(tessera_flags INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  if(TESSERA_SANITIZE MATCHES "undefined")
    add_compile_options(-fno-sanitize-recover=undefined)
  endif()
endif()

# g++ collects its garbage often, to save memory: that takes a seventh of its time. If each job has two
# gigabytes, g++ may use half a gigabyte before it begins to collect.
cmake_host_system_information(RESULT memory_mib QUERY TOTAL_PHYSICAL_MEMORY)
cmake_host_system_information(RESULT cores QUERY NUMBER_OF_LOGICAL_CORES)
math(EXPR memory_mib_a_job "${memory_mib} / ${cores}")
if(memory_mib_a_job GREATER_EQUAL 2048)
  add_compile_options($<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=524288>)
endif()

# For sources whose speed no user notices, and for tests. They take two thirds of the time to compile, with
# sanitizers less than half. Nets, search, generator and the firing code of the runtime are optimised fully.
if(TESSERA_SANITIZE)
  set(TESSERA_COMPILE_QUICKLY -O0)
else()
  set(TESSERA_COMPILE_QUICKLY $<$<CONFIG:Release>:-O1>)
endif()
macro(tessera_compile_quickly)
  add_compile_options(${TESSERA_COMPILE_QUICKLY})
endmacro()

# For tests with long computations: naive answers to large questions.
macro(tessera_compile_for_speed)
  add_compile_options(-O1)
  set(TESSERA_TEST_HEADERS OFF)  # they were compiled with other flags
endmacro()

# Compiles the headers that most tests include once. The presets that compile each source on its own do not,
# so that a missing include is found there. An executable, because position-independent code for libraries has
# other flags.
macro(tessera_test_headers)
  set(TESSERA_TEST_HEADERS ${CMAKE_UNITY_BUILD})
  if(TESSERA_TEST_HEADERS)
    file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/test_headers.cpp CONTENT "")
    add_executable(tessera_test_headers EXCLUDE_FROM_ALL ${CMAKE_CURRENT_BINARY_DIR}/test_headers.cpp)
    target_link_libraries(tessera_test_headers PRIVATE GTest::gtest GTest::gmock GTest::gtest_main tessera_flags)
    target_precompile_headers(tessera_test_headers PRIVATE
      <gmock/gmock.h> <gtest/gtest.h> <nlohmann/json.hpp> <algorithm> <chrono> <filesystem> <fstream> <functional> <map>
      <memory> <optional> <random> <set> <sstream> <string> <string_view> <thread> <variant> <vector>)
  endif()
endmacro()

# Unity builds compile the modules of a group as one source, because they spend their time in the same headers and
# templates. They are optimised alike. For nets and search, it would save nothing. `checks` is in no group: controllers
# load a library that links it, and would load what the rest of the group needs.
set(TESSERA_MODULES_OF_specification diagnostics spec language)
set(TESSERA_MODULES_OF_command codegen drawing replay statistics report project language_server server cli)

# tessera_module(NAME SOURCES ... [PUBLIC targets...] [PRIVATE targets...])
# The library tessera_NAME, whose headers are included as "NAME/header.hpp". Its property TESSERA_ARCHIVE is the static
# library that has its objects: itself, or that of its group in a unity build.
function(tessera_module name)
  cmake_parse_arguments(MODULE "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  set(archive tessera_${name})
  foreach(group specification command)
    if(CMAKE_UNITY_BUILD AND name IN_LIST TESSERA_MODULES_OF_${group})
      set(archive tessera_${group}_modules)
      set(siblings ${TESSERA_MODULES_OF_${group}})
      list(TRANSFORM siblings PREPEND tessera_)
    endif()
  endforeach()
  cmake_path(GET CMAKE_CURRENT_SOURCE_DIR PARENT_PATH above)
  if(NOT TARGET ${archive})
    add_library(${archive} STATIC)
    target_link_libraries(${archive} PRIVATE tessera_flags)
    # Checks of each pointer take a quarter of the compilation. Modules that read bytes of files, sockets and devices
    # keep them. The others use containers, and AddressSanitizer finds their null pointers.
    cmake_path(RELATIVE_PATH CMAKE_CURRENT_SOURCE_DIR BASE_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE folder)
    if(TESSERA_SANITIZE MATCHES "undefined" AND folder MATCHES "^(src|studio|cli)")
      target_compile_options(${archive} PRIVATE -fno-sanitize=null,alignment)
    endif()
  endif()
  list(TRANSFORM MODULE_SOURCES PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
  target_sources(${archive} PRIVATE ${MODULE_SOURCES})
  target_include_directories(${archive} PUBLIC ${above})
  if(archive STREQUAL tessera_${name})
    target_link_libraries(${archive} PUBLIC ${MODULE_PUBLIC} PRIVATE ${MODULE_PRIVATE})
  else()
    set_target_properties(${archive} PROPERTIES UNITY_BUILD_BATCH_SIZE 0)
    add_library(tessera_${name} INTERFACE)
    target_link_libraries(tessera_${name} INTERFACE ${archive} ${MODULE_PUBLIC})
    set(others ${MODULE_PUBLIC} ${MODULE_PRIVATE})
    list(REMOVE_ITEM others ${siblings})
    target_link_libraries(${archive} PRIVATE ${others})
    get_target_property(home ${archive} SOURCE_DIR)
    get_directory_property(options COMPILE_OPTIONS)
    get_directory_property(options_of_group DIRECTORY ${home} COMPILE_OPTIONS)
    if(NOT options STREQUAL options_of_group)
      message(FATAL_ERROR "${name} has the compile options '${options}', its group '${options_of_group}'")
    endif()
  endif()
  set_target_properties(tessera_${name} PROPERTIES TESSERA_ARCHIVE ${archive})
endfunction()

# tessera_gtest(NAME SOURCES ... LIBRARIES ... [LABELS ...] [TIMEOUT s] [LOCK name] [WHOLE] [JUDGED])
# LOCK: its cases share a resource and run one after the other.
# JUDGED: its cases check messages against their schemas (tests/schema/judge.hpp).
# WHOLE: ctest lists one case, because SetUpTestSuite takes longer than the cases.
# Declares an executable test_NAME, whose cases ctest lists one by one. With sanitizers, starting a process
# takes longer than most cases, so fast ones are listed as a whole.
include(GoogleTest)
function(tessera_gtest name)
  cmake_parse_arguments(TEST "WHOLE;JUDGED" "TIMEOUT;LOCK" "SOURCES;LIBRARIES;LABELS" ${ARGN})
  if(NOT TEST_TIMEOUT)
    set(TEST_TIMEOUT 120)
  endif()
  add_executable(test_${name} ${TEST_SOURCES})
  target_link_libraries(test_${name} PRIVATE ${TEST_LIBRARIES} GTest::gtest GTest::gmock GTest::gtest_main tessera_flags)
  if(TESSERA_TEST_HEADERS)
    target_precompile_headers(test_${name} REUSE_FROM tessera_test_headers)
  endif()
  if(TEST_JUDGED)
    target_link_libraries(test_${name} PRIVATE tessera_judge)
  endif()
  target_compile_definitions(test_${name} PRIVATE TESSERA_SOURCE_DIR="${PROJECT_SOURCE_DIR}" TESSERA_BINARY_DIR="${PROJECT_BINARY_DIR}")
  if(name IN_LIST TESSERA_SUITES_OF_SANITIZERS)
    foreach(source ${TEST_SOURCES})
      file(STRINGS ${source} fewer REGEX "share_of\\(|sanitized")
      if(fewer)
        message(FATAL_ERROR "${source} tries fewer cases with sanitizers: take ${name} out of TESSERA_SUITES_OF_SANITIZERS")
      endif()
    endforeach()
    if(NOT TESSERA_TEST_SUITES_OF_SANITIZERS)
      set_target_properties(test_${name} PROPERTIES EXCLUDE_FROM_ALL ON)
      return()
    endif()
  endif()
  if(TESSERA_SANITIZE AND NOT "slow" IN_LIST TEST_LABELS)
    set(TEST_WHOLE TRUE)
    set(TEST_TIMEOUT 1200)
  endif()
  # A test has nothing to do with what Tessera keeps for the user who runs it (verdicts, trust).
  set(properties TIMEOUT ${TEST_TIMEOUT} ENVIRONMENT XDG_STATE_HOME=${PROJECT_BINARY_DIR}/tests/user)
  if(TEST_LOCK)
    list(APPEND properties RESOURCE_LOCK ${TEST_LOCK})
  endif()
  if(TEST_JUDGED)
    list(APPEND properties FIXTURES_REQUIRED schema_packages)
  endif()
  if(TEST_WHOLE)
    add_test(NAME ${name} COMMAND test_${name})
    set_tests_properties(${name} PROPERTIES ${properties} LABELS "${TEST_LABELS}")
    return()
  endif()
  gtest_discover_tests(test_${name} TEST_PREFIX ${name}. DISCOVERY_TIMEOUT 60 PROPERTIES ${properties} LABELS "${TEST_LABELS}")
endfunction()
