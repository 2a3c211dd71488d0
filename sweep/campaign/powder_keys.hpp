// Keys of a powder file.
#pragma once

#include "sweep/campaign/keys.hpp"

#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace grainsweep::campaign::powder_keys {

[[nodiscard]] std::span<const Field> top();
[[nodiscard]] std::span<const Field> material();
[[nodiscard]] std::span<const Field> contacts();
[[nodiscard]] std::span<const Field> sizes();
[[nodiscard]] std::span<const Field> lognormal();
[[nodiscard]] std::span<const Field> rosin_rammler();
[[nodiscard]] std::span<const Field> cut();
[[nodiscard]] std::span<const Field> measured();
/// Returns all keys, by their object.
[[nodiscard]] std::vector<std::pair<std::string_view, std::span<const Field>>> all();

}  // namespace grainsweep::campaign::powder_keys
