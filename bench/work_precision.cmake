# Error against CPU time (docs/accuracy.md): tools/accuracy runs it and draws the figures.
set(MIXLOOP_WORK_PRECISION_DEFINITIONS
    MIXLOOP_COMMIT="${MIXLOOP_COMMIT}" MIXLOOP_SCENES="${PROJECT_SOURCE_DIR}/scenes"
    MIXLOOP_EXPERIMENTS="${PROJECT_SOURCE_DIR}/experiments" MIXLOOP_CONVERGED="${PROJECT_SOURCE_DIR}/bench/converged")

find_path(MIXLOOP_SUNDIALS_INCLUDE_DIR cvode/cvode.h)
set(MIXLOOP_SUNDIALS_FOUND ON)
foreach(part cvode arkode nvecserial)
  find_library(MIXLOOP_SUNDIALS_${part} sundials_${part})
  if(NOT MIXLOOP_SUNDIALS_${part})
    set(MIXLOOP_SUNDIALS_FOUND OFF)
  endif()
endforeach()
if(MIXLOOP_SUNDIALS_INCLUDE_DIR AND MIXLOOP_SUNDIALS_FOUND)
  set(MIXLOOP_SUNDIALS_SOURCE work_precision_sundials.cpp)
else()
  message(STATUS "bench: SUNDIALS is left out of the comparison (package libsundials-dev)")
  set(MIXLOOP_SUNDIALS_SOURCE work_precision_no_sundials.cpp)
endif()

add_executable(
  mixloop-bench-work-precision
  work_precision.cpp work_precision_cases.cpp work_precision_converged.cpp work_precision_peers.cpp
  ${MIXLOOP_SUNDIALS_SOURCE} ${MIXLOOP_MUJOCO_SOURCE} ${MIXLOOP_SIMBODY_SOURCE})
target_compile_definitions(mixloop-bench-work-precision PRIVATE ${MIXLOOP_WORK_PRECISION_DEFINITIONS})
target_link_libraries(mixloop-bench-work-precision PRIVATE bench_textbook mixloop::loop mixloop::oracles)
if(MIXLOOP_SUNDIALS_SOURCE STREQUAL work_precision_sundials.cpp)
  target_include_directories(mixloop-bench-work-precision SYSTEM PRIVATE ${MIXLOOP_SUNDIALS_INCLUDE_DIR})
  target_link_libraries(
    mixloop-bench-work-precision PRIVATE ${MIXLOOP_SUNDIALS_cvode} ${MIXLOOP_SUNDIALS_arkode}
                                         ${MIXLOOP_SUNDIALS_nvecserial})
endif()
if(mujoco_FOUND)
  target_link_libraries(mixloop-bench-work-precision PRIVATE mujoco::mujoco)
endif()
if(Simbody_FOUND)
  target_link_libraries(mixloop-bench-work-precision PRIVATE ${Simbody_LIBRARIES})
endif()

add_executable(mixloop-bench-energy-drift energy_drift.cpp)
target_compile_definitions(mixloop-bench-energy-drift PRIVATE ${MIXLOOP_WORK_PRECISION_DEFINITIONS})
target_link_libraries(mixloop-bench-energy-drift PRIVATE mixloop::loop)
