# Target docs: the reference manual of the C interface (build/docs/html, Doxygen from the public headers, errors from the checks in
# the code) and the option reference from the program's own -help (build/docs/options.md). Anything undocumented is an error, each
# argument included.
find_program(FROND_DOXYGEN doxygen)
find_program(FROND_DOC_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH)
if(FROND_DOXYGEN AND FROND_DOC_PYTHON)
  file(GLOB headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/frondsys.h ${PROJECT_SOURCE_DIR}/src/plugin/frondscene.h
    ${PROJECT_SOURCE_DIR}/src/sph_cuda/sph.h ${PROJECT_SOURCE_DIR}/src/sph_cuda/sphfill.h ${PROJECT_SOURCE_DIR}/src/sph_cuda/sphlink.h ${PROJECT_SOURCE_DIR}/src/sph_cuda/sphopen.h ${PROJECT_SOURCE_DIR}/src/ancf_petsc/ancf.h
    ${PROJECT_SOURCE_DIR}/src/ancf_petsc/blocktri.h ${PROJECT_SOURCE_DIR}/src/rigid/rigid.h ${PROJECT_SOURCE_DIR}/src/rigid/shortrange.h
    ${PROJECT_SOURCE_DIR}/src/couple/couple.h ${PROJECT_SOURCE_DIR}/src/couple/couplehost.h)
  list(JOIN headers " " header_words)
  set(FROND_DOC_INPUT "${header_words}")
  set(FROND_DOC_FILTER "\"${FROND_DOC_PYTHON} ${PROJECT_SOURCE_DIR}/docs/doxyfilter.py\"")
  configure_file(${PROJECT_SOURCE_DIR}/docs/Doxyfile.in ${PROJECT_BINARY_DIR}/docs/Doxyfile @ONLY)
  add_custom_target(docs
    COMMAND ${FROND_DOXYGEN} ${PROJECT_BINARY_DIR}/docs/Doxyfile
    COMMAND ${CMAKE_COMMAND} -E env PYTHONDONTWRITEBYTECODE=1 ${FROND_DOC_PYTHON} ${PROJECT_SOURCE_DIR}/docs/optionpage.py $<TARGET_FILE:frond_app> ${PROJECT_BINARY_DIR}/docs/options.md
    DEPENDS frond_app COMMENT "Reference manual" VERBATIM)
endif()
