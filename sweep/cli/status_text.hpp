// `status` for reading: a block per campaign, a unit on every number.
#pragma once

#include "sweep/store/store.hpp"

#include <iosfwd>

namespace grainsweep::cli {

/// The rows of Store::status(). Outcomes that no case has are left out; a column this function does not know is shown
/// by its name.
void write_status(std::ostream& out, const store::Table& status);

}  // namespace grainsweep::cli
