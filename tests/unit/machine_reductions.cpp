// What becomes of the values of a measurement, against sums by hand.
#include "solver/machine/reduction.hpp"
#include "stats/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>
#include <vector>

namespace grainsweep::tests::machine_reductions_test {

std::vector<Sample> samples(const std::vector<std::pair<double, double>>& pairs) {
    std::vector<Sample> all;
    for (const auto& [time, value] : pairs) all.push_back({.time = time, .value = value});
    return all;
}

double reduced(const char* name, const std::vector<Sample>& values) {
    return machine::find_reduction(name)->of(values);
}

TEST(MachineReductions, AreTheFiguresOfTheValues) {
    const auto four = samples({{0, 3}, {1, -1}, {2, 4}, {4, 2}});
    EXPECT_DOUBLE_EQ(reduced("mean", four), 2);
    EXPECT_DOUBLE_EQ(reduced("first", four), 3);
    EXPECT_DOUBLE_EQ(reduced("last", four), 2);
    EXPECT_DOUBLE_EQ(reduced("min", four), -1);
    EXPECT_DOUBLE_EQ(reduced("max", four), 4);
    EXPECT_DOUBLE_EQ(reduced("largest_magnitude", four), 4);
    EXPECT_DOUBLE_EQ(reduced("largest_magnitude", samples({{0, 3}, {1, -7}})), 7);
    EXPECT_DOUBLE_EQ(reduced("sd", four), std::sqrt((1.0 + 9 + 4 + 0) / 4));
    EXPECT_DOUBLE_EQ(reduced("integral", four), 1 + 1.5 + 6);
    // Mean time 1.75: sum (t - 1.75)(x - 2) = -1.75 + 2.25 + 0.5 + 0, sum (t - 1.75)^2 = 8.75.
    EXPECT_DOUBLE_EQ(reduced("slope", four), 1.0 / 8.75);
    EXPECT_DOUBLE_EQ(reduced("slope", samples({{0, 1}, {2, 7}, {5, 16}})), 3);
}

TEST(MachineReductions, CountValuesWithinBounds) {
    const auto values = [](const std::vector<Sample>& all) {
        std::vector<double> of;
        for (const Sample& sample : all) of.push_back(sample.value);
        return of;
    };
    const auto five = samples({{0, 10}, {1, 8}, {2, 5}, {3, 2}, {4, 0}});
    EXPECT_EQ(values(machine::between_shares(five, 0.2, 0.8)), (std::vector<double>{8, 5, 2})) << "bounds included";
    EXPECT_TRUE(machine::between_shares({}, 0, 1).empty());
    // Another measurement at some of the times, and at others.
    const auto other = samples({{1, 0.1}, {1.5, 0.3}, {2, 0.3}, {3, 0.5}, {4, 0.7}});
    EXPECT_EQ(values(machine::while_between(five, other, 0.1, 0.5)), (std::vector<double>{8, 5, 2}));
    EXPECT_EQ(values(machine::while_between(five, other, 0.2, 1)), (std::vector<double>{5, 2, 0}));
    EXPECT_TRUE(machine::while_between(five, {}, 0, 1).empty());
    EXPECT_TRUE(machine::while_between({}, other, 0, 1).empty());
}

TEST(MachineReductions, OfNothingAreUndefined) {
    for (const auto& reduction : machine::reduction_catalogue()) {
        if (reduction.of == nullptr) continue;
        EXPECT_TRUE(std::isnan(reduction.of({}))) << reduction.name;
    }
    const auto one = samples({{1, 5}});
    EXPECT_TRUE(std::isnan(reduced("slope", one)));
    EXPECT_TRUE(std::isnan(reduced("integral", one)));
    EXPECT_TRUE(std::isnan(reduced("slope", samples({{1, 5}, {1, 6}})))) << "at one moment";
    EXPECT_EQ(reduced("sd", one), 0);
}

TEST(MachineReductions, TheErrorOfAMeanIsThatOfIndependentBlocks) {
    EXPECT_TRUE(std::isnan(machine::find_reduction("mean")->error(samples({{0, 1}, {1, 2}})))) << "too few frames";
    // Independent values of variance 1/12: the error of the mean of 4000 is 1/sqrt(12*4000), from ten blocks within 80
    // %.
    std::vector<Sample> all;
    for (std::uint64_t n = 0; n < 4000; ++n)
        all.push_back({.time = static_cast<double>(n), .value = stats::Stream(5, n).uniform(0)});
    const double expected = 1 / std::sqrt(12.0 * 4000);
    EXPECT_GT(machine::find_reduction("mean")->error(all), 0.4 * expected);
    EXPECT_LT(machine::find_reduction("mean")->error(all), 1.8 * expected);
    EXPECT_NEAR(machine::find_reduction("mean")->error(std::vector<Sample>(40, {.time = 0, .value = 7})), 0, 1e-14);
}

TEST(MachineReductions, HaveOneNameEach) {
    std::set<std::string_view> names;
    for (const auto& reduction : machine::reduction_catalogue()) {
        EXPECT_TRUE(names.insert(reduction.name).second);
        EXPECT_EQ(machine::find_reduction(reduction.name), &reduction);
        EXPECT_EQ(reduction.of == nullptr, reduction.shape != Shape::scalar) << reduction.name;
    }
    EXPECT_EQ(machine::find_reduction("median"), nullptr);
}

}  // namespace grainsweep::tests::machine_reductions_test
