// Files of the pages, compiled in.
#pragma once

#include <string_view>

namespace grainsweep::report {

struct PageFiles {
    std::string_view skeleton;  ///< page.html, with places for style, library, films, data and program
    std::string_view style;
    std::string_view report;   ///< script of the report: the body of a function, as the other scripts
    std::string_view live;     ///< the same, followed by the requests to the server of `serve`
    std::string_view window;   ///< script of the page of a process window
    std::string_view library;  ///< Chart.js (MIT licence)
    std::string_view watch_skeleton, watch_style;
    std::string_view watch;  ///< script of the page of one film
    std::string_view films;  ///< script that plays films in a report
};

[[nodiscard]] PageFiles page_files();

}  // namespace grainsweep::report
