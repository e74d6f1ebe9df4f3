# The patterns of GoogleTest in a file: one a line, with the reason behind a '#'.
function(vdbmap_read_patterns file variable)
  file(STRINGS ${file} lines REGEX "^[^#]")
  list(TRANSFORM lines REPLACE " *#.*" "")
  list(JOIN lines ":" patterns)
  set(${variable} "${patterns}" PARENT_SCOPE)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
endfunction()

# Runs a test program whole, in two halves that may run beside each other: a process a test would cost more than most tests.
# Results: test_results/PROGRAM.HALF.xml in the build folder, which tools/count_tests.sh counts.
function(vdbmap_add_tests program)
  set(filter "*")
  if(VDBMAP_SANITIZE)
    vdbmap_read_patterns(${PROJECT_SOURCE_DIR}/tests/not_sanitized.txt patterns)
    set(filter "*-${patterns}")
  endif()
  if(VDBMAP_SANITIZE MATCHES "address")
    vdbmap_read_patterns(${PROJECT_SOURCE_DIR}/tests/not_address_sanitized.txt patterns)
    string(APPEND filter ":${patterns}")
    # With glibc's table of thread-local blocks the leak check loses its way once OpenImageIO's libraries are loaded.
    set(sanitizer_options ";ASAN_OPTIONS=intercept_tls_get_addr=0;LSAN_OPTIONS=suppressions=${PROJECT_SOURCE_DIR}/tests/leaks_of_others.txt:print_suppressions=0")
  endif()
  foreach(half 1 2)
    math(EXPR index "${half} - 1")
    add_test(NAME ${program}.${half} COMMAND ${program} --gtest_brief=1
      --gtest_output=xml:${PROJECT_BINARY_DIR}/test_results/${program}.${half}.xml)
    set_tests_properties(${program}.${half} PROPERTIES
      ENVIRONMENT "GTEST_TOTAL_SHARDS=2;GTEST_SHARD_INDEX=${index};GTEST_FILTER=${filter}${sanitizer_options}" TIMEOUT 3000)
  endforeach()
endfunction()
