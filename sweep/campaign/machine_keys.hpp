// Keys of a machine file, one table per object. Shapes, regions, motions and contacts are those of the solver.
#pragma once

#include "sweep/campaign/keys.hpp"

#include <span>
#include <string_view>

namespace grainsweep::campaign::machine_keys {

[[nodiscard]] std::span<const Field> top();
[[nodiscard]] std::span<const Field> parameter();
[[nodiscard]] std::span<const Field> extent();
[[nodiscard]] std::span<const Field> gravity();
[[nodiscard]] std::span<const Field> domain();
[[nodiscard]] std::span<const Field> material();
[[nodiscard]] std::span<const Field> contacts();
[[nodiscard]] std::span<const Field> species();
[[nodiscard]] std::span<const Field> sizes();
[[nodiscard]] std::span<const Field> grain_shape();
[[nodiscard]] std::span<const Field> wall();
[[nodiscard]] std::span<const Field> motion();
[[nodiscard]] std::span<const Field> follow();
[[nodiscard]] std::span<const Field> fill();
[[nodiscard]] std::span<const Field> sphere();
[[nodiscard]] std::span<const Field> removal();
[[nodiscard]] std::span<const Field> feed();
[[nodiscard]] std::span<const Field> phase();
[[nodiscard]] std::span<const Field> until();
[[nodiscard]] std::span<const Field> known();
[[nodiscard]] std::span<const Field> again();
[[nodiscard]] std::span<const Field> start();
[[nodiscard]] std::span<const Field> check();
[[nodiscard]] std::span<const Field> scale();
[[nodiscard]] std::span<const Field> measure();
[[nodiscard]] std::span<const Field> time_of();
[[nodiscard]] std::span<const Field> expression();
[[nodiscard]] std::span<const Type> shapes();
[[nodiscard]] std::span<const Type> regions();
[[nodiscard]] std::span<const Type> motions();
/// Returns the probes with their options.
[[nodiscard]] std::span<const Type> probes();

/// Returns all types but shapes and regions, in the order of the reference. Their names are its headings.
[[nodiscard]] std::span<const Type> all();

}  // namespace grainsweep::campaign::machine_keys
