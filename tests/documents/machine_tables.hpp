// Generated tables of docs/machines_reference.md, from the tables that the program reads machine files with.
#pragma once

#include <string>
#include <string_view>

namespace grainsweep::tests {

/// Keys of every object, one table under a heading each.
[[nodiscard]] std::string machine_keys_tables();
/// `what`: shapes, regions, probes, options (of probes), reductions.
[[nodiscard]] std::string machine_table(std::string_view what);

}  // namespace grainsweep::tests
