# The house's own CMake words: dpchip_layer(), dpchip_c_library(), dpchip_test(), dpchip_fuzz(), dpchip_options().
include(warnings)
include(sanitizers)
include(GNUInstallDirs)

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_C_STANDARD 99)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib)
set(CMAKE_ARCHIVE_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib)

# What every target of the house is compiled with.
function(dpchip_options target)
  if(DPCHIP_DEVELOPER)
    target_compile_options(${target} PRIVATE ${DPCHIP_WARNINGS})
  endif()
  if(CMAKE_BUILD_TYPE STREQUAL "Debug" OR DPCHIP_SANITIZE OR DPCHIP_FUZZ)
    target_compile_definitions(${target} PRIVATE DPCHIP_CHECKED)
  endif()
  target_compile_options(${target} PRIVATE ${DPCHIP_INSTRUMENT_COMPILE})
  target_link_options(${target} PRIVATE ${DPCHIP_INSTRUMENT_LINK})
endfunction()

# dpchip_layer(name DEPS layers... LIBS targets...): the library of one folder under src/.
# A folder without .cpp files is an INTERFACE library. Headers are found as <dpchip/name/x.hpp>:
# the build tree links include/dpchip/name to the folder. Called from src/ or from src/name/.
function(dpchip_layer name)
  cmake_parse_arguments(arg "" "" "DEPS;LIBS" ${ARGN})
  set(folder ${PROJECT_SOURCE_DIR}/src/${name})
  file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/include/dpchip)
  file(CREATE_LINK ${folder} ${PROJECT_BINARY_DIR}/include/dpchip/${name} SYMBOLIC)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${folder}/*.cpp)
  list(TRANSFORM arg_DEPS PREPEND dpchip_ OUTPUT_VARIABLE dependencies)
  if(sources)
    add_library(dpchip_${name} STATIC ${sources})
    set(scope PUBLIC)
    dpchip_options(dpchip_${name})
  else()
    add_library(dpchip_${name} INTERFACE)
    set(scope INTERFACE)
  endif()
  add_library(dpchip::${name} ALIAS dpchip_${name})
  set_target_properties(dpchip_${name} PROPERTIES EXPORT_NAME ${name})
  target_compile_features(dpchip_${name} ${scope} cxx_std_20)
  target_include_directories(dpchip_${name} ${scope}
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
    $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(dpchip_${name} ${scope} ${dependencies} ${arg_LIBS})
  set_property(GLOBAL APPEND PROPERTY DPCHIP_LAYERS ${name})
  set_property(GLOBAL PROPERTY DPCHIP_LIBS_${name} ${arg_LIBS})
endfunction()

# dpchip_c_library(DEPS layers... LIBS targets...): libdpchip from src/capi/*.cpp, as dpchip::capi (shared) and
# dpchip::capi_static, which contains the layers so that a C program links one archive. DEPS names every layer whose
# objects belong inside, not only the direct ones.
function(dpchip_c_library)
  cmake_parse_arguments(arg "" "" "DEPS;LIBS" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/capi/*.cpp)
  list(TRANSFORM arg_DEPS PREPEND dpchip_ OUTPUT_VARIABLE layers)
  set(objects "")
  foreach(layer IN LISTS layers)
    get_target_property(type ${layer} TYPE)
    if(type STREQUAL "STATIC_LIBRARY")
      list(APPEND objects $<TARGET_OBJECTS:${layer}>)
    endif()
  endforeach()
  file(STRINGS ${PROJECT_SOURCE_DIR}/include/dpchip/version.h abi REGEX "^#define DPCHIP_ABI_VERSION ")
  string(REGEX REPLACE "^#define DPCHIP_ABI_VERSION +([0-9]+).*" "\\1" abi "${abi}")

  add_library(dpchip_capi SHARED ${sources})
  target_link_libraries(dpchip_capi PRIVATE ${layers} ${arg_LIBS})
  target_link_options(dpchip_capi PRIVATE -Wl,--exclude-libs,ALL)
  set_target_properties(dpchip_capi PROPERTIES VERSION ${PROJECT_VERSION} SOVERSION ${abi})

  add_library(dpchip_capi_static STATIC ${sources} ${objects})
  foreach(layer IN LISTS layers)
    target_include_directories(dpchip_capi_static PRIVATE $<TARGET_PROPERTY:${layer},INTERFACE_INCLUDE_DIRECTORIES>)
  endforeach()
  target_link_libraries(dpchip_capi_static PRIVATE ${arg_LIBS})

  foreach(library IN ITEMS capi capi_static)
    dpchip_options(dpchip_${library})
    target_compile_definitions(dpchip_${library} PRIVATE DPCHIP_BUILDING_CAPI)
    add_library(dpchip::${library} ALIAS dpchip_${library})
    set_target_properties(dpchip_${library} PROPERTIES OUTPUT_NAME dpchip EXPORT_NAME ${library}
                          CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
    target_include_directories(dpchip_${library} PUBLIC
      $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
      $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  endforeach()
endfunction()

# dpchip_test(name DEPS layers... LIBS targets...): one GoogleTest program from tests/name/*.cpp.
# DPCHIP_TESTS narrows a build down to some of them.
set(DPCHIP_TESTS "" CACHE STRING "Build only these test programs (layer names; empty: all of them)")
function(dpchip_test name)
  cmake_parse_arguments(arg "" "" "DEPS;LIBS" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/${name}/*.cpp)
  if(NOT sources OR (DPCHIP_TESTS AND NOT name IN_LIST DPCHIP_TESTS))
    return()
  endif()
  add_executable(test_${name} ${sources})
  dpchip_options(test_${name})
  list(TRANSFORM arg_DEPS PREPEND dpchip_ OUTPUT_VARIABLE dependencies)
  target_link_libraries(test_${name} PRIVATE ${dependencies} ${arg_LIBS} GTest::gtest_main)
  target_include_directories(test_${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_compile_definitions(test_${name} PRIVATE
    DPCHIP_SOURCE_DIR="${PROJECT_SOURCE_DIR}" DPCHIP_BINARY_DIR="${PROJECT_BINARY_DIR}")
  target_precompile_headers(test_${name} PRIVATE <gtest/gtest.h>)
  # Tests are compiled more often than they are run: what they test is optimised, they are not.
  target_compile_options(test_${name} PRIVATE ${DPCHIP_LITTLE_OPTIMISED})
  set_property(GLOBAL APPEND PROPERTY DPCHIP_TEST_PROGRAMS test_${name})
  add_test(NAME ${name} COMMAND test_${name} --gtest_brief=1 --gtest_output=xml:${PROJECT_BINARY_DIR}/tests/${name}.xml
           WORKING_DIRECTORY ${PROJECT_BINARY_DIR})
endfunction()

# dpchip_fuzz(name DEPS layers... LIBS targets...): fuzz/fuzz_name.cpp, which defines LLVMFuzzerTestOneInput.
# With DPCHIP_FUZZ it is a libFuzzer program; without, a program that replays fuzz/corpus/name once, as a test.
function(dpchip_fuzz name)
  cmake_parse_arguments(arg "" "" "DEPS;LIBS" ${ARGN})
  if(NOT EXISTS ${PROJECT_SOURCE_DIR}/fuzz/fuzz_${name}.cpp)
    return()
  endif()
  set(corpus ${PROJECT_SOURCE_DIR}/fuzz/corpus/${name})
  add_executable(fuzz_${name} ${PROJECT_SOURCE_DIR}/fuzz/fuzz_${name}.cpp)
  dpchip_options(fuzz_${name})
  list(TRANSFORM arg_DEPS PREPEND dpchip_ OUTPUT_VARIABLE dependencies)
  target_link_libraries(fuzz_${name} PRIVATE ${dependencies} ${arg_LIBS})
  set_property(GLOBAL APPEND PROPERTY DPCHIP_FUZZ_PROGRAMS fuzz_${name})
  if(DPCHIP_FUZZ)
    target_link_options(fuzz_${name} PRIVATE -fsanitize=fuzzer)
    add_test(NAME fuzz.${name} COMMAND fuzz_${name} -runs=0 ${corpus})
  else()
    target_sources(fuzz_${name} PRIVATE ${PROJECT_SOURCE_DIR}/fuzz/replay.cpp)
    add_test(NAME fuzz.${name} COMMAND fuzz_${name} ${corpus})
  endif()
endfunction()
