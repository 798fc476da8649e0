# SPDX-License-Identifier: GPL-3.0-or-later
# Language, warnings, sanitizers: one interface target that every target of ours links privately.
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()
set(CMAKE_CXX_STANDARD 17) # ViSP 3.5's headers do not compile as C++20 with g++ 12
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_CXX_FLAGS_RELEASE "-O3 -DNDEBUG")

option(EYESLAM_TESTS "Build the tests" ON)
option(EYESLAM_FUZZERS "Build the libFuzzer targets (needs clang)" OFF)
option(EYESLAM_WERROR "Treat warnings as errors" ON)
set(EYESLAM_SANITIZE "" CACHE STRING "Sanitizers, as for -fsanitize= (address,undefined or thread)")

find_program(CCACHE ccache)
if(CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE})
endif()

add_library(eyeslam_build_options INTERFACE)
target_compile_options(eyeslam_build_options INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wshadow $<$<BOOL:${EYESLAM_WERROR}>:-Werror>
  $<$<CXX_COMPILER_ID:Clang>:-Wno-sign-conversion>) # which g++ leaves out of -Wconversion
add_link_options(-Wl,--as-needed) # or every test would load OpenCV's windows
set(EYESLAM_SANITIZED OFF)
if(EYESLAM_SANITIZE)
  set(EYESLAM_SANITIZED ON)
  add_compile_options(-fsanitize=${EYESLAM_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all -O1
    -g1 -UNDEBUG -D_GLIBCXX_ASSERTIONS)
  add_link_options(-fsanitize=${EYESLAM_SANITIZE})
endif()
if(EYESLAM_FUZZERS)
  add_compile_options(-fsanitize=fuzzer-no-link)
endif()
