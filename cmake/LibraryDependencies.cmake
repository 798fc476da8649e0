# SPDX-License-Identifier: GPL-3.0-or-later
# What the libraries themselves need. Our build includes it, and so does, installed beside it, eyeslamConfig.cmake.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(OpenCV 4.5 REQUIRED COMPONENTS core imgproc imgcodecs videoio highgui features2d video calib3d)

# In a function, because ViSP's package writes -fopenmp and a language standard into its caller's variables, and Eigen
# would then open threads in code that never asked for them. The imported targets stay.
function(eyeslam_find_visp)
  find_package(VISP 3.5 REQUIRED visp_core visp_io visp_gui visp_robot visp_visual_features visp_vs)
endfunction()
eyeslam_find_visp()

find_package(yaml-cpp REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(fmt REQUIRED)
find_package(Threads REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(LCM REQUIRED IMPORTED_TARGET lcm)
pkg_check_modules(SODIUM REQUIRED IMPORTED_TARGET libsodium)
