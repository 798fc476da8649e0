# SPDX-License-Identifier: GPL-3.0-or-later
include(LibraryDependencies)
find_package(CLI11 REQUIRED)
find_package(spdlog REQUIRED)
if(EYESLAM_TESTS)
  find_package(GTest REQUIRED)
  find_package(rapidcheck REQUIRED)
  find_package(benchmark REQUIRED)
endif()

# Through their imported targets the third-party headers are SYSTEM, so that their warnings are not ours.
add_library(eyeslam_opencv INTERFACE)
set_target_properties(eyeslam_opencv PROPERTIES EXPORT_NAME opencv)
target_link_libraries(eyeslam_opencv INTERFACE ${OpenCV_LIBS})
add_library(eyeslam_visp INTERFACE)
set_target_properties(eyeslam_visp PROPERTIES EXPORT_NAME visp)
target_link_libraries(eyeslam_visp INTERFACE visp_core visp_io visp_gui)
