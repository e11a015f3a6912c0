# How plugins are built, in quell's own tree and, through find_package(quell), in anybody's. passes/README.md shows all of it.
#
#   quell_add_plugin(PLUGIN)                                  one shared object: PLUGIN.so
#   quell_add_pass(PLUGIN PASS [SOURCES file...] [LINK target...] [TEST file])
#                                                             one pass of it: PASS.cpp, and PASS_test.cpp
include_guard()
include(GNUInstallDirs)

if(NOT DEFINED QUELL_PASSES_DIR)
  set(QUELL_PASSES_DIR ${CMAKE_INSTALL_LIBDIR}/quell/passes)
endif()

# quell_add_plugin(PLUGIN): makes PLUGIN.so, in the build tree's lib/quell/passes as after installation. Plugins see the SDK's
# headers alone, so none links to quell's libraries.
function(quell_add_plugin plugin)
  add_library(${plugin} MODULE)
  set_target_properties(${plugin} PROPERTIES
    PREFIX "" SUFFIX .so LINKER_LANGUAGE CXX
    LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/${QUELL_PASSES_DIR}
    INSTALL_RPATH "$ORIGIN/../..")
  target_link_options(${plugin} PRIVATE -Wl,--no-undefined)  # what is missing shows when it is built, not when it is loaded
  if(TARGET quell_flags)
    target_link_libraries(${plugin} PRIVATE quell_flags)
  endif()
  install(TARGETS ${plugin} LIBRARY DESTINATION ${QUELL_PASSES_DIR})
  set_property(GLOBAL APPEND PROPERTY QUELL_PLUGINS ${plugin})
endfunction()

# quell_add_pass(PLUGIN PASS [SOURCES file...] [LINK target...] [TEST file]): adds a pass to a plugin. PASS.cpp and the further
# SOURCES lie in the current folder or in its subfolder PLUGIN. They are compiled once, into the object library PLUGIN_PASS, which
# the plugin and the unit test share. The test is PASS_test.cpp beside PASS.cpp, or TEST, and is built when BUILD_TESTING is on
# (include(CTest) turns it on); in quell's own tree it is tests/passes/PASS_test.cpp.
function(quell_add_pass plugin pass)
  cmake_parse_arguments(PARSE_ARGV 2 arg "" "TEST" "SOURCES;LINK")
  set(folder ${CMAKE_CURRENT_SOURCE_DIR})
  if(NOT EXISTS ${folder}/${pass}.cpp)
    string(APPEND folder /${plugin})
  endif()
  list(PREPEND arg_SOURCES ${pass}.cpp)
  list(TRANSFORM arg_SOURCES PREPEND ${folder}/)

  set(objects ${plugin}_${pass})
  add_library(${objects} OBJECT ${arg_SOURCES})
  target_link_libraries(${objects} PUBLIC quell::sdk ${arg_LINK})
  target_include_directories(${objects} PRIVATE ${PROJECT_SOURCE_DIR})  # where Highway looks for HWY_TARGET_INCLUDE
  # Two plugins may each have a class of the same name; neither must see the other's.
  set_target_properties(${objects} PROPERTIES
    POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  if(TARGET quell_flags)
    target_link_libraries(${objects} PRIVATE quell_flags)
  endif()
  target_sources(${plugin} PRIVATE $<TARGET_OBJECTS:${objects}>)
  target_link_libraries(${plugin} PRIVATE ${arg_LINK})

  set_property(GLOBAL APPEND PROPERTY QUELL_PASSES "${plugin}/${pass}")
  if(NOT arg_TEST)
    set(arg_TEST ${folder}/${pass}_test.cpp)
  endif()
  cmake_path(ABSOLUTE_PATH arg_TEST BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR})
  if(BUILD_TESTING AND EXISTS ${arg_TEST})
    quell_add_pass_test(${plugin} ${pass} ${arg_TEST})
  endif()
endfunction()

# quell_add_pass_test(PLUGIN PASS FILE): the unit test of a pass, with the pass linked in. GoogleTest must be installed.
function(quell_add_pass_test plugin pass file)
  find_package(GTest REQUIRED)
  include(GoogleTest)
  add_executable(${pass}_test ${file})
  target_link_libraries(${pass}_test PRIVATE ${plugin}_${pass} quell::testing GTest::gmock GTest::gtest_main)
  gtest_discover_tests(${pass}_test DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT 300)
endfunction()
