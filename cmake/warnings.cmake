# Warnings, all of them errors in developer builds, on both compilers.
# -Wrestrict is off: g++ 12 sees overlaps in std::string's operator+ that are not there (its bug 105651).
set(DPCHIP_WARNINGS
  -Wall -Wextra -Wpedantic -Werror -Wconversion -Wsign-conversion -Wshadow -Wswitch-enum -Wnull-dereference
  $<$<COMPILE_LANGUAGE:CXX>:-Wold-style-cast>
  $<$<AND:$<COMPILE_LANGUAGE:CXX>,$<CXX_COMPILER_ID:GNU>>:-Wduplicated-cond>
  $<$<AND:$<COMPILE_LANGUAGE:CXX>,$<CXX_COMPILER_ID:GNU>>:-Wlogical-op>
  $<$<AND:$<COMPILE_LANGUAGE:CXX>,$<CXX_COMPILER_ID:GNU>>:-Wno-restrict>)

# For what is not hot. With less optimisation g++ 12 sees null pointers and overruns in the standard library that are not
# there; the fully optimised code and clang keep these warnings.
set(DPCHIP_LITTLE_OPTIMISED
  $<$<CONFIG:Release>:-O1> -Wno-null-dereference
  $<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds> $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>
  $<$<CXX_COMPILER_ID:GNU>:-Wno-stringop-overflow> $<$<CXX_COMPILER_ID:GNU>:-Wno-stringop-overread>)
