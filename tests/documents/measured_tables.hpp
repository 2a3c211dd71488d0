// Generated tables of figures that programs of the tests measured.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace grainsweep::tests {

/// The table tests/reference/measured/NAME.csv; `crossed`: a line by first cell, a column by second, the third in it.
[[nodiscard]] std::string measured_table(const std::string& name, bool crossed);
/// Machines beside LIGGGHTS: the cases of tests/reference/*/ensembles.csv with these names. `unit_of`: by machine and
/// observable.
[[nodiscard]] std::string liggghts_table(const std::vector<std::string>& cases,
                                         const std::map<std::pair<std::string, std::string>, std::string>& unit_of);

}  // namespace grainsweep::tests
