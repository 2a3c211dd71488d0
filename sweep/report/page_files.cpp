#include "sweep/report/page_files.hpp"

#include "sweep/report/embedded_file.hpp"

// The build names the files (sweep/report/page/embed.cmake).
GRAINSWEEP_EMBED(page_html, PAGE_FOLDER "/page.html");
GRAINSWEEP_EMBED(page_css, PAGE_FOLDER "/page.css");
GRAINSWEEP_EMBED(page_js, PAGE_PROGRAM);
GRAINSWEEP_EMBED(window_js, WINDOW_PROGRAM);
GRAINSWEEP_EMBED(chart_js, CHART_JS);

namespace grainsweep::report {

PageFiles page_files() {
    return {GRAINSWEEP_EMBEDDED(page_html), GRAINSWEEP_EMBEDDED(page_css), GRAINSWEEP_EMBEDDED(page_js),
            GRAINSWEEP_EMBEDDED(window_js), GRAINSWEEP_EMBEDDED(chart_js)};
}

}  // namespace grainsweep::report
