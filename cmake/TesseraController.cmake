# tessera_add_controller(NAME [SPEC FILE] [SOURCES FILE...] [LIBRARIES TARGET...])
#
# Adds the executable NAME: the controller of a specification, in a CMake project of your own.
#   SPEC       the specification; by default spec.yaml in this folder
#   SOURCES    the sources with your transition functions and drivers; by default all in src/ beside the specification
#   LIBRARIES  what they link: targets or libraries
# CMake verifies the specification and generates its C++ whenever it configures, and configures again when the
# specification has changed. If it is refused, so is the configuration, with the messages of `tessera generate`.
#
# NAME_functions (your sources) and NAME_system (the generated ones) are libraries that tests of yours can link.
function(tessera_add_controller name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "SPEC" "SOURCES;LIBRARIES")
  if(arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "tessera_add_controller(${name}): unknown argument '${arg_UNPARSED_ARGUMENTS}'; there are SPEC, SOURCES and LIBRARIES")
  endif()
  if(NOT arg_SPEC)
    set(arg_SPEC spec.yaml)
  endif()
  cmake_path(ABSOLUTE_PATH arg_SPEC BASE_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}" NORMALIZE OUTPUT_VARIABLE spec)
  if(NOT EXISTS "${spec}")
    message(FATAL_ERROR "tessera_add_controller(${name}): there is no specification ${spec}")
  endif()
  cmake_path(GET spec PARENT_PATH folder)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${spec}")

  set(sources)
  set(named)
  if(DEFINED arg_SOURCES)
    foreach(source IN LISTS arg_SOURCES)
      cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}" NORMALIZE)
      list(APPEND sources "${source}")
      list(APPEND named --sources "${source}")
    endforeach()
  else()
    string(REGEX REPLACE "([*?[])" "[\\1]" pattern "${folder}")
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS "${pattern}/src/*.cpp" "${pattern}/src/*.cc" "${pattern}/src/*.cxx")
    list(FILTER sources EXCLUDE REGEX "/\\.[^/]*$")  # what editors leave beside a file
  endif()
  # Reports an added or removed function as a missing one.
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${sources})

  set(generated "${CMAKE_CURRENT_BINARY_DIR}/${name}.generated")
  execute_process(COMMAND "${TESSERA_COMMAND}" generate "${spec}" --output "${generated}" ${named}
    RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE problems)
  if(NOT result EQUAL 0)
    message(NOTICE "${problems}")
    message(FATAL_ERROR "tessera_add_controller(${name}): ${spec} has no controller, see above")
  elseif(problems)
    message(NOTICE "${problems}")
  endif()

  add_library(${name}_project INTERFACE)
  target_include_directories(${name}_project INTERFACE "${generated}" "${folder}/src")
  target_compile_features(${name}_project INTERFACE cxx_std_20)
  target_link_libraries(${name}_project INTERFACE tessera::runtime ${arg_LIBRARIES})
  # Object files, not an archive: from an archive, the linker would silently take one of two equal functions.
  add_library(${name}_functions OBJECT ${sources})
  target_link_libraries(${name}_functions PUBLIC ${name}_project)
  file(GLOB_RECURSE system "${generated}/*.cpp")
  list(REMOVE_ITEM system "${generated}/main.cpp")
  add_library(${name}_system STATIC ${system})
  # Nearly all the compile time of each subsystem's source is spent in the same headers. The others are small.
  set_target_properties(${name}_system PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 16)
  list(FILTER system INCLUDE REGEX "/system[.][^/]*$|[.]conditions[.]cpp$")
  set_source_files_properties(${system} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  # The runtime, which fires the net, is compiled for speed. Here, -O3 would take about twice as long.
  target_compile_options(${name}_system PRIVATE $<$<CONFIG:Release,RelWithDebInfo>:-O1>)
  target_link_libraries(${name}_system PUBLIC ${name}_project)
  add_executable(${name} "${generated}/main.cpp")
  target_link_libraries(${name} PRIVATE ${name}_functions ${name}_system)
endfunction()
