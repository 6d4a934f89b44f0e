# Host bodies, stepping API, plugin, Python, reference manual.
frond_test(test_host_body SOURCES test_host_body.c LABELS unit)
frond_test(test_host_state SOURCES test_host_state.c LABELS unit)
