// Keys of a powder file.
#pragma once

#include "sweep/campaign/keys.hpp"

#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace grainsweep::campaign::powder_keys {

[[nodiscard]] std::span<const Key> top();
[[nodiscard]] std::span<const Key> material();
[[nodiscard]] std::span<const Key> contacts();
[[nodiscard]] std::span<const Key> sizes();
[[nodiscard]] std::span<const Key> lognormal();
[[nodiscard]] std::span<const Key> rosin_rammler();
[[nodiscard]] std::span<const Key> cut();
[[nodiscard]] std::span<const Key> measured();
/// Returns all keys, by their object.
[[nodiscard]] std::vector<std::pair<std::string_view, std::span<const Key>>> all();

}  // namespace grainsweep::campaign::powder_keys
