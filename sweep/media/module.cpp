#include "sweep/media/entries.hpp"

#include <grainsweep_version.hpp>

extern "C" const grainsweep::media::Entries grainsweep_media;
const grainsweep::media::Entries grainsweep_media = {
    GRAINSWEEP_VERSION " " GRAINSWEEP_COMMIT,
    &grainsweep::plot::drawn,
    &grainsweep::report::new_sheet_file,
    &grainsweep::live::open_http_server,
};
