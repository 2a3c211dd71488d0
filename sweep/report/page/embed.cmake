# The files the report's page is made of are compiled into the program byte for byte: sweep/report/page_files.cpp
# takes them in by the assembler's .incbin, so that a report needs no file at run time.
find_file(CHART_JS chart.min.js
  PATHS /usr/share/javascript/chart.js /usr/share/nodejs/chart.js/dist /usr/share/javascript/chartjs
  DOC "Chart.js 3, as the distribution packages it (libjs-chart.js)")
if(NOT CHART_JS)
  message(FATAL_ERROR "Chart.js is missing: install libjs-chart.js, or set CHART_JS to its chart.min.js")
endif()
set(PAGE_FOLDER "${CMAKE_SOURCE_DIR}/sweep/report/page")
set_source_files_properties(sweep/report/page_files.cpp PROPERTIES
  COMPILE_DEFINITIONS "CHART_JS=\"${CHART_JS}\";PAGE_FOLDER=\"${PAGE_FOLDER}\""
  OBJECT_DEPENDS "${CHART_JS};${PAGE_FOLDER}/page.html;${PAGE_FOLDER}/page.css;${PAGE_FOLDER}/page.js")
