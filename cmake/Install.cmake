# What `cmake --install` puts where, and the Debian package of it (tools/package). Nothing installed names the build
# tree: commands find what is beside them from where they are (processes/called_as.hpp).
include(CMakePackageConfigHelpers)
set(share ${CMAKE_INSTALL_DATADIR}/mixloop)

install(TARGETS mixloop mixloop-plant mixloop-controller mixloop-planner)
foreach(part mixloop-scenes mixloop-studies mixloop-records mixloop_hdf5 mixloop_mpi)
  if(TARGET ${part})
    install(TARGETS ${part} DESTINATION ${CMAKE_INSTALL_LIBDIR}/mixloop)
  endif()
endforeach()
install(TARGETS mixloop_library EXPORT mixloop)
install(DIRECTORY library/include/mixloop DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT mixloop NAMESPACE mixloop:: FILE mixloopTargets.cmake DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/mixloop)
configure_package_config_file(
  cmake/mixloopConfig.cmake.in ${CMAKE_BINARY_DIR}/install/mixloopConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/mixloop PATH_VARS share)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/install/mixloopConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/install/mixloopConfig.cmake ${CMAKE_BINARY_DIR}/install/mixloopConfigVersion.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/mixloop)
file(RELATIVE_PATH prefix_from_pkgconfig /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(cmake/mixloop.pc.in ${CMAKE_BINARY_DIR}/install/mixloop.pc @ONLY)
install(FILES ${CMAKE_BINARY_DIR}/install/mixloop.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

install(DIRECTORY scenes experiments DESTINATION ${share} FILES_MATCHING PATTERN *.yaml)
install(DIRECTORY lcmtypes DESTINATION ${share} FILES_MATCHING PATTERN *.lcm)
if(TARGET mixloop_types_jar)
  install(FILES ${CMAKE_BINARY_DIR}/share/mixloop/types.jar DESTINATION ${share})
endif()
if(TARGET mixloop_pages)
  foreach(page report sweep view)
    install(FILES ${CMAKE_BINARY_DIR}/share/mixloop/${page}.html DESTINATION ${share})
  endforeach()
endif()
install(FILES README.md CITATION.cff DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs/ DESTINATION ${CMAKE_INSTALL_DOCDIR}/docs FILES_MATCHING PATTERN *.md)
install(DIRECTORY examples/library examples/suite DESTINATION ${share}/examples)
install(FILES examples/controller.cpp examples/controller.py examples/Controller.java DESTINATION ${share}/examples)
set(maintainer "The mixloop authors <mixloop@mixloop.invalid>")  # whoever publishes a package puts an address here
add_subdirectory(packaging)

# One Debian package. What it takes from elsewhere is recommended where only a part needs it: a compiler (machine code;
# without one programs are interpreted, and that is said), Java with LCM's jar (lcm-spy).
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME mixloop)
set(CPACK_PACKAGE_VENDOR "The mixloop authors")
set(CPACK_PACKAGE_CONTACT ${maintainer})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "g++, default-jre, liblcm-java, libjchart2d-java")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "liblcm-dev, liblcm-bin, cmake, pkg-config")
# Its shared library is the linker's to find: what a generated shlibs control file and ldconfig's trigger say.
file(WRITE ${CMAKE_BINARY_DIR}/install/shlibs
     "libmixloop ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} mixloop (>= ${PROJECT_VERSION})\n")
file(WRITE ${CMAKE_BINARY_DIR}/install/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${CMAKE_BINARY_DIR}/install/shlibs ${CMAKE_BINARY_DIR}/install/triggers)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "mechanisms, run as a plant and a controller over LCM")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
    "mixloop turns a description of a geared, loop-constrained mechanism into the
smallest program for its equations of motion, and runs that program in a plant
simulator and in the controller that drives it, over LCM at 1 kHz.

The package has the commands, the C++ library with its headers, the message
types, scenes and experiments, and the pages of reports and of the view.")
include(CPack)
