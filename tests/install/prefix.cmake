# The test install.prefix: quell is installed, and moved, for the others.
include(${CMAKE_CURRENT_LIST_DIR}/steps.cmake)

file(REMOVE_RECURSE ${SCRATCH})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${SCRATCH}/first)
# Nothing may remember where it was installed to.
file(RENAME ${SCRATCH}/first ${prefix})
