# Lockstep against the bare exchange of its messages:
#   tools/in-namespace bin/lockstep_pairs -- bin/lockstep_empty
foreach(program lockstep_bare lockstep_empty)
  add_executable(${program} ${PROJECT_SOURCE_DIR}/bench/${program}.cpp)
  target_link_libraries(${program} PRIVATE mixloop::runtime)
endforeach()
add_executable(lockstep_pairs ${PROJECT_SOURCE_DIR}/bench/lockstep_pairs.cpp)
target_link_libraries(lockstep_pairs PRIVATE mixloop_options nlohmann_json::nlohmann_json)
if(TARGET benchmark::benchmark)
  add_executable(lockstep_pieces ${PROJECT_SOURCE_DIR}/bench/lockstep_pieces.cpp)
  target_link_libraries(lockstep_pieces PRIVATE mixloop::runtime benchmark::benchmark)
endif()
# The same in real time: tools/in-namespace bench/critical_path bin
add_library(path_probe SHARED ${PROJECT_SOURCE_DIR}/bench/path_probe.cpp)
target_link_libraries(path_probe PRIVATE mixloop_options ${CMAKE_DL_LIBS})
