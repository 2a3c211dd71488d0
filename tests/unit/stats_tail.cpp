// Tails continued beyond what was seen, against distributions with known ends.
#include "stats/confidence.hpp"
#include "stats/tail.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

namespace grainsweep::tests::stats_tail_test {

using stats::Tail;

/// n values of even shares, ascending.
std::vector<double> even_sample(std::size_t n, const std::function<double(double)>& quantile) {
    std::vector<double> values;
    for (std::size_t i = 0; i < n; ++i)
        values.push_back(quantile((static_cast<double>(i) + 0.5) / static_cast<double>(n)));
    return values;
}

double exponential(double u) {
    return -std::log1p(-u);
}

TEST(Tail, OfAnExponentialVariesAsItDoes) {
    constexpr std::size_t n = 4096, together = 8;
    const auto tail = Tail::of(even_sample(n, exponential), true, together);
    ASSERT_TRUE(tail);
    EXPECT_NEAR(tail->shape(), 3.5 / 64, 0.02);  // 0 and the allowance for 256 values
    // Within the outermost shares k R/n an exponential varies by Var[ln U], U even in (k - 1, k).
    double expected = 0;
    for (int k = 0; k < 4; ++k) {
        double sum = 0, squares = 0;
        for (int i = 0; i < 20000; ++i) {
            const double log = std::log(k + (i + 0.5) / 20000);
            sum += log / 20000;
            squares += log * log / 20000;
        }
        expected += (squares - sum * sum) * together / (static_cast<double>(n) * n);
    }
    const double found = tail->variance_of_mean([](double y) { return y; });
    EXPECT_GT(found, expected);
    EXPECT_LT(found, 3 * expected) << "the allowance makes the tail heavier";
    EXPECT_NEAR(tail->variance_of_mean([](double y) { return 3 * y + 5; }), 9 * found, 1e-9 * found);
}

TEST(Tail, EndsWhereTheValuesEnd) {
    EXPECT_FALSE(Tail::of(even_sample(4096, [](double u) { return u; }), true, 8));
    EXPECT_FALSE(Tail::of(even_sample(4096, [](double u) { return std::sin(3 * u); }), false, 8));
    EXPECT_FALSE(Tail::of(even_sample(4096, exponential), false, 8)) << "it begins at 0";
    EXPECT_FALSE(Tail::of(even_sample(60, exponential), true, 8)) << "too few";
    EXPECT_FALSE(Tail::of(std::vector<double>(200, 1.0), true, 8)) << "all equal";
    const auto lognormal = [](double u) { return std::exp(stats::normal_quantile(u)); };
    const auto tail = Tail::of(even_sample(4096, lognormal), true, 8);
    ASSERT_TRUE(tail);
    EXPECT_GT(tail->shape(), 0.25);
}

}  // namespace grainsweep::tests::stats_tail_test
