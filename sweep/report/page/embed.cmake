# Compiles the files of the pages into the program byte for byte (sweep/report/page_files.cpp), so that a report needs
# no file at run time. The script of a page is several files, by idea, in the order below.
find_file(CHART_JS chart.min.js
  PATHS /usr/share/javascript/chart.js /usr/share/nodejs/chart.js/dist /usr/share/javascript/chartjs
  DOC "Chart.js 3, as the distribution packages it (libjs-chart.js)")
if(NOT CHART_JS)
  message(FATAL_ERROR "Chart.js is missing: install libjs-chart.js, or set CHART_JS to its chart.min.js")
endif()
set(PAGE_FOLDER "${CMAKE_SOURCE_DIR}/sweep/report/page")
set(PAGE_SCRIPTS "${CMAKE_BINARY_DIR}/generated")

function(join_scripts NAME)
  set(FILES ${ARGN})
  list(TRANSFORM FILES REPLACE "(.+)" "${PAGE_FOLDER}/\\1.js")
  add_custom_command(OUTPUT "${PAGE_SCRIPTS}/${NAME}.js"
    COMMAND "${CMAKE_COMMAND}" -E cat ${FILES} > "${PAGE_SCRIPTS}/${NAME}.js"
    DEPENDS ${FILES} VERBATIM)
endfunction()

set(SHARED numbers ramp elements)
set(DRAWINGS ${SHARED} data drawings)
set(PLAYER ${SHARED} watch/film watch/matrix watch/camera watch/scales watch/shaders watch/painter watch/shading watch/range watch/player)
set(REPORT ${DRAWINGS} colours svg figure explore curves calibration model cases case_panel page)
join_scripts(report ${REPORT})
join_scripts(live ${REPORT} live)
join_scripts(window ${DRAWINGS} window)
join_scripts(watch ${PLAYER} watch/pair watch/page)
join_scripts(films ${PLAYER} watch/report)

set(PAGE_FILES "${CHART_JS}" "${PAGE_FOLDER}/page.html" "${PAGE_FOLDER}/page.css" "${PAGE_FOLDER}/watch/page.html"
  "${PAGE_FOLDER}/watch/watch.css")
foreach(NAME report live window watch films)
  list(APPEND PAGE_FILES "${PAGE_SCRIPTS}/${NAME}.js")
endforeach()
add_custom_target(page_scripts DEPENDS ${PAGE_FILES})
add_dependencies(sweep page_scripts)
set_source_files_properties(sweep/report/page_files.cpp PROPERTIES
  COMPILE_DEFINITIONS "CHART_JS=\"${CHART_JS}\";PAGE_FOLDER=\"${PAGE_FOLDER}\";PAGE_SCRIPTS=\"${PAGE_SCRIPTS}\""
  OBJECT_DEPENDS "${PAGE_FILES}")
