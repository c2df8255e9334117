# Debian's liblcm-dev has no CMake package: find the generator and the library ourselves.
find_program(MIXLOOP_LCM_GEN lcm-gen REQUIRED)
find_path(MIXLOOP_LCM_INCLUDE_DIR lcm/lcm.h REQUIRED)
find_library(MIXLOOP_LCM_LIBRARY lcm REQUIRED)

# mixloop_lcm_library(TARGET FILE.lcm...)
# Generates the C++ headers of these types, package mixloop, into the build tree and makes TARGET,
# an INTERFACE library that has them, LCM's own headers and -llcm. Include them as "mixloop/state_t.hpp".
function(mixloop_lcm_library target)
  set(out ${CMAKE_CURRENT_BINARY_DIR}/cpp)
  foreach(source IN LISTS ARGN)
    get_filename_component(type ${source} NAME_WE)
    set(header ${out}/mixloop/${type}.hpp)
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
