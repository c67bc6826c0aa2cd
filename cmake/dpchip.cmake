# The house's own CMake words: dpchip_layer(), dpchip_test(), dpchip_options().
include(warnings)
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
  if(DPCHIP_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=${DPCHIP_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
    target_link_options(${target} PRIVATE -fsanitize=${DPCHIP_SANITIZE})
  endif()
endfunction()

# dpchip_layer(name DEPS layers... LIBS targets...): the library of one folder under src/.
# A folder without .cpp files is an INTERFACE library. Headers are found as <dpchip/name/x.hpp>:
# the build tree links include/dpchip/name to the folder.
function(dpchip_layer name)
  cmake_parse_arguments(arg "" "" "DEPS;LIBS" ${ARGN})
  set(folder ${CMAKE_CURRENT_SOURCE_DIR}/${name})
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
endfunction()

# dpchip_test(name DEPS layers... LIBS targets...): one GoogleTest program from tests/name/*.cpp.
function(dpchip_test name)
  cmake_parse_arguments(arg "" "" "DEPS;LIBS" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${name}/*.cpp)
  if(NOT sources)
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
  add_test(NAME ${name} COMMAND test_${name} --gtest_brief=1 --gtest_output=xml:${PROJECT_BINARY_DIR}/tests/${name}.xml
           WORKING_DIRECTORY ${PROJECT_BINARY_DIR})
endfunction()
