# Instrumented builds: sanitizers, libFuzzer and coverage. A build has at most one of the three.
set(DPCHIP_SANITIZE "" CACHE STRING "Sanitizers, as -fsanitize= takes them: address,undefined or thread")
option(DPCHIP_FUZZ "libFuzzer programs (clang); implies the address and undefined sanitizers" OFF)
option(DPCHIP_COVERAGE "Count executed lines and branches (g++, gcov)" OFF)

if(DPCHIP_FUZZ AND NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  message(FATAL_ERROR "DPCHIP_FUZZ needs clang, for libFuzzer; this is ${CMAKE_CXX_COMPILER_ID}")
endif()

set(DPCHIP_INSTRUMENT_COMPILE "")
set(DPCHIP_INSTRUMENT_LINK "")
if(DPCHIP_FUZZ)
  set(DPCHIP_INSTRUMENT_COMPILE -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all
                                -fno-omit-frame-pointer)
  set(DPCHIP_INSTRUMENT_LINK -fsanitize=address,undefined)
elseif(DPCHIP_SANITIZE)
  set(DPCHIP_INSTRUMENT_COMPILE -fsanitize=${DPCHIP_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  set(DPCHIP_INSTRUMENT_LINK -fsanitize=${DPCHIP_SANITIZE})
elseif(DPCHIP_COVERAGE)
  set(DPCHIP_INSTRUMENT_COMPILE --coverage -fprofile-update=atomic)
  set(DPCHIP_INSTRUMENT_LINK --coverage)
endif()
