// Digit permutations of Braaten & Weller (1979), J. Comput. Phys. 33, 249-258.
//
// The rule is p(0) = 0, and each next digit minimises the one-dimensional L2 star discrepancy of {p(1), ..., p(k)}/b.
// If several digits are equally good, the sources chose differently, so two tables are in public use. Both obey the
// rule in every digit (proven by a unit test):
// original  bases 2 to 97; the rows of codes that cite the 1979 paper directly. The row of base 3 is 0 2 1.
//   vc2006    bases 2 to 53; Vandewoestyne & Cools (2006), J. Comput. Appl. Math. 189, 341-361. Differs in
//             bases 5, 7, 11, 29, 31, 41, 43, 47 and 53 (5, 7, 31 and 47 are mirror images).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace grainsweep::designs {

enum class BraatenWellerTable { original, vc2006 };

/// Returns the largest number of factors of a table: 25 (bases to 97) or 16 (bases to 53).
[[nodiscard]] std::size_t braaten_weller_factors(BraatenWellerTable table);

/// Returns the permutation of 0 ... b-1 for the factor-th prime base, factor from 0.
[[nodiscard]] std::span<const std::uint8_t> braaten_weller_permutation(BraatenWellerTable table, std::size_t factor);

}  // namespace grainsweep::designs
