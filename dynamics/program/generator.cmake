# What writes programs: the sources, their hash (part of every cached program's key, so that a changed
# generator finds no entry of the old one's), and the texts of functions that emitted code carries.
set(MIXLOOP_GENERATOR_SOURCES
    symbolic/angles.cpp
    symbolic/articulated.cpp
    symbolic/closed_chains.cpp
    symbolic/derivative.cpp
    symbolic/double_double.cpp
    symbolic/dyad.cpp
    symbolic/evaluation_angles.cpp
    symbolic/expression.cpp
    symbolic/graph.cpp
    symbolic/harmonic.cpp
    symbolic/harmonic_energy.cpp
    symbolic/harmonic_equations.cpp
    symbolic/harmonic_form.cpp
    symbolic/harmonic_functions.cpp
    symbolic/harmonic_sum.cpp
    symbolic/inertial.cpp
    symbolic/iterate.cpp
    symbolic/link_frames.cpp
    symbolic/literal.cpp
    symbolic/newton_block.cpp
    symbolic/operation_count.cpp
    symbolic/planar_loop.cpp
    symbolic/polynomial.cpp
    symbolic/recursive.cpp
    symbolic/single_unknown.cpp
    symbolic/three_distances.cpp
    symbolic/torn_block.cpp
    symbolic/tracer.cpp
    program/affine_angles.cpp
    program/short_chains.cpp
    program/program.cpp
    program/source.cpp
    program/statements.cpp
    program/tape.cpp
    program/trace.cpp)

set(MIXLOOP_GENERATOR_HASH "")
file(GLOB generator_headers RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} CONFIGURE_DEPENDS
     symbolic/*.hpp procedure/*.hpp scene/*.hpp program/*.hpp ../notation/formula.hpp ../notation/functions/*.hpp)
foreach(file IN LISTS MIXLOOP_GENERATOR_SOURCES generator_headers)
  file(SHA256 ${CMAKE_CURRENT_SOURCE_DIR}/${file} hash)
  string(SHA256 MIXLOOP_GENERATOR_HASH "${MIXLOOP_GENERATOR_HASH}${hash}")
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
endforeach()

foreach(text fused elementary sincos)
  file(READ ../notation/functions/${text}.hpp MIXLOOP_${text}_TEXT)
  string(REGEX REPLACE "#pragma once\n|#include \"[^\n]*\n" "" MIXLOOP_${text}_TEXT "${MIXLOOP_${text}_TEXT}")
endforeach()
foreach(text lanes steps)
  file(READ program/${text}_text.hpp MIXLOOP_${text}_TEXT)
endforeach()
configure_file(program/function_texts.cpp.in function_texts.cpp @ONLY)
