# Added to the copy of the consumer: a program that lists passes, and one source for each public header, to show that every header
# is installed together with all that it includes.
find_package(quell REQUIRED)
add_executable(list_passes ${QUELL_TEST_SOURCES}/list_passes.cpp)
target_link_libraries(list_passes PRIVATE quell::core)

file(GLOB_RECURSE headers RELATIVE ${QUELL_INCLUDE_DIR} ${QUELL_INCLUDE_DIR}/quell/*.h)
set(text "")
foreach(header IN LISTS headers)
  string(APPEND text "#include \"${header}\"\n")
endforeach()
file(WRITE ${CMAKE_BINARY_DIR}/all_headers.cpp "${text}")
add_library(all_headers OBJECT ${CMAKE_BINARY_DIR}/all_headers.cpp)
target_link_libraries(all_headers PRIVATE quell::testing quell::sequence quell::metrics)
