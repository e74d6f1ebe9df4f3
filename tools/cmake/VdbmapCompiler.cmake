# Flags of every target of ours: vdbmap_compiler is linked privately and never installed.
add_library(vdbmap_compiler INTERFACE)
target_compile_options(vdbmap_compiler INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor)
if(VDBMAP_WARNINGS_AS_ERRORS)
  target_compile_options(vdbmap_compiler INTERFACE -Werror)
endif()
if(VDBMAP_MARCH AND CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  # A target with the property is compiled for any x86-64 processor.
  target_compile_options(vdbmap_compiler INTERFACE $<IF:$<BOOL:$<TARGET_PROPERTY:VDBMAP_PLAIN>>,-march=x86-64,-march=${VDBMAP_MARCH}>)
endif()
# A product and a sum are rounded one after the other, on every processor alike: the same input gives the same bytes.
target_compile_options(vdbmap_compiler INTERFACE $<$<CXX_COMPILER_ID:GNU,Clang,AppleClang>:-ffp-contract=off>)
if(VDBMAP_SANITIZE)
  # Undefined behaviour is looked for in what is tested: in the macros of the tests that would take half of their compilation.
  string(REPLACE "," ";" sanitizers ${VDBMAP_SANITIZE})
  foreach(sanitizer ${sanitizers})
    set(is_meant 1)
    if(sanitizer STREQUAL "undefined")
      set(is_meant $<NOT:$<BOOL:$<TARGET_PROPERTY:VDBMAP_IS_TEST>>>)
    endif()
    target_compile_options(vdbmap_compiler INTERFACE $<${is_meant}:-fsanitize=${sanitizer}>)
  endforeach()
  target_compile_options(vdbmap_compiler INTERFACE -fno-omit-frame-pointer -fno-sanitize-recover=undefined)
  # oneTBB marks entries of its tables by small numbers instead of addresses: Clang takes them for addresses, and stops.
  if(VDBMAP_SANITIZE MATCHES "undefined")
    target_compile_options(vdbmap_compiler INTERFACE $<$<CXX_COMPILER_ID:Clang>:-fno-sanitize=alignment>
      $<$<CXX_COMPILER_ID:Clang>:-fsanitize-ignorelist=${PROJECT_SOURCE_DIR}/tests/not_sanitized_code.txt>)
  endif()
  # Bad addresses are seen by the address sanitizer when they are used: looking at every pointer twice would take a quarter
  # of the compilation.
  if(VDBMAP_SANITIZE MATCHES "undefined" AND VDBMAP_SANITIZE MATCHES "address")
    target_compile_options(vdbmap_compiler INTERFACE
      $<$<CXX_COMPILER_ID:Clang>:-fno-sanitize=null,object-size,vptr,pointer-overflow,nonnull-attribute,returns-nonnull-attribute>)
  endif()
  # GCC warns of values that its own instrumentation makes look uninitialized.
  target_compile_options(vdbmap_compiler INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  target_link_options(vdbmap_compiler INTERFACE -fsanitize=${VDBMAP_SANITIZE})
endif()

# Does not optimize a target under sanitizers, where that takes two thirds of the compilation of tests and commands: what takes their
# time is done in the libraries. What is inline in both is taken from those, optimized.
function(vdbmap_optimize_libraries_only target)
  if(NOT VDBMAP_SANITIZE)
    return()
  endif()
  target_compile_options(${target} PRIVATE -O0)
  get_target_property(type ${target} TYPE)
  if(type STREQUAL "EXECUTABLE")
    target_link_options(${target} PRIVATE
      LINKER:--whole-archive $<TARGET_FILE:vdbmap> $<TARGET_FILE:vdbmap_registration> $<TARGET_FILE:vdbmap_parking> LINKER:--no-whole-archive)
  endif()
endfunction()

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE_PROGRAM})
  # Without it every build gets another precompiled header, and ccache never hits.
  target_compile_options(vdbmap_compiler INTERFACE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
endif()
