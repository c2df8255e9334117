# The paper's robot in every engine at hand: one table (bench/README.md).

# Everything that is compared gets the processor's own instructions and the same optimisation.
set(MIXLOOP_BENCH_FLAGS -O3 -march=native -fno-math-errno -Wno-psabi)

execute_process(COMMAND git -C ${PROJECT_SOURCE_DIR} rev-parse --short HEAD OUTPUT_VARIABLE MIXLOOP_COMMIT
                OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)

# The same source twice. `hand_tuned` is renamed in the second, so that the linker can't merge the two.
add_library(bench_hand_tuned OBJECT hand_tuned_engines.cpp)
target_link_libraries(bench_hand_tuned PRIVATE mixloop_options)
target_compile_options(bench_hand_tuned PRIVATE ${MIXLOOP_BENCH_FLAGS})
add_library(bench_hand_tuned_contracted OBJECT hand_tuned_engines.cpp)
target_include_directories(bench_hand_tuned_contracted PRIVATE ${PROJECT_SOURCE_DIR})  # mixloop_options forbid it
target_compile_options(bench_hand_tuned_contracted PRIVATE ${MIXLOOP_BENCH_FLAGS} -ffp-contract=fast)
target_compile_definitions(bench_hand_tuned_contracted PRIVATE MIXLOOP_FUSED hand_tuned=hand_tuned_fused)

add_library(bench_textbook OBJECT peers_textbook.cpp)
target_include_directories(bench_textbook PRIVATE ${PROJECT_SOURCE_DIR})
target_link_libraries(bench_textbook PRIVATE Eigen3::Eigen)
target_compile_options(bench_textbook PRIVATE ${MIXLOOP_BENCH_FLAGS} -ffp-contract=fast)
target_compile_definitions(bench_textbook PRIVATE NDEBUG)

find_package(mujoco QUIET)
if(mujoco_FOUND)
  set(MIXLOOP_MUJOCO_SOURCE peers_mujoco.cpp)
  # Debian's target names an include directory that its packages don't ship.
  set_target_properties(mujoco::mujoco PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "")
else()
  message(STATUS "bench: MuJoCo is left out of the comparison (package libmujoco-dev)")
  set(MIXLOOP_MUJOCO_SOURCE peers_no_mujoco.cpp)
endif()
find_package(Simbody QUIET)
if(Simbody_FOUND)
  # Its headers are no C++20, and lay classes out differently under NDEBUG than the packaged library does.
  add_library(bench_simbody OBJECT peers_simbody.cpp)
  set_target_properties(bench_simbody PROPERTIES CXX_STANDARD 17)
  target_include_directories(bench_simbody PRIVATE ${PROJECT_SOURCE_DIR})
  target_include_directories(bench_simbody SYSTEM PRIVATE ${Simbody_INCLUDE_DIR})
  target_compile_options(bench_simbody PRIVATE ${MIXLOOP_BENCH_FLAGS} -UNDEBUG -w)
  set(MIXLOOP_SIMBODY_SOURCE $<TARGET_OBJECTS:bench_simbody>)
else()
  message(STATUS "bench: Simbody is left out of the comparison (package libsimbody-dev)")
  set(MIXLOOP_SIMBODY_SOURCE peers_no_simbody.cpp)
endif()

add_executable(
  mixloop-bench-dynamics
  forward_dynamics.cpp mixloop_engines.cpp ${MIXLOOP_MUJOCO_SOURCE} ${MIXLOOP_SIMBODY_SOURCE})
target_compile_definitions(mixloop-bench-dynamics PRIVATE MIXLOOP_COMMIT="${MIXLOOP_COMMIT}"
                                                  MIXLOOP_SCENES="${PROJECT_SOURCE_DIR}/scenes")
target_link_libraries(
  mixloop-bench-dynamics PRIVATE bench_hand_tuned bench_hand_tuned_contracted bench_textbook mixloop::dynamics
                                 mixloop::oracles)
if(mujoco_FOUND)
  target_link_libraries(mixloop-bench-dynamics PRIVATE mujoco::mujoco)
endif()
if(Simbody_FOUND)
  target_link_libraries(mixloop-bench-dynamics PRIVATE ${Simbody_LIBRARIES})
endif()

# Mechanisms whose chains close, beside the peers' own constraints.
if(Simbody_FOUND)
  add_library(bench_closed_simbody OBJECT closed_simbody.cpp closed_simbody_platforms.cpp)
  set_target_properties(bench_closed_simbody PROPERTIES CXX_STANDARD 17)
  target_include_directories(bench_closed_simbody PRIVATE ${PROJECT_SOURCE_DIR})
  target_include_directories(bench_closed_simbody SYSTEM PRIVATE ${Simbody_INCLUDE_DIR})
  target_compile_options(bench_closed_simbody PRIVATE ${MIXLOOP_BENCH_FLAGS} -UNDEBUG -w)
  set(MIXLOOP_CLOSED_PEERS $<TARGET_OBJECTS:bench_closed_simbody>)
else()
  set(MIXLOOP_CLOSED_PEERS closed_no_simbody.cpp)
endif()
if(mujoco_FOUND)
  list(APPEND MIXLOOP_CLOSED_PEERS closed_mujoco.cpp closed_mujoco_platforms.cpp)
else()
  list(APPEND MIXLOOP_CLOSED_PEERS closed_no_mujoco.cpp)
endif()
add_executable(mixloop-bench-closed closed_dynamics.cpp closed_pantograph.cpp ${MIXLOOP_CLOSED_PEERS})
target_compile_definitions(mixloop-bench-closed PRIVATE MIXLOOP_COMMIT="${MIXLOOP_COMMIT}"
                                                        MIXLOOP_SCENES="${PROJECT_SOURCE_DIR}/scenes")
target_link_libraries(mixloop-bench-closed PRIVATE mixloop::dynamics mixloop_in_wide)
if(mujoco_FOUND)
  target_link_libraries(mixloop-bench-closed PRIVATE mujoco::mujoco)
endif()
if(Simbody_FOUND)
  target_link_libraries(mixloop-bench-closed PRIVATE ${Simbody_LIBRARIES})
endif()

if(MIXLOOP_TESTS)
  add_executable(hand_tuned_test hand_tuned_test.cpp)
  target_link_libraries(hand_tuned_test PRIVATE mixloop::oracles GTest::gtest_main)
  target_compile_options(hand_tuned_test PRIVATE -Wno-psabi)
  gtest_discover_tests(hand_tuned_test)
endif()
