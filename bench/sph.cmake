add_executable(bench_sph bench_sph.c)
target_link_libraries(bench_sph PRIVATE frond OpenMP::OpenMP_C m)
