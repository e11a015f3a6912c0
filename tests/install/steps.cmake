# What the scripts of this folder share. SCRATCH is the folder of them all, and holds the installed quell.
cmake_minimum_required(VERSION 3.25)
set(prefix ${SCRATCH}/moved)
# With ccache, only the first of many runs takes long.
find_program(CCACHE ccache)
if(CCACHE)
  set(ENV{CMAKE_CXX_COMPILER_LAUNCHER} ${CCACHE})
endif()

# run(COMMAND...): fails with all that the command printed when it fails; else its standard output is in `output`.
function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE err)
  string(REPLACE ";" " " command "${ARGV}")
  if(NOT code EQUAL 0)
    message("${out}${err}")
    message(FATAL_ERROR "${command} ended with ${code}")
  endif()
  set(output "${out}" PARENT_SCOPE)
endfunction()

function(expect text pattern)
  if(NOT text MATCHES "${pattern}")
    message("${text}")
    message(FATAL_ERROR "'${pattern}' is not in the text above")
  endif()
endfunction()

# type(FOLDER COMMAND): a line as a person types it in that folder, with the installed quell in PATH, and what is in `environment`.
# Warnings are errors; but sanitizers make compilers see ghosts in the code that they add.
function(type folder command)
  set(flags "-Wall -Wextra -Werror")
  if(FLAGS)
    set(flags ${FLAGS})
  endif()
  run(${CMAKE_COMMAND} -E chdir ${folder} ${CMAKE_COMMAND} -E env PATH=${prefix}/bin:$ENV{PATH} CMAKE_GENERATOR=${GENERATOR}
    CXX=${COMPILER} "CXXFLAGS=${flags}" ${environment} sh -c "${command}")
  set(output "${output}" PARENT_SCOPE)
endfunction()

# type_commands(FOLDER TEXT): types every command that `quell new` printed, below the list of files that it wrote.
function(type_commands folder text)
  string(REGEX REPLACE "^written\n(  [^\n]*\n)+" "" rest "${text}")
  string(REGEX MATCHALL "\n  [^\n]+" commands "${rest}")
  list(LENGTH commands count)
  if(count LESS 3)
    message(FATAL_ERROR "three commands or more are missing in\n${text}")
  endif()
  foreach(command IN LISTS commands)
    string(STRIP "${command}" command)
    type(${folder} "${command}")
  endforeach()
  set(output "${output}" PARENT_SCOPE)
endfunction()
