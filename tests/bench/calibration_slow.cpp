// How often a calibration's 90 % region holds the truth, over 200 synthetic experiments: truths drawn over the box,
// measurements drawn about the true responses with the stated errors, runs with a scatter of their own.
//
//     slow_calibration     prints a JSON line per response
//
// Region: highest density, {u: p(z | u) >= its 10 % quantile over the posterior's sample}; intervals: 5 to 95 %.
// A share of 0.9 of 200 experiments has a standard error of 0.021: 0.85 ... 0.95 are 2.4 of them. (Of 50 it is 0.042.)
#include "stats/calibration.hpp"
#include "stats/random.hpp"
#include "tests/support/ask_calibration.hpp"
#include "tests/support/spreading_response.hpp"

#include <gtest/gtest.h>
#include <boost/math/distributions/normal.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

using namespace grainsweep;
using grainsweep::tests::answered;
using grainsweep::tests::calibration_request;
using grainsweep::tests::ResponseFunctions;
using grainsweep::tests::spreading_response;

namespace {

using Point = std::span<const double>;
using Response = std::function<double(Point)>;

constexpr int experiments = 200;

double uniform_at(std::uint64_t stream, std::uint64_t counter) {
    return stats::to_unit(stats::bits_at(2026, stream, counter));
}

double normal_at(std::uint64_t stream, std::uint64_t counter) {
    return boost::math::quantile(boost::math::normal(), std::clamp(uniform_at(stream, counter), 1e-12, 1 - 1e-12));
}

/// A response and how it is measured: by one experiment, off by error, discrepancy and the scatter of one run.
struct Measured {
    Response response;
    double error, discrepancy, scatter;
};

struct Coverage {
    int experiments = 0, region = 0, intervals = 0, factors = 0;
    std::size_t cases = 0;
    double width = 0;  ///< of the 90 % intervals
};

std::vector<double> log_density(const designs::Calibration& found, stats::Rows points) {
    std::vector<stats::Target> targets;
    std::vector<std::vector<stats::Prediction>> predictions;
    for (std::size_t t = 0; t < found.targets.size(); ++t) {
        if (!found.models[t]) continue;
        const auto& target = found.targets[t];
        targets.push_back({target.value, target.error, target.discrepancy, 1});
        predictions.push_back(std::get<stats::ResponseModel>(*found.models[t]).predict(points));
    }
    return stats::log_likelihood(targets, predictions);
}

/// Whether the region of highest density that holds all but a share of the posterior holds the truth.
bool holds(const designs::Calibration& found, const std::vector<double>& truth, double outside) {
    auto densities = log_density(found, found.posterior->rows());
    const auto edge = densities.begin() + static_cast<std::ptrdiff_t>(outside * static_cast<double>(densities.size()));
    std::ranges::nth_element(densities, edge);
    return log_density(found, {truth, truth.size()})[0] >= *edge;
}

void count(const designs::Calibration& found, const std::vector<double>& truth, Coverage& coverage) {
    const auto sample = found.posterior->rows();
    ++coverage.experiments;
    coverage.region += holds(found, truth, 0.1) ? 1 : 0;
    coverage.cases += found.waves.back().cases;
    for (std::size_t j = 0; j < truth.size(); ++j) {
        std::vector<double> values;
        for (std::size_t i = 0; i < sample.size(); ++i) values.push_back(sample.row(i)[j]);
        std::ranges::sort(values);
        const double low = values[values.size() / 20], high = values[values.size() - 1 - values.size() / 20];
        ++coverage.factors;
        coverage.intervals += low <= truth[j] && truth[j] <= high ? 1 : 0;
        coverage.width += high - low;
    }
}

Coverage coverage_of(std::size_t d, const std::vector<Measured>& measured) {
    Coverage coverage;
    for (std::uint64_t e = 0; e < experiments; ++e) {
        std::vector<double> truth;
        for (std::size_t j = 0; j < d; ++j) truth.push_back(uniform_at(e, j));
        std::vector<designs::MeasuredTarget> targets;
        ResponseFunctions responses;
        for (std::size_t t = 0; t < measured.size(); ++t) {
            const auto& m = measured[t];
            const std::string name = "y" + std::to_string(t);
            const double off = std::hypot(m.error, m.discrepancy, m.scatter) * normal_at(e, 100 + t);
            targets.push_back({name, m.response(truth) + off, m.error, m.discrepancy, {}});
            responses[name] = [m, e, t, runs = std::uint64_t{0}](Point u) mutable {
                return m.response(u) + m.scatter * normal_at(e, 1000 + 8 * runs++ + t);
            };
        }
        auto asked =
            calibration_request(d, targets, {{"waves", std::int64_t{3}}, {"points_per_wave", std::int64_t{24}}}, e + 1);
        const auto found = answered(asked, responses);
        EXPECT_TRUE(found.posterior.has_value());
        if (found.posterior) count(found, truth, coverage);
    }
    return coverage;
}

void report(const char* name, const Coverage& c) {
    std::printf(
        "{\"responses\": \"%s\", \"experiments\": %d, \"region\": %.2f, \"intervals\": %.3f, \"cases\": %.0f, "
        "\"interval_width\": %.3f}\n",
        name, c.experiments, 1.0 * c.region / c.experiments, 1.0 * c.intervals / c.factors,
        static_cast<double>(c.cases) / c.experiments, c.width / c.factors);
    std::fflush(stdout);
    EXPECT_GE(c.region, 0.85 * c.experiments) << name;
    EXPECT_LE(c.region, 0.95 * c.experiments) << name;
}

}  // namespace

