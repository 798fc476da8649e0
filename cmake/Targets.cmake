# SPDX-License-Identifier: GPL-3.0-or-later
# src/NAME = target eyeslam_NAME = EyeSLAM::NAME = #include "eyeslam/NAME/..." = namespace eyeslam::NAME.
# A link include/eyeslam -> src lets sources, tests and installed users spell includes alike.
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/include)
file(CREATE_LINK ${PROJECT_SOURCE_DIR}/src ${PROJECT_BINARY_DIR}/include/eyeslam SYMBOLIC)

# eyeslam_library(NAME SOURCES a.cpp ... PUBLIC targets PRIVATE targets): a library of src/NAME.
function(eyeslam_library name)
  cmake_parse_arguments(arg "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(eyeslam_${name} ${arg_SOURCES})
  add_library(EyeSLAM::${name} ALIAS eyeslam_${name})
  set_target_properties(eyeslam_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(eyeslam_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(eyeslam_${name} PUBLIC cxx_std_17)
  target_link_libraries(eyeslam_${name} PUBLIC ${arg_PUBLIC} PRIVATE ${arg_PRIVATE} $<BUILD_INTERFACE:eyeslam_build_options>)
  install(TARGETS eyeslam_${name} EXPORT eyeslamTargets DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/eyeslam/${name}
    FILES_MATCHING PATTERN "*.h")
endfunction()

# eyeslam_program(NAME source.cpp LIBRARIES targets): a program of apps/, installed under its own name.
function(eyeslam_program name source)
  cmake_parse_arguments(arg "" "" "LIBRARIES" ${ARGN})
  add_executable(${name} ${source})
  target_link_libraries(${name} PRIVATE ${arg_LIBRARIES} eyeslam_build_options)
  install(TARGETS ${name} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endfunction()

# Most of a test's building are the headers of others and the optimiser, and most of its time is spent in the libraries.
# -pthread, or the headers would not be the same for all. Fuzzers watch the way through the libraries alone.
set(EYESLAM_TEST_OPTIONS -pthread $<$<CONFIG:Release>:-O1>
  $<$<BOOL:${EYESLAM_FUZZERS}>:-fno-sanitize=fuzzer-no-link>)

# eyeslam_test(folder/name_test LIBRARIES targets [SLOW]): one executable and one ctest entry a test file. SLOW: not
# under sanitizers, such as whole sequences; and optimised as the libraries are, for it spends its time.
function(eyeslam_test path)
  cmake_parse_arguments(arg "SLOW" "TIMEOUT" "LIBRARIES" ${ARGN})
  get_filename_component(name ${path} NAME)
  add_executable(${name} ${PROJECT_SOURCE_DIR}/tests/${path}.cpp)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_link_libraries(${name} PRIVATE ${arg_LIBRARIES} GTest::gtest_main GTest::gmock rapidcheck eyeslam_build_options)
  add_test(NAME ${name} COMMAND ${name})
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 300)
  endif()
  set_tests_properties(${name} PROPERTIES TIMEOUT ${arg_TIMEOUT}
    ENVIRONMENT "EYESLAM_SHARED=${PROJECT_SOURCE_DIR}/../shared;OMP_NUM_THREADS=1;TSAN_OPTIONS=suppressions=${PROJECT_SOURCE_DIR}/tests/thread_sanitizer.supp")
  set_target_properties(${name} PROPERTIES UNITY_BUILD OFF)
  if(arg_SLOW)
    set_tests_properties(${name} PROPERTIES LABELS slow)
    set_target_properties(${name} PROPERTIES EXCLUDE_FROM_ALL ${EYESLAM_SANITIZED})
  else()
    target_compile_options(${name} PRIVATE ${EYESLAM_TEST_OPTIONS})
    target_precompile_headers(${name} REUSE_FROM eyeslam_test_headers)
  endif()
endfunction()
