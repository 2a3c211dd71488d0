// Keys of a powder file.
#pragma once

#include "sweep/campaign/keys.hpp"

#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace grainsweep::campaign::powder_keys {

extern const std::span<const Field> top;
extern const std::span<const Field> material;
[[nodiscard]] std::span<const Field> contacts();
extern const std::span<const Field> sizes;
extern const std::span<const Field> lognormal;
extern const std::span<const Field> rosin_rammler;
extern const std::span<const Field> cut;
extern const std::span<const Field> measured;
/// Returns all keys, by their object.
[[nodiscard]] std::vector<std::pair<std::string_view, std::span<const Field>>> all();

}  // namespace grainsweep::campaign::powder_keys
