# The files the report's page is made of are compiled into the program byte for byte: sweep/report/page_files.cpp
# takes them in by the assembler's .incbin, so that a report needs no file at run time. The page's program is several
# files, by idea; they follow one another in the order below.
find_file(CHART_JS chart.min.js
  PATHS /usr/share/javascript/chart.js /usr/share/nodejs/chart.js/dist /usr/share/javascript/chartjs
  DOC "Chart.js 3, as the distribution packages it (libjs-chart.js)")
if(NOT CHART_JS)
  message(FATAL_ERROR "Chart.js is missing: install libjs-chart.js, or set CHART_JS to its chart.min.js")
endif()
set(PAGE_FOLDER "${CMAKE_SOURCE_DIR}/sweep/report/page")
set(PAGE_SCRIPTS data elements colours svg figure response explore curves calibration model_figures model cases case_panel page)
list(TRANSFORM PAGE_SCRIPTS REPLACE "(.+)" "${PAGE_FOLDER}/\\1.js")
set(PAGE_PROGRAM "${CMAKE_BINARY_DIR}/generated/page_program.js")
add_custom_command(OUTPUT "${PAGE_PROGRAM}"
  COMMAND "${CMAKE_COMMAND}" -E cat ${PAGE_SCRIPTS} > "${PAGE_PROGRAM}"
  DEPENDS ${PAGE_SCRIPTS} VERBATIM)
# The page of a process window is drawn by the same figures.
set(WINDOW_SCRIPTS data elements colours svg figure model_figures window)
list(TRANSFORM WINDOW_SCRIPTS REPLACE "(.+)" "${PAGE_FOLDER}/\\1.js")
set(WINDOW_PROGRAM "${CMAKE_BINARY_DIR}/generated/window_program.js")
add_custom_command(OUTPUT "${WINDOW_PROGRAM}"
  COMMAND "${CMAKE_COMMAND}" -E cat ${WINDOW_SCRIPTS} > "${WINDOW_PROGRAM}"
  DEPENDS ${WINDOW_SCRIPTS} VERBATIM)
add_custom_target(page_program DEPENDS "${PAGE_PROGRAM}" "${WINDOW_PROGRAM}")
add_dependencies(sweep page_program)
set_source_files_properties(sweep/report/page_files.cpp PROPERTIES
  COMPILE_DEFINITIONS "CHART_JS=\"${CHART_JS}\";PAGE_FOLDER=\"${PAGE_FOLDER}\";PAGE_PROGRAM=\"${PAGE_PROGRAM}\";WINDOW_PROGRAM=\"${WINDOW_PROGRAM}\""
  OBJECT_DEPENDS "${CHART_JS};${PAGE_FOLDER}/page.html;${PAGE_FOLDER}/page.css;${PAGE_PROGRAM};${WINDOW_PROGRAM}")

# The player of cases to watch, for a page of its own and for the report.
set(WATCH_FOLDER "${PAGE_FOLDER}/watch")
set(WATCH_SCRIPTS film matrix camera colours shaders painter element shading player)
list(TRANSFORM WATCH_SCRIPTS REPLACE "(.+)" "${WATCH_FOLDER}/\\1.js")
set(WATCH_PLAYER "${CMAKE_BINARY_DIR}/generated/watch_player.js")
add_custom_command(OUTPUT "${WATCH_PLAYER}"
  COMMAND "${CMAKE_COMMAND}" -E cat ${WATCH_SCRIPTS} > "${WATCH_PLAYER}"
  DEPENDS ${WATCH_SCRIPTS} VERBATIM)
add_custom_target(watch_player DEPENDS "${WATCH_PLAYER}")
add_dependencies(sweep watch_player)
set_source_files_properties(sweep/report/watch_page.cpp PROPERTIES
  COMPILE_DEFINITIONS "WATCH_FOLDER=\"${WATCH_FOLDER}\";WATCH_PLAYER=\"${WATCH_PLAYER}\""
  OBJECT_DEPENDS "${WATCH_PLAYER};${WATCH_FOLDER}/page.html;${WATCH_FOLDER}/watch.css;${WATCH_FOLDER}/page.js;${WATCH_FOLDER}/report.js")
