// `replay`: a stored case computed again in this process and compared with what is stored.
#pragma once

#include "sweep/cli/pictures.hpp"
#include "sweep/report/table.hpp"

#include <string>

namespace grainsweep::cli {

/// `id`: of the case, or its beginning; `path`: the instruction path, empty: that of the archive. Returns the exit
/// code: 0 where both agree. Throws WrongQuestion where there is nothing to compare with.
[[nodiscard]] int replay(const std::string& database, const std::string& id, const PictureRequest& wanted,
                         const std::string& path, report::Format format);

}  // namespace grainsweep::cli
