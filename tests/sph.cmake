frond_test(test_sph_channel SOURCES test_sph_channel.c LABELS validation)
frond_test(test_sph_periodic SOURCES test_sph_periodic.c LABELS validation)
frond_test(test_sph_periodic_fine SOURCES test_sph_periodic.c ARGS -fine LABELS validation-long TIMEOUT 1200)
