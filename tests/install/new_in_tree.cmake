# The test install.new_in_tree: what `quell new` writes into quell's source tree builds and passes by the commands that it prints.
#
# The tree is a copy of what is written to, with links to the rest. In place of core/, which nothing here changes and which takes
# long to build, it has the installed libraries.
include(${CMAKE_CURRENT_LIST_DIR}/steps.cmake)

set(tree ${SCRATCH}/tree)
file(COPY ${ROOT}/CMakeLists.txt ${ROOT}/CMakePresets.json ${ROOT}/passes ${ROOT}/tests DESTINATION ${tree})
file(COPY ${ROOT}/graphs DESTINATION ${tree} PATTERN sample EXCLUDE PATTERN images EXCLUDE)
file(CREATE_LINK ${ROOT}/apps ${tree}/apps SYMBOLIC)
file(WRITE ${tree}/core/CMakeLists.txt "find_package(quell REQUIRED GLOBAL)\n")
set(environment CMAKE_PREFIX_PATH=${prefix})
file(CREATE_LINK ${ROOT}/core/cmake ${tree}/core/cmake SYMBOLIC)

# A plugin of its own, and a graph. They are written before the tree is configured, so that it is configured once.
type(${tree} "quell new pass soften_edges --plugin studio")
set(pass_output "${output}")
type(${tree} "quell new graph calm")
type_commands(${tree} "${pass_output}")
type(${tree} "build/release/bin/soften_edges_test")
expect("${output}" "PASSED")
file(READ ${tree}/graphs/quell-graph.schema.json schema)
expect("${schema}" "\"pass_soften_edges\": {")
type(${tree} "quell passes soften_edges --plugin-path build/release/${PASSES_DIR}")
expect("${output}" "studio.so\n$")
# The other sources of graphs_test, and the plugins that it needs, have nothing to do with this one.
type(${tree} "cmake --build --preset release --target tests/graphs/CMakeFiles/graphs_test.dir/calm_test.cpp.o")
type(${tree} "quell check graphs/calm.json")

# A pass of a plugin that is there.
type(${tree} "quell new pass blot")
expect("${output}" "--target spatial blot_test\n")
type(${tree} "cmake --build --preset release --target spatial_blot")
