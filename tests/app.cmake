# The frond command. Its tests are Python programs of Debian's interpreter, which has h5py and numpy.
find_program(FROND_TEST_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH)
if(NOT FROND_TEST_PYTHON)
  find_program(FROND_TEST_PYTHON python3 REQUIRED)
endif()

function(frond_app_test name label)
  add_test(NAME ${name} COMMAND ${CMAKE_COMMAND} -E env PYTHONDONTWRITEBYTECODE=1
    ${FROND_TEST_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/${name}.py $<TARGET_FILE:frond_app> ${CMAKE_CURRENT_BINARY_DIR}/${name} ${PROJECT_SOURCE_DIR})
  set_tests_properties(${name} PROPERTIES LABELS ${label} TIMEOUT 800 SKIP_RETURN_CODE 77 ENVIRONMENT "OMP_NUM_THREADS=2;OMP_WAIT_POLICY=PASSIVE")
endfunction()

frond_app_test(app_badinput unit)
frond_app_test(app_mesh unit)
frond_app_test(app_regions unit)
frond_app_test(app_run unit)
frond_app_test(app_help unit)
frond_app_test(app_probes unit)
frond_app_test(app_sections unit)
frond_app_test(app_loads unit)
frond_app_test(app_checkpoint unit)
frond_app_test(app_motion unit)
frond_app_test(app_study validation)
frond_app_test(app_links unit)
frond_app_test(app_audit unit)
frond_app_test(app_faults unit)
add_test(NAME app_kills COMMAND ${CMAKE_COMMAND} -E env PYTHONDONTWRITEBYTECODE=1
  ${FROND_TEST_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/app_faults.py $<TARGET_FILE:frond_app> ${CMAKE_CURRENT_BINARY_DIR}/app_kills ${PROJECT_SOURCE_DIR} 50)
set_tests_properties(app_kills PROPERTIES LABELS validation-long TIMEOUT 1500 SKIP_RETURN_CODE 77 ENVIRONMENT "OMP_WAIT_POLICY=PASSIVE")
frond_app_test(app_rigid validation)
frond_app_test(app_examples validation)

add_test(NAME app_paraview COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/app_paraview.sh $<TARGET_FILE:frond_app> ${CMAKE_CURRENT_BINARY_DIR}/app_paraview ${CMAKE_CURRENT_SOURCE_DIR})
set_tests_properties(app_paraview PROPERTIES LABELS unit TIMEOUT 120 SKIP_RETURN_CODE 77)

add_test(NAME format COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/format.sh ${PROJECT_SOURCE_DIR})
set_tests_properties(format PROPERTIES LABELS unit TIMEOUT 60 SKIP_RETURN_CODE 77)
frond_app_test(app_bodies validation)
add_test(NAME app_bodies_fine COMMAND ${CMAKE_COMMAND} -E env PYTHONDONTWRITEBYTECODE=1 ${FROND_TEST_PYTHON}
  ${CMAKE_CURRENT_SOURCE_DIR}/app_bodies.py $<TARGET_FILE:frond_app> ${CMAKE_CURRENT_BINARY_DIR}/app_bodies_fine ${PROJECT_SOURCE_DIR} fine)
set_tests_properties(app_bodies_fine PROPERTIES LABELS validation-long TIMEOUT 7200 ENVIRONMENT "OMP_NUM_THREADS=2;OMP_WAIT_POLICY=PASSIVE")
frond_app_test(app_floating validation)
add_test(NAME app_floating_fine COMMAND ${CMAKE_COMMAND} -E env PYTHONDONTWRITEBYTECODE=1 ${FROND_TEST_PYTHON}
  ${CMAKE_CURRENT_SOURCE_DIR}/app_floating.py $<TARGET_FILE:frond_app> ${CMAKE_CURRENT_BINARY_DIR}/app_floating_fine ${PROJECT_SOURCE_DIR} 0.01)
set_tests_properties(app_floating_fine PROPERTIES LABELS validation-long TIMEOUT 7200 ENVIRONMENT "OMP_NUM_THREADS=2;OMP_WAIT_POLICY=PASSIVE")
frond_app_test(app_migration validation-long)
set_tests_properties(app_migration PROPERTIES TIMEOUT 7200)
