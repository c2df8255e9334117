# The whole tick, and the time until programs stand.
add_executable(mixloop-bench-process process.cpp)
target_compile_definitions(mixloop-bench-process PRIVATE MIXLOOP_COMMIT="${MIXLOOP_COMMIT}"
                           MIXLOOP_SCENES="${PROJECT_SOURCE_DIR}/scenes"
                           MIXLOOP_EXPERIMENTS="${PROJECT_SOURCE_DIR}/experiments")
target_link_libraries(mixloop-bench-process PRIVATE mixloop::loop)
