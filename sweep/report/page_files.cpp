#include "sweep/report/page_files.hpp"

#include <cstddef>

// The assembler copies a file between two labels; the build names the files (sweep/report/page/embed.cmake).
#define GRAINSWEEP_EMBED(name, file)                   \
    __asm__(                                           \
        ".pushsection .rodata\n"                       \
        ".global grainsweep_" #name                    \
        "_begin\n"                                     \
        ".global grainsweep_" #name                    \
        "_end\n"                                       \
        "grainsweep_" #name                            \
        "_begin:\n"                                    \
        ".incbin \"" file                              \
        "\"\n"                                         \
        "grainsweep_" #name                            \
        "_end:\n"                                      \
        ".byte 0\n"                                    \
        ".popsection\n");                              \
    extern "C" const char grainsweep_##name##_begin[]; \
    extern "C" const char grainsweep_##name##_end[]

GRAINSWEEP_EMBED(page_html, PAGE_FOLDER "/page.html");
GRAINSWEEP_EMBED(page_css, PAGE_FOLDER "/page.css");
GRAINSWEEP_EMBED(page_js, PAGE_PROGRAM);
GRAINSWEEP_EMBED(chart_js, CHART_JS);

namespace grainsweep::report {
namespace {

std::string_view between(const char* begin, const char* end) {
    return {begin, static_cast<std::size_t>(end - begin)};
}

}  // namespace

PageFiles page_files() {
    return {between(grainsweep_page_html_begin, grainsweep_page_html_end),
            between(grainsweep_page_css_begin, grainsweep_page_css_end),
            between(grainsweep_page_js_begin, grainsweep_page_js_end),
            between(grainsweep_chart_js_begin, grainsweep_chart_js_end)};
}

}  // namespace grainsweep::report
