// Published benchmark suites as machine files: the table tests/reference/peers/cases.json, its cases computed and
// compared, and the figures measured.
#pragma once

#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <vector>

namespace grainsweep::tests {

/// One case of a suite: a machine file, its settings and its checks, as cases.json gives them.
struct PeerCase {
    std::string suite, name;
    bool slow = false;  ///< more than a few seconds
    nlohmann::json given;
    friend std::ostream& operator<<(std::ostream& out, const PeerCase& one) {
        return out << one.suite << " " << one.name;
    }
};

/// All cases of cases.json, in its order.
[[nodiscard]] std::vector<PeerCase> peer_cases(bool slow);
/// Computes the case and expects every reference within its tolerance. With GRAINSWEEP_WRITE_DOCUMENTS it writes the
/// figures into tests/reference/peers/measured.csv, which the table of docs/verification.md shows.
void compare_with_peers(const PeerCase& asked);
/// The rows of that table.
[[nodiscard]] std::vector<std::vector<std::string>> peer_rows();

}  // namespace grainsweep::tests
