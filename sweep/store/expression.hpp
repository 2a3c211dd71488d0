// The `where` clause: an SQL expression over a case's inputs, evaluated by SQLite itself.
#pragma once

#include "sweep/campaign/campaign.hpp"

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::store {

/// Compiles `expression` over the given parameter names. Deterministic operators and functions only (no
/// sub-select, no random(), no clock). Throws WrongQuestion (at $.where) with SQLite's own words, and the
/// nearest name for an unknown column. An empty expression accepts everything. NULL counts as false.
[[nodiscard]] campaign::Filter make_filter(std::string_view expression, std::span<const std::string> names);

}  // namespace grainsweep::store
