# Fails when apps/report/page.html was made from other source than that beside it.
set(report ${CMAKE_CURRENT_LIST_DIR}/../../../apps/report)
execute_process(COMMAND ${CMAKE_COMMAND} -P ${report}/sources.cmake OUTPUT_VARIABLE told COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCH "[0-9a-f]+" stamp "${told}")
string(LENGTH "${stamp}" length)
file(STRINGS ${report}/page.html page REGEX "made from apps/report by npm run build; source ${stamp} ")
if(NOT length EQUAL 64 OR page STREQUAL "")
  message(FATAL_ERROR "apps/report/page.html is out of date; make it again: cd apps/report && npm ci && npm run build")
endif()
