# The installed tree, used by a project outside of this one.
add_test(NAME package COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/package.sh ${PROJECT_BINARY_DIR} ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_BINARY_DIR}/package)
set_tests_properties(package PROPERTIES LABELS unit TIMEOUT 300)
