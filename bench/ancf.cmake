add_executable(bench_beams bench_beams.c)
target_link_libraries(bench_beams PRIVATE frond)
