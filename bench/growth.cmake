# Forward dynamics against a mechanism's size; bench/growth makes the table and the figure.
add_executable(mixloop-bench-growth growth.cpp)
target_link_libraries(mixloop-bench-growth PRIVATE mixloop::dynamics mixloop::oracles)