TEST(CalibrationCoverage, OfTwoFactorsByTwoCurvedResponses) {
    const auto first = [](Point u) { return std::sin(2 * u[0]) + u[1] * u[1]; };
    const auto second = [](Point u) { return u[0] * u[1] + 0.5 * u[0]; };
    report("curved", coverage_of(2, {{first, 0.02, 0.01, 0.02}, {second, 0.02, 0.01, 0.02}}));
}

TEST(CalibrationCoverage, OfThreeFactorsAlongARidge) {
    const auto first = [](Point u) { return u[0] + u[1]; };
    const auto second = [](Point u) { return std::exp(u[2]) - 0.5 * u[0] - 0.5 * u[1]; };
    report("ridge", coverage_of(3, {{first, 0.02, 0.02, 0.03}, {second, 0.03, 0.01, 0.03}}));
}

// Angle of repose (deg) and time through a funnel (s) of two frictions: each alone leaves a ridge, both cross.
TEST(CalibrationCoverage, OfTwoExperiments) {
    constexpr int truths = 40;
    const auto angle = [](Point u) { return 20 + 14 * std::tanh(2 * u[0]) + (3 + 9 * u[0]) * u[1]; };
    const auto time = [](Point u) { return 8 + 5 * u[0] + 0.5 * u[1] * u[1]; };
    const double angle_scatter = 0.5, time_scatter = 0.1;
    int region = 0, reproduced = 0;
    std::size_t cases = 0, waves = 0;
    for (std::uint64_t e = 0; e < truths; ++e) {
        const std::vector<double> truth = {uniform_at(e, 0), uniform_at(e, 1)};
        const std::vector<designs::MeasuredTarget> targets = {
            {"angle", angle(truth) + std::hypot(1, 0.5, angle_scatter) * normal_at(e, 100), 1, 0.5, {}, 0, "heap"},
            {"time", time(truth) + std::hypot(0.15, 0.1, time_scatter) * normal_at(e, 101), 0.15, 0.1, {}, 0, "rate"}};
        const auto run = [e](const auto& response, double scatter, std::uint64_t stream) {
            return [=, runs = std::uint64_t{0}](Point u) mutable {
                return response(u) + scatter * normal_at(e, stream + runs++);
            };
        };
        const std::map<std::string, ResponseFunctions> responses = {
            {"heap", {{"angle", run(angle, angle_scatter, 1000)}}},
            {"rate", {{"time", run(time, time_scatter, 5000)}}}};
        auto requests = grainsweep::tests::joint_requests(
            2, targets, responses, {{"waves", std::int64_t{3}}, {"points_per_wave", std::int64_t{20}}}, e + 1);
        const auto found = grainsweep::tests::answered_in_turn(requests, responses);
        ASSERT_TRUE(found.posterior.has_value());
        region += holds(found, truth, 0.05) ? 1 : 0;
        const auto miss = designs::largest_miss(found.targets, found.check);
        reproduced += miss && miss->size <= designs::largest_miss_allowed ? 1 : 0;
        cases += found.points.size() * requests.size();
        waves += found.waves.size();
    }
    std::printf(
        "{\"responses\": \"two experiments\", \"truths\": %d, \"region_95\": %.3f, \"reproduced\": %.3f, "
        "\"cases\": %.0f, \"waves\": %.2f}\n",
        truths, 1.0 * region / truths, 1.0 * reproduced / truths, static_cast<double>(cases) / truths,
        static_cast<double>(waves) / truths);
    std::fflush(stdout);
    EXPECT_GE(region, 35) << "the 95 % binomial interval of 34 of 40 ends at 0.943, below the stated 0.95";
}

TEST(CalibrationCoverage, OfTheSpreadingResponse) {
    const auto at = [](double gap) {
        return [gap](Point u) { return spreading_response(std::array{u[0], u[1], gap, 0.5}); };
    };
    report("spreading", coverage_of(2, {{at(0.5), 0.003, 0.002, 0.0188}, {at(0.95), 0.003, 0.002, 0.0188}}));
}
