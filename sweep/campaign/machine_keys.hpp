// Keys of a machine file, one table per object. A "value" in a table is a number, a quantity ("60 um"), or an
// expression of parameters and "let".
#pragma once

#include "sweep/campaign/keys.hpp"

#include <span>
#include <string_view>

namespace grainsweep::campaign::machine_keys {

/// Table with its heading in the reference.
struct Table {
    std::string_view title;
    std::span<const Key> keys;
};

[[nodiscard]] std::span<const Key> top();
[[nodiscard]] std::span<const Key> parameter();
[[nodiscard]] std::span<const Key> gravity();
[[nodiscard]] std::span<const Key> domain();
[[nodiscard]] std::span<const Key> material();
[[nodiscard]] std::span<const Key> contacts();
[[nodiscard]] std::span<const Key> pair();
[[nodiscard]] std::span<const Key> species();
[[nodiscard]] std::span<const Key> sizes();
[[nodiscard]] std::span<const Key> wall();
[[nodiscard]] std::span<const Key> turned();
[[nodiscard]] std::span<const Key> motion();
[[nodiscard]] std::span<const Key> rotate();
[[nodiscard]] std::span<const Key> shift();
[[nodiscard]] std::span<const Key> vibrate();
[[nodiscard]] std::span<const Key> press();
[[nodiscard]] std::span<const Key> drive();
[[nodiscard]] std::span<const Key> free();
[[nodiscard]] std::span<const Key> fill();
[[nodiscard]] std::span<const Key> sphere();
[[nodiscard]] std::span<const Key> feed();
[[nodiscard]] std::span<const Key> phase();
[[nodiscard]] std::span<const Key> until();
[[nodiscard]] std::span<const Key> check();
[[nodiscard]] std::span<const Key> flow_stops();
[[nodiscard]] std::span<const Key> measure();
[[nodiscard]] std::span<const Key> time_of();
[[nodiscard]] std::span<const Key> expression();

/// Form of a shape or region: its key, and the keys of its object.
struct Form {
    std::string_view name, meaning;
    std::span<const Key> keys;
};
[[nodiscard]] std::span<const Form> shapes();
[[nodiscard]] std::span<const Form> regions();

/// Returns all tables, in the order of the reference.
[[nodiscard]] std::span<const Table> all();

}  // namespace grainsweep::campaign::machine_keys
