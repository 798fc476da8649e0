# SPDX-License-Identifier: GPL-3.0-or-later
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(OpenCV 4.5 REQUIRED COMPONENTS core imgproc imgcodecs videoio highgui features2d video calib3d)

# ViSP appends -fopenmp to every target's flags, and Eigen would then open threads in our own code.
set(flags_before_visp "${CMAKE_CXX_FLAGS}")
find_package(VISP 3.5 REQUIRED visp_core visp_io visp_gui)
set(CMAKE_CXX_FLAGS "${flags_before_visp}")

find_package(yaml-cpp REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(Threads REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(LCM REQUIRED IMPORTED_TARGET lcm)
pkg_check_modules(SODIUM REQUIRED IMPORTED_TARGET libsodium)
if(EYESLAM_TESTS)
  find_package(GTest REQUIRED)
  find_package(rapidcheck REQUIRED)
  find_package(benchmark REQUIRED)
endif()

# Third-party headers as SYSTEM, so that their warnings are not ours.
add_library(eyeslam_opencv INTERFACE)
target_include_directories(eyeslam_opencv SYSTEM INTERFACE $<BUILD_INTERFACE:${OpenCV_INCLUDE_DIRS}>)
target_link_libraries(eyeslam_opencv INTERFACE ${OpenCV_LIBS})
add_library(eyeslam_visp INTERFACE)
target_include_directories(eyeslam_visp SYSTEM INTERFACE $<BUILD_INTERFACE:${VISP_INCLUDE_DIRS}>)
target_link_libraries(eyeslam_visp INTERFACE visp_core visp_io visp_gui)
