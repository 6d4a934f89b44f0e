# Host bodies, stepping API, plugin, Python, reference manual.
frond_test(test_host_body SOURCES test_host_body.c LABELS unit)
frond_test(test_host_state SOURCES test_host_state.c LABELS unit)

# examples/host_plate.c: deflection within 3 % of thin-plate theory and of the host's own elements, transfer lossless.
add_executable(host_plate ${PROJECT_SOURCE_DIR}/examples/host_plate.c ${PROJECT_SOURCE_DIR}/examples/host_solid.c)
target_link_libraries(host_plate PRIVATE frond m)
add_test(NAME host_plate COMMAND host_plate ${PROJECT_SOURCE_DIR}/examples/host_plate.msh -plate_dp 0.05 -plate_check 0.03)
set_tests_properties(host_plate PROPERTIES LABELS validation TIMEOUT 300 ENVIRONMENT "OMP_NUM_THREADS=2;OMP_WAIT_POLICY=PASSIVE")

add_test(NAME host_plugin COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/host_plugin.sh $<TARGET_FILE:frond> ${CMAKE_CURRENT_BINARY_DIR}/host_plugin)
set_tests_properties(host_plugin PROPERTIES LABELS unit TIMEOUT 120 SKIP_RETURN_CODE 77)

add_test(NAME host_python COMMAND ${CMAKE_COMMAND} -E env PYTHONDONTWRITEBYTECODE=1 FROND_LIBRARY=$<TARGET_FILE:frond> PYTHONPATH=${PROJECT_SOURCE_DIR}/python
  ${FROND_TEST_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/test_host_python.py ${PROJECT_SOURCE_DIR}/examples)
set_tests_properties(host_python PROPERTIES LABELS unit TIMEOUT 200 SKIP_RETURN_CODE 77 ENVIRONMENT "OMP_NUM_THREADS=2;OMP_WAIT_POLICY=PASSIVE")

# The reference manual: every public function, member and enum documented, the option reference made. Needs doxygen.
if(TARGET docs)
  add_test(NAME host_docs COMMAND ${CMAKE_COMMAND} --build ${PROJECT_BINARY_DIR} --target docs)
  set_tests_properties(host_docs PROPERTIES LABELS unit TIMEOUT 200)
endif()

add_test(NAME host_headers COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/host_headers.sh ${PROJECT_SOURCE_DIR})
set_tests_properties(host_headers PROPERTIES LABELS unit TIMEOUT 120 SKIP_RETURN_CODE 77)
