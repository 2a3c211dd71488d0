// `replay`: a stored case computed again in this process and compared with what is stored.
#pragma once

#include "sweep/cli/pictures.hpp"
#include "sweep/report/table.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace grainsweep::cli {

struct ReplayRequest {
    std::string database, id;  ///< `id`: of the case, or its beginning
    PictureRequest pictures;
    std::string path;                 ///< instruction path; empty: that of the archive
    std::optional<double> tolerance;  ///< relative; none: bit for bit where that can be expected
    std::string keep;                 ///< folder for the case of a program
    std::int64_t threads = 0;         ///< 0: one for each core of the job
};

/// Returns the exit code: 0 where both agree. Throws WrongQuestion where there is nothing to compare with.
[[nodiscard]] int replay(const ReplayRequest& request, report::Format format);

}  // namespace grainsweep::cli
