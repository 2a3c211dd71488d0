// `status` for reading: a block per campaign, a unit on every number.
#pragma once

#include "sweep/live/now.hpp"
#include "sweep/store/store.hpp"

#include <iosfwd>

namespace grainsweep::cli {

/// The rows of Store::status(). Outcomes that no case has are left out; a column this function does not know is shown
/// by its name.
void write_status(std::ostream& out, const store::Table& status);

/// The cases that a run computes now, one row each: case, point, each factor, done (0 to 1), seconds, attempt, host.
/// The first `most` only.
[[nodiscard]] store::Table running_cases(const store::Store& archive, const live::Now& now, std::size_t most);
/// What the run says of itself, and its running cases.
void write_now(std::ostream& out, const store::Store& archive, const live::Now& now);

}  // namespace grainsweep::cli
