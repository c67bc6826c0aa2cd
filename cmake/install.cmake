# cmake --install: program, headers, libraries, exported targets and dpchip.pc.
#
# Every layer is dpchip::<layer> (dpchip::driver is headers only, dpchip::tlm is there when SystemC is); the C library is
# dpchip::capi (shared) and dpchip::capi_static. Folders whose targets a build leaves out (DPCHIP_TOOLS=OFF) are left out here too.
include(CMakePackageConfigHelpers)

get_property(dpchip_layers GLOBAL PROPERTY DPCHIP_LAYERS)
list(REMOVE_ITEM dpchip_layers cli)
set(dpchip_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/dpchip)

# Headers.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/dpchip DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
        FILES_MATCHING PATTERN *.h PATTERN *.hpp)
foreach(layer IN LISTS dpchip_layers)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/src/${layer}/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/dpchip/${layer}
          FILES_MATCHING PATTERN *.hpp)
endforeach()

# Libraries and the program.
set(dpchip_exported ${dpchip_layers})
foreach(library IN ITEMS capi capi_static)
  if(TARGET dpchip_${library})
    list(APPEND dpchip_exported ${library})
  endif()
endforeach()
list(REMOVE_DUPLICATES dpchip_exported)
list(TRANSFORM dpchip_exported PREPEND dpchip_ OUTPUT_VARIABLE dpchip_targets)
install(TARGETS ${dpchip_targets} EXPORT dpchipTargets
        RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR}
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT dpchipTargets NAMESPACE dpchip:: DESTINATION ${dpchip_package_dir})
if(TARGET dpchip)
  install(TARGETS dpchip RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()

# dpchipConfig.cmake finds the packages that installed layers link to: "Boost::headers" needs package Boost.
set(dpchip_packages "")
foreach(layer IN LISTS dpchip_layers)
  get_property(libraries GLOBAL PROPERTY DPCHIP_LIBS_${layer})
  foreach(library IN LISTS libraries)
    if(library MATCHES "^([A-Za-z0-9_]+)::")
      list(APPEND dpchip_packages ${CMAKE_MATCH_1})
    endif()
  endforeach()
endforeach()
list(REMOVE_DUPLICATES dpchip_packages)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/dpchipConfig.cmake.in ${PROJECT_BINARY_DIR}/dpchipConfig.cmake
                              INSTALL_DESTINATION ${dpchip_package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/dpchipConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/dpchipConfig.cmake ${PROJECT_BINARY_DIR}/dpchipConfigVersion.cmake
        DESTINATION ${dpchip_package_dir})

# pkg-config speaks for the C library only.
if(TARGET dpchip_capi)
  # Relative to the .pc file, so that an installed tree can be moved.
  file(RELATIVE_PATH dpchip_pc_up /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
  string(REGEX REPLACE "/$" "" dpchip_pc_up "${dpchip_pc_up}")
  set(dpchip_pc_requires "")
  foreach(module IN ITEMS fmt spdlog)
    if(module IN_LIST dpchip_packages)
      list(APPEND dpchip_pc_requires ${module})
    endif()
  endforeach()
  list(JOIN dpchip_pc_requires ", " dpchip_pc_requires)
  configure_file(${CMAKE_CURRENT_LIST_DIR}/dpchip.pc.in ${PROJECT_BINARY_DIR}/dpchip.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/dpchip.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endif()
