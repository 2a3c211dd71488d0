#include "sweep/report/page_files.hpp"

#include <cstddef>

/// `name` is the contents of the file: the assembler copies them between two labels. At namespace scope.
#define EMBED(name, file)                                  \
    __asm__(                                               \
        ".pushsection .rodata\n"                           \
        ".global grainsweep_" #name                        \
        "_begin\n"                                         \
        ".global grainsweep_" #name                        \
        "_end\n"                                           \
        "grainsweep_" #name                                \
        "_begin:\n"                                        \
        ".incbin \"" file                                  \
        "\"\n"                                             \
        "grainsweep_" #name                                \
        "_end:\n"                                          \
        ".byte 0\n"                                        \
        ".popsection\n");                                  \
    extern "C" const char grainsweep_##name##_begin[];     \
    extern "C" const char grainsweep_##name##_end[];       \
    const std::string_view name(grainsweep_##name##_begin, \
                                std::size_t(grainsweep_##name##_end - grainsweep_##name##_begin))

namespace grainsweep::report {
namespace {

// The build defines the folders (sweep/report/page/embed.cmake).
EMBED(page_html, PAGE_FOLDER "/page.html");
EMBED(page_css, PAGE_FOLDER "/page.css");
EMBED(report_js, PAGE_SCRIPTS "/report.js");
EMBED(live_js, PAGE_SCRIPTS "/live.js");
EMBED(window_js, PAGE_SCRIPTS "/window.js");
EMBED(chart_js, CHART_JS);
EMBED(watch_html, PAGE_FOLDER "/watch/page.html");
EMBED(watch_css, PAGE_FOLDER "/watch/watch.css");
EMBED(watch_js, PAGE_SCRIPTS "/watch.js");
EMBED(films_js, PAGE_SCRIPTS "/films.js");

}  // namespace

PageFiles page_files() {
    return {page_html, page_css, report_js, live_js, window_js, chart_js, watch_html, watch_css, watch_js, films_js};
}

}  // namespace grainsweep::report
