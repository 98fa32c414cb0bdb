#include <fmt/format.h>

#include "codegen/emit.hpp"

namespace tessera::codegen {

File cmake_lists(const Project& project, const std::vector<File>& files) {
  std::string sources;
  for (const File& file : files)
    if (file.path.ends_with(".cpp") && file.path != "main.cpp") sources += "\n  " + file.path;
  return {"CMakeLists.txt", fmt::format(R"cmake({}cmake_minimum_required(VERSION 3.25)
project(tessera_controller LANGUAGES CXX)

set(TESSERA_PROJECT_DIR "${{CMAKE_CURRENT_SOURCE_DIR}}/../.." CACHE PATH "The folder of spec.yaml, src and test")
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE RelWithDebInfo CACHE STRING "Debug steps better, RelWithDebInfo runs faster" FORCE)
endif()
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
find_package(tessera REQUIRED CONFIG)
# The header of fmt asks for some optimisation even here. By what g++ tells of that, gdb would stop before the arguments
# of a function can be read.
add_compile_options($<$<AND:$<CONFIG:Debug>,$<CXX_COMPILER_ID:GNU>>:-fno-var-tracking>)

# Yours, if you have one: libraries and flags for all that the project compiles.
add_library(project INTERFACE)
if(EXISTS "${{TESSERA_PROJECT_DIR}}/project.cmake")
  include("${{TESSERA_PROJECT_DIR}}/project.cmake")
endif()

# What CMake takes for a pattern is part of a name here.
string(REGEX REPLACE "([*?])" "[\\1]" project_pattern "${{TESSERA_PROJECT_DIR}}")
function(find_sources result folder)
  set(patterns)
  foreach(ending cpp cc cxx)
    list(APPEND patterns "${{project_pattern}}/${{folder}}/*.${{ending}}")
  endforeach()
  file(GLOB_RECURSE found CONFIGURE_DEPENDS ${{patterns}})
  list(FILTER found EXCLUDE REGEX "/\\.[^/]*$")  # what editors leave beside a file
  set(${{result}} "${{found}}" PARENT_SCOPE)
endfunction()

add_library(headers INTERFACE)
target_include_directories(headers INTERFACE "${{CMAKE_CURRENT_SOURCE_DIR}}" "${{TESSERA_PROJECT_DIR}}/src")
target_link_libraries(headers INTERFACE tessera::runtime project)

# Yours: the transition functions, in every source of src/. Object files, not an archive: of a function that is there
# twice, the linker would take one out of an archive and say nothing.
find_sources(user_sources src)
if(NOT user_sources)
  message(FATAL_ERROR "${{TESSERA_PROJECT_DIR}}/src has no transition functions: 'tessera generate --stubs' writes them")
endif()
add_library(functions OBJECT ${{user_sources}})
target_compile_options(functions PRIVATE -Wall -Wextra -Wno-unused-parameter)
target_link_libraries(functions PUBLIC headers)
# Most of the time of each source goes into the headers that every header of a subsystem includes. A cache of the
# compiler, such as ccache, does better without.
list(LENGTH user_sources number)
if(number GREATER 3 AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  target_precompile_headers(functions PRIVATE <tessera/buffer.hpp> <tessera/context.hpp> <tessera/fields.hpp>)
  set_target_properties(functions PROPERTIES PCH_WARN_INVALID OFF)  # a source with flags of its own includes them
endif()
if(TESSERA_COVERAGE)
  target_compile_options(functions PRIVATE --coverage)
  target_link_options(headers INTERFACE --coverage)
endif()

# Tessera's: the net and what binds it to the functions.
set(sources{})
add_library(system STATIC)
# The runtime, which fires the net, is compiled for speed. Here, -O3 would take about twice as long. `a && b || c` is a
# good condition: `tessera check` finds the comparisons that need brackets.
target_compile_options(system PRIVATE -Wall -Wextra -Wno-parentheses -Werror $<$<CONFIG:Release,RelWithDebInfo>:-O1>)
# Nearly all the time of each source goes into the headers that all of its kind include. Conditions include less and
# change more often, so only a few of them are compiled together.
set(conditions ${{sources}})
list(FILTER conditions INCLUDE REGEX "[.]conditions[.]cpp$")
if(conditions)
  add_library(conditions OBJECT ${{conditions}})
  target_compile_options(conditions PRIVATE $<TARGET_PROPERTY:system,COMPILE_OPTIONS>)
  set_target_properties(conditions PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 4)
  target_link_libraries(conditions PRIVATE headers)
  target_sources(system PRIVATE $<TARGET_OBJECTS:conditions>)
  list(REMOVE_ITEM sources ${{conditions}})
endif()
target_sources(system PRIVATE ${{sources}})
set_target_properties(system PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 16)
list(FILTER sources INCLUDE REGEX "^system[.]")
set_source_files_properties(${{sources}} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
target_link_libraries(system PUBLIC headers)

add_executable(controller main.cpp)
target_compile_options(controller PRIVATE -Wall -Wextra -Werror)
target_link_libraries(controller PRIVATE functions system)

find_sources(test_sources test)
find_package(GTest QUIET)
if(test_sources AND GTest_FOUND)
  add_executable(tests EXCLUDE_FROM_ALL ${{test_sources}})
  target_compile_options(tests PRIVATE -Wall -Wextra)
  target_link_libraries(tests PRIVATE functions system GTest::gtest_main)
endif()
)cmake",
                                        project.banner("#"), sources)};
}

File format_style() {
  return {".clang-format", R"(BasedOnStyle: Google
ColumnLimit: 110
DerivePointerAlignment: false
PointerAlignment: Left
)"};
}

}  // namespace tessera::codegen
