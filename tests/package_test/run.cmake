# cmake -D BUILD_DIR=... [-D BUILD_TYPE=... -D COMPILER=... -D SANITIZE=...] -P run.cmake
set(work ${BUILD_DIR}/package_test)
file(REMOVE_RECURSE ${work})

function(run)
  execute_process(COMMAND ${ARGV} COMMAND_ERROR_IS_FATAL ANY COMMAND_ECHO STDOUT)
endfunction()

if(SANITIZE)
  set(flags -fsanitize=${SANITIZE})
  # The sanitizers' dlopen() does not look where the program's runtime path says.
  set(ENV{LD_LIBRARY_PATH} ${work}/prefix/lib/vdbmap:$ENV{LD_LIBRARY_PATH})
endif()

run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${work}/prefix)
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${work}/build -G Ninja
  -D CMAKE_PREFIX_PATH=${work}/prefix -D CMAKE_CXX_COMPILER=${COMPILER} -D CMAKE_BUILD_TYPE=${BUILD_TYPE} -D CMAKE_CXX_FLAGS=${flags})
run(${CMAKE_COMMAND} --build ${work}/build)
run(${work}/build/consumer ${work}/poses.txt ${work}/prefix/share/vdbmap/street.kpconv)
if(EXISTS ${work}/prefix/bin/vdbmap)
  run(${work}/prefix/bin/vdbmap evaluate ${work}/poses.txt ${work}/poses.txt --plot ${work}/plot.png)
  # The installed command finds the weights that were installed with it.
  file(WRITE ${work}/cloud.xyz "0 0 0\n0.5 0 0\n0.5 0.5 0\n")
  run(${work}/prefix/bin/vdbmap segment ${work}/cloud.xyz -o ${work}/cloud.label)
endif()
