# What every target of this tree shares: language, warnings, sanitizers, and one shape for the build and the install tree, so that
# the loader finds the passes in both without being told.
include(GNUInstallDirs)

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()

find_program(CCACHE ccache)
if(CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE})
endif()

set(QUELL_PASSES_DIR ${CMAKE_INSTALL_LIBDIR}/quell/passes)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/${CMAKE_INSTALL_LIBDIR})
set(CMAKE_BUILD_RPATH_USE_ORIGIN ON)

# `core/` is included as `quell/`, here as after installation.
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/include)
file(CREATE_LINK ${PROJECT_SOURCE_DIR}/core ${PROJECT_BINARY_DIR}/include/quell SYMBOLIC)

set(QUELL_SANITIZE "" CACHE STRING "Sanitizers for every target, such as address,undefined")

# Private to this tree, so it is not exported.
add_library(quell_flags INTERFACE)
target_compile_options(quell_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wno-missing-field-initializers
  # A sum that is contracted differently by two compilers, or for two targets, would not be reproducible.
  -ffp-contract=off
  $<$<BOOL:${QUELL_WERROR}>:-Werror>)
if(QUELL_SANITIZE)
  target_compile_options(quell_flags INTERFACE -fsanitize=${QUELL_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(quell_flags INTERFACE -fsanitize=${QUELL_SANITIZE})
endif()
