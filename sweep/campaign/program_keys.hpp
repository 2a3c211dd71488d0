// Keys of the section "program" of a campaign file, one table per object.
#pragma once

#include "sweep/campaign/keys.hpp"

#include <span>

namespace grainsweep::campaign {

[[nodiscard]] std::span<const Field> program_keys();
[[nodiscard]] std::span<const Field> program_parameter_keys();
[[nodiscard]] std::span<const Field> program_observable_keys();
[[nodiscard]] std::span<const Field> program_from_keys();
[[nodiscard]] std::span<const Field> program_version_keys();

}  // namespace grainsweep::campaign
