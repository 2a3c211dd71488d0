// The design of a stored campaign as it was asked: what an archive keeps as text, in the types of a request.
#pragma once

#include "sweep/campaign/identity.hpp"
#include "sweep/designs/design.hpp"

namespace grainsweep::campaign {

/// Options, levels and ranges; listed rows are left out, they stand in the places of the campaign. Throws
/// std::logic_error for a design that this program does not know.
[[nodiscard]] designs::DesignRequest request_of(const Identity& identity);

}  // namespace grainsweep::campaign
