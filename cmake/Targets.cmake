# One target a folder, mixloop::ROOM; headers are included from the repository's root.
include_directories(${PROJECT_SOURCE_DIR})

# Headers that many files include and nobody here changes, compiled once for all targets of one kind.
#   mixloop_precompiled(KIND header...)
function(mixloop_precompiled kind)
  set(source ${CMAKE_BINARY_DIR}/precompiled/${kind}.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "// Nothing but precompiled headers.\n")
  add_library(mixloop_precompiled_${kind} OBJECT ${source})
  target_link_libraries(
    mixloop_precompiled_${kind} PRIVATE mixloop_options mixloop_${kind} Eigen3::Eigen fmt::fmt nlohmann_json::nlohmann_json
                                        CLI11::CLI11)
  target_precompile_headers(mixloop_precompiled_${kind} PRIVATE ${ARGN})
endfunction()

# Templates are instantiated in each file that uses them: files of a room that are compiled together share them, which
# halves a whole build and lengthens that of a single change.
option(MIXLOOP_UNITY "compile the files of a room together" ON)

# How a target of this kind is compiled: its warnings, its optimisation and its precompiled headers.
function(mixloop_compiled_as kind target)
  target_link_libraries(${target} PRIVATE mixloop_options mixloop_${kind})
  target_precompile_headers(${target} REUSE_FROM mixloop_precompiled_${kind})
endfunction()
# Those for people all at once: each batch that includes CLI11 compiles its validators and formatter, which takes five
# seconds.
function(mixloop_compiled_together kind target)
  set(batch 12)
  if(kind STREQUAL people)
    set(batch 0)
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${MIXLOOP_UNITY} UNITY_BUILD_BATCH_SIZE ${batch})
endfunction()

# mixloop_room(ROOM KIND SOURCES file... [PUBLIC library...] [PRIVATE library...])
function(mixloop_room room kind)
  cmake_parse_arguments(arg "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(mixloop_${room} STATIC ${arg_SOURCES})
  add_library(mixloop::${room} ALIAS mixloop_${room})
  target_link_libraries(mixloop_${room} PUBLIC ${arg_PUBLIC} PRIVATE ${arg_PRIVATE})
  mixloop_compiled_as(${kind} mixloop_${room})
  mixloop_compiled_together(${kind} mixloop_${room})
endfunction()

# What is compiled alike. Numbers: what is evaluated in the loop, or a thousand times before or after it. People: what
# waits for people, where optimising costs more time than it saves; no templates of the procedure's or the plant's go
# there, since of equal instances the linker keeps the first. Tests: beside those, GoogleTest.
add_library(mixloop_numbers INTERFACE)
add_library(mixloop_people INTERFACE)
add_library(mixloop_tests INTERFACE)
# Numbers are also what the shared library is made of.
target_compile_options(mixloop_numbers INTERFACE -fPIC -fno-semantic-interposition)
target_compile_options(mixloop_people INTERFACE $<$<CONFIG:Release>:-O1>)
target_compile_options(mixloop_tests INTERFACE $<$<CONFIG:Release>:-O1>)

set(standard <algorithm> <array> <chrono> <cmath> <cstdint> <filesystem> <fstream> <functional> <limits> <map> <memory>
    <optional> <set> <span> <sstream> <string> <string_view> <unordered_map> <utility> <vector>)
# GCC takes a precompiled header only where the same macros are defined: these libraries define some.
target_link_libraries(mixloop_numbers INTERFACE Eigen3::Eigen fmt::fmt)
target_link_libraries(mixloop_people INTERFACE Eigen3::Eigen fmt::fmt nlohmann_json::nlohmann_json CLI11::CLI11)
mixloop_precompiled(numbers ${standard} <Eigen/Dense> <fmt/format.h>)
mixloop_precompiled(people ${standard} <Eigen/Core> <fmt/format.h> <nlohmann/json.hpp>)
if(MIXLOOP_TESTS)
  target_link_libraries(mixloop_tests INTERFACE Eigen3::Eigen fmt::fmt nlohmann_json::nlohmann_json GTest::gmock)
  mixloop_precompiled(tests ${standard} <Eigen/Dense> <fmt/format.h> <nlohmann/json.hpp> <gmock/gmock.h> <gtest/gtest.h>)
endif()
