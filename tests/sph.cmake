frond_test(test_sph_channel SOURCES test_sph_channel.c LABELS validation)
