// The files a page is made of, as they lay on disk when the program was built.
#pragma once

#include <string_view>

namespace grainsweep::report {

struct PageFiles {
    std::string_view
        skeleton;  ///< page.html, with {{style}}, {{library}}, {{films}}, {{data}}, {{program}} where the rest goes
    std::string_view style;    ///< page.css
    std::string_view program;  ///< the page's scripts, one after the other: the body of a function
    std::string_view window;   ///< the same of the page of a process window
    std::string_view library;  ///< Chart.js (MIT licence)
};

[[nodiscard]] PageFiles page_files();

}  // namespace grainsweep::report
