# Compiles every installed header of the driver and of the layers it stands on without exceptions and RTTI, and
# demands that the object needs nothing of a C++ runtime. CXX, NM, INCLUDE and OUT come from the caller.
set(text "// SPDX-License-Identifier: Apache-2.0\n")
foreach(layer IN ITEMS core regmap dp driver)
  file(GLOB_RECURSE headers RELATIVE ${INCLUDE} ${INCLUDE}/dpchip/${layer}/*.hpp)
  list(SORT headers)
  foreach(header IN LISTS headers)
    string(APPEND text "#include <${header}>\n")
  endforeach()
endforeach()
string(APPEND text "int dpchip_freestanding() { return 0; }\n")
file(MAKE_DIRECTORY ${OUT})
file(WRITE ${OUT}/all.cpp "${text}")

execute_process(
  COMMAND ${CXX} -std=c++20 -O2 -fno-exceptions -fno-rtti -fno-threadsafe-statics -Wall -Wextra -Werror
          -I ${INCLUDE} -c ${OUT}/all.cpp -o ${OUT}/all.o
  COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${NM} --undefined-only ${OUT}/all.o OUTPUT_VARIABLE undefined COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "(malloc|free|_Znw|_Zna|_Zdl|_Zda|__cxa|_Unwind|__gxx)[A-Za-z0-9_]*" found "${undefined}")
if(found)
  message(FATAL_ERROR "the driver needs a C++ runtime: ${found}")
endif()
string(REGEX MATCHALL "#include" count "${text}")
list(LENGTH count count)
message(STATUS "${count} headers, nothing of a runtime needed")
