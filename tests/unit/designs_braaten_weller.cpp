#include "sweep/designs/braaten_weller.hpp"
#include "sweep/designs/radical_inverse.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace grainsweep::tests::designs_braaten_weller_test {

using namespace designs;

/// The rule in whole numbers: b^2 N^2 times the varying part of the squared L2 star discrepancy of the sorted
/// digits, sum_i (2 N d_(i) - (2i - 1) b)^2.
std::int64_t irregularity(std::vector<std::int64_t> digits, std::int64_t base) {
    std::ranges::sort(digits);
    const auto n = static_cast<std::int64_t>(digits.size());
    std::int64_t sum = 0;
    for (std::int64_t i = 1; i <= n; ++i) {
        const std::int64_t gap = 2 * n * digits[static_cast<std::size_t>(i - 1)] - (2 * i - 1) * base;
        sum += gap * gap;
    }
    return sum;
}

/// Counts the digits of a row (the leading zero apart) that no other unused digit would have beaten.
int digits_obeying_the_rule(std::span<const std::uint8_t> row) {
    const auto base = static_cast<std::int64_t>(row.size());
    std::vector<std::int64_t> chosen;
    int obeying = 0;
    for (const std::uint8_t digit : row.subspan(1)) {
        std::int64_t best = std::numeric_limits<std::int64_t>::max();
        for (std::int64_t candidate = 1; candidate < base; ++candidate) {
            if (std::ranges::find(chosen, candidate) != chosen.end()) continue;
            auto tried = chosen;
            tried.push_back(candidate);
            best = std::min(best, irregularity(tried, base));
        }
        chosen.push_back(digit);
        if (irregularity(chosen, base) == best) ++obeying;
    }
    return obeying;
}

TEST(BraatenWeller, EveryDigitUpToBase53ObeysTheRule) {
    for (const auto table : {BraatenWellerTable::original, BraatenWellerTable::vc2006}) {
        int obeying = 0;
        for (std::size_t j = 0; j < 16; ++j) obeying += digits_obeying_the_rule(braaten_weller_permutation(table, j));
        EXPECT_EQ(obeying, 365);  // the sum of b - 1 over the first sixteen primes
    }
}

TEST(BraatenWeller, EveryDigitUpToBase97ObeysTheRule) {
    int obeying = 0;
    for (std::size_t j = 0; j < 25; ++j)
        obeying += digits_obeying_the_rule(braaten_weller_permutation(BraatenWellerTable::original, j));
    EXPECT_EQ(obeying, 1035);
}

TEST(BraatenWeller, RowsArePermutationsThatKeepZero) {
    const auto bases = primes(25);
    for (const auto table : {BraatenWellerTable::original, BraatenWellerTable::vc2006}) {
        for (std::size_t j = 0; j < braaten_weller_factors(table); ++j) {
            const auto row = braaten_weller_permutation(table, j);
            ASSERT_EQ(row.size(), bases[j]);
            EXPECT_EQ(row[0], 0);
            std::vector<std::uint8_t> sorted(row.begin(), row.end());
            std::ranges::sort(sorted);
            for (std::size_t d = 0; d < sorted.size(); ++d) EXPECT_EQ(sorted[d], d);
        }
    }
}

TEST(BraatenWeller, TheTablesDifferWhereTheLiteratureSays) {
    const auto bases = primes(16);
    std::vector<std::uint32_t> different;
    for (std::size_t j = 0; j < 16; ++j)
        if (!std::ranges::equal(braaten_weller_permutation(BraatenWellerTable::original, j),
                                braaten_weller_permutation(BraatenWellerTable::vc2006, j)))
            different.push_back(bases[j]);
    EXPECT_EQ(different, (std::vector<std::uint32_t>{5, 7, 11, 29, 31, 41, 43, 47, 53}));
}

}  // namespace grainsweep::tests::designs_braaten_weller_test
