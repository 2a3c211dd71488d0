// When: the archive's only clock.
#pragma once

#include <string>

namespace grainsweep::store {

/// The present in UTC, ISO 8601 with milliseconds: 2026-01-31T12:00:00.000Z.
[[nodiscard]] std::string utc_now();

}  // namespace grainsweep::store
