// Moments against 40-digit values of samples chosen to break them.
#include "stats/moments.hpp"
#include "stats/random.hpp"
#include "tests/support/reference_table.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

namespace grainsweep::tests::stats_moments_reference_test {

using namespace stats;

std::vector<double> generated(const std::string& name, std::uint64_t seed, std::size_t n) {
    Generator generator(seed);
    const auto u = [&] { return generator.uniform(); };
    std::vector<double> values(n);
    for (auto& value : values) {
        if (name == "uniform")
            value = u();
        else if (name == "offset1e9")
            value = 1e9 + u();
        else if (name == "pareto1")
            value = 1 / (1 - u());
        else if (name == "pareto_half") {
            const double p = 1 / (1 - u());
            value = p * p;
        } else if (name == "zero_inflated") {
            const double a = u();
            const double b = u();
            value = a < 0.25 ? 0 : b;
        } else if (name == "irwin3") {
            const double a = u();
            const double b = u();
            value = a + b + u();
        } else
            throw std::runtime_error("no generator " + name);
    }
    return values;
}

std::map<std::string, std::vector<double>> listed_samples() {
    const ReferenceTable table("moments/moments_samples.csv");
    std::map<std::string, std::vector<double>> samples;
    for (std::size_t r = 0; r < table.size(); ++r) {
        const auto bits = std::strtoull(table.cell(r, "hexbits").c_str(), nullptr, 16);
        samples[table.cell(r, "case")].push_back(std::bit_cast<double>(static_cast<std::uint64_t>(bits)));
    }
    return samples;
}

/// Within tolerance relative to the expected value, or to `scale` where that is larger: a mean is known to a
/// share of the spread, a skewness to a share of 1. NaN only where NaN is expected.
void expect_near(double got, double expected, double scale, double tolerance, const std::string& what) {
    if (std::isnan(expected)) {
        EXPECT_TRUE(std::isnan(got)) << what << " is " << got;
        return;
    }
    constexpr double grain = std::numeric_limits<double>::denorm_min();
    EXPECT_NEAR(got, expected, tolerance * std::max(std::abs(expected), scale) + grain) << what;
}

TEST(MomentsReference, GeneratorsMatch) {
    const ReferenceTable table("moments/moments_generator_check.csv");
    for (std::size_t r = 0; r < table.size(); ++r) {
        const auto values = generated(table.cell(r, "generator"), table.whole(r, "seed"), 5);
        const auto bits = std::strtoull(table.cell(r, "hexbits").c_str(), nullptr, 16);
        EXPECT_EQ(std::bit_cast<std::uint64_t>(values[table.whole(r, "i")]), bits) << "row " << r;
    }
}

TEST(MomentsReference, EverySample) {
    const ReferenceTable table("moments/moments_expected.csv");
    auto samples = listed_samples();
    for (std::size_t r = 0; r < table.size(); ++r) {
        const std::string name = table.cell(r, "case");
        const std::string generator = table.cell(r, "generator");
        const auto values = generator == "listed"
                                ? samples[name]
                                : generated(generator, table.whole(r, "seed"), table.whole(r, "n_total"));
        ASSERT_EQ(values.size(), table.whole(r, "n_total")) << name;
        const Summary s = summarise(values);
        EXPECT_EQ(s.count, static_cast<std::int64_t>(table.whole(r, "n_finite"))) << name;
        EXPECT_EQ(s.excluded, static_cast<std::int64_t>(table.whole(r, "n_nan") + table.whole(r, "n_posinf") +
                                                        table.whole(r, "n_neginf")))
            << name;
        const bool beyond_double = name == "tiny" || name == "subnormal" || name == "huge_1e150";
        EXPECT_EQ(s.representable, !beyond_double) << name;
        const double sd = table.number(r, "sd_pop");
        const double scale = std::isnan(sd) ? 0 : sd;
        expect_near(s.mean, table.number(r, "mean"), scale, 1e-12, name + " mean");
        expect_near(s.median, table.number(r, "median"), 0, 1e-15, name + " median");
        if (s.count > 0) {
            EXPECT_EQ(s.minimum, table.number(r, "min")) << name;
            EXPECT_EQ(s.maximum, table.number(r, "max")) << name;
        }
        if (beyond_double) {
            EXPECT_TRUE(std::isnan(s.kurtosis) && std::isnan(s.g1)) << name;
            continue;
        }
        expect_near(s.sd, sd, 0, 1e-12, name + " sd");
        expect_near(s.g1, table.number(r, "skew_moment_g1"), 1, 1e-12, name + " g1");
        expect_near(s.kurtosis, table.number(r, "kurtosis"), 0, 1e-12, name + " kurtosis");
        expect_near(s.skewness, table.number(r, "skew_pearson2"), 1, 1e-12, name + " skewness");
    }
}

}  // namespace grainsweep::tests::stats_moments_reference_test
