# The whole tick, and the time until programs stand.
add_executable(mixloop-bench-process process.cpp)
target_compile_definitions(mixloop-bench-process PRIVATE MIXLOOP_COMMIT="${MIXLOOP_COMMIT}"
                           MIXLOOP_SCENES="${PROJECT_SOURCE_DIR}/scenes"
                           MIXLOOP_EXPERIMENTS="${PROJECT_SOURCE_DIR}/experiments")
target_link_libraries(mixloop-bench-process PRIVATE mixloop::loop)

# A sweep's closed loops, in lanes and one by one.
add_executable(mixloop-bench-sweep closed_loops.cpp ${MIXLOOP_MUJOCO_SOURCE})
target_compile_definitions(mixloop-bench-sweep PRIVATE MIXLOOP_COMMIT="${MIXLOOP_COMMIT}"
                           MIXLOOP_EXPERIMENTS="${PROJECT_SOURCE_DIR}/experiments")
target_link_libraries(mixloop-bench-sweep PRIVATE mixloop::sweep fmt::fmt $<TARGET_NAME_IF_EXISTS:mujoco::mujoco>)
