// Tables of figures that programs of the tests measured, in tests/reference/measured, for the documents.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace grainsweep::tests {

using TableRows = std::vector<std::vector<std::string>>;

/// The table tests/reference/measured/NAME.csv, its head first; cells are separated by semicolons.
[[nodiscard]] TableRows read_measured(const std::string& name);

/// With GRAINSWEEP_WRITE_DOCUMENTS set: replaces the rows that agree with fresh ones in their first `keys` cells,
/// appends the others and writes the table. A run of a few cases keeps the rows of all others.
void remember_measured(const std::string& name, const std::vector<std::string>& head, const TableRows& fresh,
                       std::size_t keys);

}  // namespace grainsweep::tests
