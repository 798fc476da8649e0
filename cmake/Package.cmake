# SPDX-License-Identifier: GPL-3.0-or-later
# What `cmake --install` adds to the libraries and programs, so that others find_package(eyeslam).
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/eyeslam)
configure_package_config_file(cmake/eyeslamConfig.cmake.in ${PROJECT_BINARY_DIR}/eyeslamConfig.cmake
  INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/eyeslamConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/eyeslamConfig.cmake ${PROJECT_BINARY_DIR}/eyeslamConfigVersion.cmake
  cmake/LibraryDependencies.cmake DESTINATION ${package_dir})
install(TARGETS eyeslam_opencv eyeslam_visp eyeslam_visp_servo EXPORT eyeslamTargets)
install(EXPORT eyeslamTargets NAMESPACE EyeSLAM:: DESTINATION ${package_dir})
