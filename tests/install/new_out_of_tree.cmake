# The test install.new_out_of_tree: what `quell new` writes, outside quell's tree, builds and passes by the commands that it prints.
include(${CMAKE_CURRENT_LIST_DIR}/steps.cmake)

set(folder "${SCRATCH}/out of tree")
file(MAKE_DIRECTORY ${folder})

type(${folder} "quell new pass soften_edges --plugin studio")
type_commands(${folder} "${output}")
expect("${output}" "^soften_edges, version 1\n.*studio.so\n$")

type(${folder} "quell new graph calm")
type_commands(${folder} "${output}")
expect("${output}" "100% tests passed.*out of 2\n")
foreach(frame 1 2 3 4)
  if(NOT EXISTS "${folder}/calm/out/color.000${frame}.png")
    message(FATAL_ERROR "the picture of frame ${frame} is missing")
  endif()
endforeach()
