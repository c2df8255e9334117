# Debian's liblcm-dev has no CMake package: find the generator and the library ourselves.
find_program(MIXLOOP_LCM_GEN lcm-gen REQUIRED)
find_path(MIXLOOP_LCM_INCLUDE_DIR lcm/lcm.h REQUIRED)
find_library(MIXLOOP_LCM_LIBRARY lcm REQUIRED)

# mixloop_lcm_library(TARGET FILE.lcm...)
# Generates the C++ headers of these types, package mixloop_lcm, into the build tree and makes TARGET,
# an INTERFACE library that has them, LCM's own headers and -llcm. Include them as "mixloop_lcm/state_t.hpp".
function(mixloop_lcm_library target)
  set(out ${CMAKE_CURRENT_BINARY_DIR}/cpp)
  foreach(source IN LISTS ARGN)
    get_filename_component(type ${source} NAME_WE)
    set(header ${out}/mixloop_lcm/${type}.hpp)
    add_custom_command(
      OUTPUT ${header}
      COMMAND ${MIXLOOP_LCM_GEN} --cpp --cpp-std=c++11 --cpp-hpath ${out} ${CMAKE_CURRENT_SOURCE_DIR}/${source}
      DEPENDS ${source}
      COMMENT "lcm-gen ${source}"
      VERBATIM)
    list(APPEND headers ${header})
  endforeach()
  add_custom_target(${target}_generated DEPENDS ${headers})
  add_library(${target} INTERFACE)
  add_dependencies(${target} ${target}_generated)
  target_include_directories(${target} SYSTEM INTERFACE ${out} ${MIXLOOP_LCM_INCLUDE_DIR})
  target_link_libraries(${target} INTERFACE ${MIXLOOP_LCM_LIBRARY})
endfunction()

# mixloop_lcm_jar(TARGET FILE.lcm...)
# The types' Java classes in share/mixloop/types.jar, for lcm-spy and for controllers in Java. Nothing where
# there is no JDK or no Debian liblcm-java: said once.
find_package(Java 11 QUIET COMPONENTS Development)
find_file(MIXLOOP_LCM_JAR lcm.jar PATHS /usr/share/java)
function(mixloop_lcm_jar target)
  if(NOT Java_FOUND OR NOT MIXLOOP_LCM_JAR)
    message(STATUS "No JDK or no liblcm-java: without the types' jar (mixloop spy) and the Java example")
    return()
  endif()
  include(UseJava)
  set(out ${CMAKE_CURRENT_BINARY_DIR}/java)
  foreach(source IN LISTS ARGN)
    get_filename_component(type ${source} NAME_WE)
    add_custom_command(
      OUTPUT ${out}/mixloop_lcm/${type}.java
      COMMAND ${MIXLOOP_LCM_GEN} --java --jpath ${out} ${CMAKE_CURRENT_SOURCE_DIR}/${source}
      DEPENDS ${source}
      VERBATIM)
    list(APPEND classes ${out}/mixloop_lcm/${type}.java)
  endforeach()
  add_jar(${target} SOURCES ${classes} INCLUDE_JARS ${MIXLOOP_LCM_JAR} OUTPUT_NAME types
          OUTPUT_DIR ${CMAKE_BINARY_DIR}/share/mixloop)
endfunction()

# mixloop_lcm_python(TARGET FILE.lcm...)
# The types as a Python package, mixloop_lcm; the target's property PACKAGE_FOLDER is what PYTHONPATH needs.
function(mixloop_lcm_python target)
  set(out ${CMAKE_CURRENT_BINARY_DIR}/python)
  list(TRANSFORM ARGN PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/ OUTPUT_VARIABLE sources)
  add_custom_command(
    OUTPUT ${out}/mixloop_lcm/__init__.py
    COMMAND ${CMAKE_COMMAND} -E rm -rf ${out}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${out}
    COMMAND ${MIXLOOP_LCM_GEN} --python --ppath ${out} ${sources}
    DEPENDS ${sources}
    VERBATIM)
  add_custom_target(${target} ALL DEPENDS ${out}/mixloop_lcm/__init__.py)
  set_target_properties(${target} PROPERTIES PACKAGE_FOLDER ${out})
endfunction()
