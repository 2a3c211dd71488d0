// `replay`: computes a stored case again in this process and compares the answers.
#pragma once

#include "sweep/cli/pictures.hpp"
#include "sweep/report/table.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace grainsweep::cli {

struct ReplayRequest {
    std::string database, id;  ///< `id`: id of the case, or its beginning
    PictureRequest pictures;
    std::string path;                 ///< instruction path; empty: as stored
    std::optional<double> tolerance;  ///< relative; empty: equal bits if they can be expected
    std::string keep;                 ///< folder for the case of a program
    std::int64_t threads = 0;         ///< 0: one for each core of the job
};

/// Runs the command and returns the exit code: 0 if both agree. Of a case without an answer it only takes the requested
/// pictures, of its checkpoint. Throws WrongQuestion if there is no stored answer and no picture.
[[nodiscard]] int replay(const ReplayRequest& request, report::Format format);

}  // namespace grainsweep::cli
