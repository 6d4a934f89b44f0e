frond_test(test_couple_transfer SOURCES test_couple_transfer.c LABELS unit)
frond_test(test_couple_short SOURCES test_couple_short.c LABELS unit validation)
frond_test(test_couple_hydrostatic SOURCES test_couple_hydrostatic.c LABELS validation)
frond_test(test_couple_attach SOURCES test_couple_attach.c LABELS unit TIMEOUT 120)
frond_test(test_couple_many SOURCES test_couple_many.c LABELS unit LIBS OpenMP::OpenMP_C)
frond_test(test_couple_momentum SOURCES test_couple_momentum.c LABELS unit LIBS OpenMP::OpenMP_C)

find_program(FROND_TEST_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH)
add_test(NAME couple_cantilever COMMAND ${FROND_TEST_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/couple_cantilever.py
  $<TARGET_FILE:frond_app> ${CMAKE_CURRENT_BINARY_DIR}/couple_cantilever ${PROJECT_SOURCE_DIR})
set_tests_properties(couple_cantilever PROPERTIES LABELS validation TIMEOUT 600 ENVIRONMENT "OMP_NUM_THREADS=2;OMP_WAIT_POLICY=PASSIVE")
add_test(NAME couple_cantilever_fine COMMAND ${FROND_TEST_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/couple_cantilever.py
  $<TARGET_FILE:frond_app> ${CMAKE_CURRENT_BINARY_DIR}/couple_cantilever_fine ${PROJECT_SOURCE_DIR} 0.02)
set_tests_properties(couple_cantilever_fine PROPERTIES LABELS validation-long TIMEOUT 7200 ENVIRONMENT "OMP_NUM_THREADS=2;OMP_WAIT_POLICY=PASSIVE")
frond_test(test_couple_cylinder SOURCES test_couple_cylinder.c LABELS validation)
add_test(NAME test_couple_cylinder_fine COMMAND test_couple_cylinder -dp 0.125,0.0833333333333,0.0625)
set_tests_properties(test_couple_cylinder_fine PROPERTIES LABELS validation-long TIMEOUT 7200 ENVIRONMENT "OMP_NUM_THREADS=2;OMP_WAIT_POLICY=PASSIVE")
add_test(NAME couple_substeps COMMAND ${FROND_TEST_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/couple_substeps.py
  $<TARGET_FILE:frond_app> ${CMAKE_CURRENT_BINARY_DIR}/couple_substeps ${PROJECT_SOURCE_DIR})
set_tests_properties(couple_substeps PROPERTIES LABELS validation TIMEOUT 600 ENVIRONMENT "OMP_NUM_THREADS=2;OMP_WAIT_POLICY=PASSIVE")
frond_test(test_couple_light SOURCES test_couple_light.c LABELS validation)
frond_test(test_couple_order SOURCES test_couple_order.c LABELS validation)
frond_test(test_couple_array SOURCES test_couple_array.c LABELS validation)
