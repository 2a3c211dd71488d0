// Text of results_schema/, compiled in: the statements that update a file of each version.
#pragma once

#include <span>
#include <string_view>

namespace grainsweep::store {

/// Returns the migrations in order; the first n have been applied to a database of user_version n.
[[nodiscard]] std::span<const std::string_view> schema_migrations();
/// Returns the script that drops and creates the fixed views; it runs after every migration.
[[nodiscard]] std::string_view schema_views();

}  // namespace grainsweep::store
