frond_test(test_sph_engine_pairs SOURCES test_sph_engine_pairs.c LABELS unit)
