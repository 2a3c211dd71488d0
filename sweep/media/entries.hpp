// Functions behind the libraries that only figures, workbooks and the live page need (cairo, libxlsxwriter,
// libmicrohttpd). These load 30 further libraries, which doubles the time in which a process starts. They are in a
// module, which the program loads when it calls one of these functions for the first time:
//
//   module.cpp   in the module grainsweep_media.so: the table of its functions
//   loaded.cpp   in the program: the same functions, each of which calls the module's
//
// Tests link the functions themselves, without a module.
#pragma once

#include "sweep/live/http_server.hpp"
#include "sweep/plot/plot.hpp"
#include "sweep/report/sheet_file.hpp"

namespace grainsweep::media {

struct Entries {
    const char* build;  ///< version and commit; the program's must be equal
    decltype(&plot::drawn) drawn;
    decltype(&report::new_sheet_file) new_sheet_file;
    decltype(&live::open_http_server) open_http_server;
};

}  // namespace grainsweep::media
