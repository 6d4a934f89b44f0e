# Install rules: libfrond, its headers, the frond command, find_package(Frond) and frond.pc.
include(CMakePackageConfigHelpers)

install(TARGETS frond EXPORT FrondTargets
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS frond_app RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(FILES src/frondsys.h src/frondstate.h src/sph_cuda/sph.h src/sph_cuda/sphfill.h src/sph_cuda/sphlink.h src/sph_cuda/sphopen.h src/ancf_petsc/ancf.h src/rigid/rigid.h src/rigid/shortrange.h
  src/couple/couple.h src/couple/couplehost.h src/plugin/frondscene.h
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/frond)
install(FILES LICENSE README.md CHANGELOG.md CITATION.cff DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY examples/ DESTINATION ${CMAKE_INSTALL_DATADIR}/frond/examples
  FILES_MATCHING PATTERN "*.yaml" PATTERN "*.obj" PATTERN "plot_*.py" PATTERN "make_suspension.py" PATTERN "python_tutorial.py" PATTERN "host_*" PATTERN "out_*" EXCLUDE)
install(FILES python/frond.py DESTINATION ${CMAKE_INSTALL_DATADIR}/frond/python)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/Frond)
install(EXPORT FrondTargets NAMESPACE Frond:: DESTINATION ${package_dir})
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/FrondConfig.cmake.in ${PROJECT_BINARY_DIR}/FrondConfig.cmake
  INSTALL_DESTINATION ${package_dir} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/FrondConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/FrondConfig.cmake ${PROJECT_BINARY_DIR}/FrondConfigVersion.cmake DESTINATION ${package_dir})

# MPI's flags as plain words, for pkg-config users that do not compile with mpicc.
set(FROND_PC_CFLAGS "")
foreach(dir ${MPI_C_INCLUDE_DIRS})
  string(APPEND FROND_PC_CFLAGS " -I${dir}")
endforeach()
# Relative to the file itself: cmake --install --prefix may choose another place.
file(RELATIVE_PATH FROND_PC_PREFIX ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
list(JOIN MPI_C_LIBRARIES " " FROND_PC_LIBS)
configure_file(${CMAKE_CURRENT_LIST_DIR}/frond.pc.in ${PROJECT_BINARY_DIR}/frond.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/frond.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
