// The text of results_schema/, compiled in: the statements that update a file of each version.
#pragma once

#include <span>
#include <string_view>

namespace grainsweep::store {

/// Migrations in order; a database of user_version n has seen the first n of them.
[[nodiscard]] std::span<const std::string_view> schema_migrations();
/// Drops and creates the fixed views; runs after every migration.
[[nodiscard]] std::string_view schema_views();

}  // namespace grainsweep::store
