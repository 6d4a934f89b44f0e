# A few seconds of each fuzz target from the committed corpus; skipped without clang.
add_test(NAME fuzz COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/run.sh ${CMAKE_CURRENT_BINARY_DIR}/fuzz 4)
set_tests_properties(fuzz PROPERTIES LABELS unit SKIP_RETURN_CODE 77 TIMEOUT 1500)
