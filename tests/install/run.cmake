# The test install.consumer: what a plugin's author goes through, in a scratch folder.
include(${CMAKE_CURRENT_LIST_DIR}/steps.cmake)

# The consumer is the README's, word for word; the checks of this test are added from outside it.
set(build ${SCRATCH}/build)
run(${CMAKE_COMMAND} -S ${SOURCES}/consumer -B ${build} -G ${GENERATOR} -D CMAKE_PREFIX_PATH=${prefix} -D CMAKE_BUILD_TYPE=Debug
  -D CMAKE_CXX_COMPILER=${COMPILER} -D CMAKE_CXX_FLAGS=${FLAGS} -D CMAKE_PROJECT_my_passes_INCLUDE=${SOURCES}/consumer_host.cmake
  -D QUELL_TEST_SOURCES=${SOURCES} -D QUELL_INCLUDE_DIR=${prefix}/${INCLUDE_DIR})
run(${CMAKE_COMMAND} --build ${build} --parallel 2)
run(${CMAKE_CTEST_COMMAND} --test-dir ${build} --output-on-failure --no-tests=error)

# Both the installed passes and the foreign one are found, with the option, with the variable, and once it is installed, too.
set(plugins ${build}/${PASSES_DIR})
if(EXISTS ${prefix}/bin/quell)
  run(${prefix}/bin/quell passes --plugin-path ${plugins})
  expect("${output}" "invert")
  expect("${output}" "temporal_blend")
endif()
run(${build}/list_passes ${plugins})
expect("${output}" "invert ${plugins}/my_passes.so\n")
expect("${output}" "temporal_blend ${prefix}/${PASSES_DIR}/temporal.so\n")
run(${CMAKE_COMMAND} -E env QUELL_PLUGIN_PATH=${plugins} ${build}/list_passes)
expect("${output}" "invert ${plugins}/my_passes.so\n")
run(${CMAKE_COMMAND} --install ${build} --prefix ${prefix})
run(${build}/list_passes)
expect("${output}" "invert ${prefix}/${PASSES_DIR}/my_passes.so\n")
