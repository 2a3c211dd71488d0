// Keys of the section "program" of a campaign file, one table per object.
#pragma once

#include "sweep/campaign/keys.hpp"

#include <span>

namespace grainsweep::campaign {

extern const std::span<const Field> program_keys;
extern const std::span<const Field> program_parameter_keys;
extern const std::span<const Field> program_observable_keys;
extern const std::span<const Field> program_from_keys;
extern const std::span<const Field> program_version_keys;

}  // namespace grainsweep::campaign
