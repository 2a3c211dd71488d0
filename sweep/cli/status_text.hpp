// `status` as text: a block per campaign, with units.
#pragma once

#include "sweep/live/now.hpp"
#include "sweep/store/store.hpp"

#include <iosfwd>

namespace grainsweep::cli {

/// Writes the rows of Store::status(). Outcomes without a case are left out. Unknown columns are shown with their
/// names.
void write_status(std::ostream& out, const store::Table& status);

/// Returns the first `most` running cases, one row each: case, point, each factor, done (0 to 1), seconds, attempt,
/// host.
[[nodiscard]] store::Table running_cases(const store::Store& archive, const live::Now& now, std::size_t most);
/// Writes the state of the run and its running cases.
void write_now(std::ostream& out, const store::Store& archive, const live::Now& now);

}  // namespace grainsweep::cli
