// Keys of a machine file, one table per object. Shapes, regions, motions and contacts are those of the solver; a table
// that holds some of them is a function.
#pragma once

#include "sweep/campaign/keys.hpp"

#include <span>
#include <string_view>

namespace grainsweep::campaign::machine_keys {

[[nodiscard]] std::span<const Field> top();
extern const std::span<const Field> parameter;
extern const std::span<const Field> extent;
extern const std::span<const Field> gravity;
extern const std::span<const Field> domain;
extern const std::span<const Field> material;
[[nodiscard]] std::span<const Field> contacts();
extern const std::span<const Field> species;
extern const std::span<const Field> sizes;
extern const std::span<const Field> grain_shape;
[[nodiscard]] std::span<const Field> wall();
[[nodiscard]] std::span<const Field> motion();
extern const std::span<const Field> follow;
extern const std::span<const Field> fill;
extern const std::span<const Field> sphere;
extern const std::span<const Field> removal;
extern const std::span<const Field> feed;
extern const std::span<const Field> phase;
extern const std::span<const Field> until;
extern const std::span<const Field> known;
extern const std::span<const Field> again;
extern const std::span<const Field> start;
extern const std::span<const Field> check;
extern const std::span<const Field> scale;
extern const std::span<const Field> measure;
extern const std::span<const Field> time_of;
extern const std::span<const Field> expression;
[[nodiscard]] std::span<const Type> shapes();
[[nodiscard]] std::span<const Type> regions();
[[nodiscard]] std::span<const Type> motions();
/// Returns the probes with their options.
[[nodiscard]] std::span<const Type> probes();

/// Returns all types but shapes and regions, in the order of the reference. Their names are its headings.
[[nodiscard]] std::span<const Type> all();

}  // namespace grainsweep::campaign::machine_keys
