#include "stats/process_window.hpp"
#include "tests/support/ask_design.hpp"

#include <gtest/gtest.h>

#include <boost/math/distributions/students_t.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <variant>
#include <vector>

namespace grainsweep::tests::stats_process_window_test {

using namespace stats;

ResponseModel model_of(const std::function<double(double, double)>& f, std::int64_t n, double noise) {
    const auto set = ask_design("halton", 2, {{"points", n}});
    std::vector<double> values;
    for (std::size_t i = 0; i < set.size(); ++i) {
        // Scatter of two values, alternating: its standard deviation is `noise` exactly.
        values.push_back(f(set.point(i)[0], set.point(i)[1]) + (i % 2 == 0 ? noise : -noise));
    }
    const auto fit = fit_response({set.coordinates, 2}, values);
    return std::get<ResponseModel>(fit);
}

double hill(double x, double y) {
    return 1 - std::pow(x - 0.7, 2) - std::pow(y - 0.3, 2);
}

std::vector<double> grid(std::size_t n) {
    std::vector<double> points;
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j) {
            points.push_back((static_cast<double>(i) + 0.5) / static_cast<double>(n));
            points.push_back((static_cast<double>(j) + 0.5) / static_cast<double>(n));
        }
    return points;
}

TEST(ProcessWindow, AConditionHoldsWithItsProbability) {
    const auto first = model_of(hill, 60, 0.05);
    const auto second = model_of([](double x, double y) { return x + y; }, 60, 0.05);
    const auto points = grid(5);
    const std::vector<std::vector<Prediction>> predictions{first.predict({points, 2}), second.predict({points, 2})};
    const SampledErrors errors(std::vector{first.freedom(), second.freedom()});
    const auto probability = [&](const Prediction& p, double error, double low) {
        return boost::math::cdf(boost::math::students_t(p.freedom), (p.mean - low) / error);
    };
    for (const Judged judged : {Judged::mean, Judged::single_run}) {
        const auto integrated = probability_of(
            predictions, [](auto y) { return y[0] >= 0.85 && y[1] >= 0.5 && y[1] <= 1.2; }, judged, errors);
        for (std::size_t i = 0; i < integrated.size(); ++i) {
            const Prediction &a = predictions[0][i], &b = predictions[1][i];
            const auto error = [&](const Prediction& p, std::size_t model) {
                if (judged == Judged::mean) return p.mean_error;
                const double widest = errors.widest(model) * p.scatter;
                return std::hypot(2 * p.mean_error, std::min(widest, std::max(p.scatter, p.even_scatter)));
            };
            const double of_a = error(a, 0), of_b = error(b, 1);
            EXPECT_NEAR(integrated[i],
                        probability(a, of_a, 0.85) * (probability(b, of_b, 0.5) - probability(b, of_b, 1.2)), 0.01);
        }
    }
    const std::vector<std::vector<Prediction>> one{predictions[0]};
    EXPECT_THROW((void)probability_of(
                     one, [](auto) { return true; }, Judged::mean, errors),
                 std::invalid_argument);
}

TEST(ProcessWindow, APromiseOfRunsTrustsNoSmallLocalScatter) {
    // chi-squared of 10 degrees of freedom is below 4.865 in 10 %.
    const SampledErrors errors(std::vector{10.0});
    EXPECT_NEAR(errors.widest(0), std::sqrt(10 / 4.86518), 1e-5);
    const auto promised = [&](double scatter, double even) {
        Prediction p{.mean = 1, .mean_error = 0, .scatter = scatter, .freedom = 10};
        p.even_scatter = even;
        const std::vector<std::vector<Prediction>> one{{p}};
        return probability_of(
                   one, [](auto y) { return y[0] >= 0; }, Judged::single_run, errors)
            .front();
    };
    const auto expected = [](double scatter) { return boost::math::cdf(boost::math::students_t(10), 1 / scatter); };
    EXPECT_NEAR(promised(0.4, 0.5), expected(0.5), 0.002) << "as everywhere";
    EXPECT_NEAR(promised(0.5, 0.4), expected(0.5), 0.002) << "larger here";
    EXPECT_NEAR(promised(0.2, 0.9), expected(0.2 * std::sqrt(10 / 4.86518)), 0.002) << "clearly smaller here";
}

TEST(ProcessWindow, ErrorsOfRunsNeedNotBeNormal) {
    // Scores of an exponential distribution, mean 0 and variance 1: below 2 in 1 - exp(-3).
    std::vector<std::vector<double>> scores(1);
    for (int i = 0; i < 2000; ++i) scores[0].push_back(-std::log(1 - (i + 0.5) / 2000) - 1);
    const SampledErrors errors(std::vector{200.0}, scores);
    const std::vector<std::vector<Prediction>> one{{{.mean = 0, .mean_error = 0, .scatter = 1, .freedom = 200}}};
    const auto below = [&](double limit) {
        return probability_of(
                   one, [&](auto y) { return y[0] <= limit; }, Judged::single_run, errors)
            .front();
    };
    EXPECT_NEAR(below(2), 1 - std::exp(-3.0), 0.002);
    EXPECT_NEAR(1 - below(-2), boost::math::cdf(boost::math::students_t(200), 2.0), 0.002) << "the worse of the two";
}

TEST(ProcessWindow, ExpectedImprovementIsItsIntegral) {
    // The closed form against a Riemann sum of max(y - best, 0) over the normal density.
    const std::vector<Prediction> objective{{1.0, 0.01, 0.1}, {0.9, 0.2, 0.1}, {1.5, 0.1, 0.1}};
    const std::vector<double> probability{1, 0.8, 0.1};  // the last is no best: its condition is hardly met
    const auto gain = expected_improvement(objective, probability, true);
    double sum = 0;
    for (int i = -8000; i <= 8000; ++i) {
        const double u = i * 1e-3, y = 0.9 + 0.2 * u;
        sum += std::max(y - 1.0, 0.0) * std::exp(-0.5 * u * u) / std::sqrt(2 * M_PI) * 1e-3;
    }
    EXPECT_NEAR(gain[1], 0.8 * sum * (1 - 0.1 / std::hypot(0.2, 0.1)), 1e-6);
    // Minimising the negative is the same.
    auto negative = objective;
    for (auto& p : negative) p.mean = -p.mean;
    EXPECT_EQ(expected_improvement(negative, probability, false), gain);
}

TEST(ProcessWindow, CasesGatherAtTheConstrainedOptimum) {
    // The top of the hill is not allowed (x <= 0.5): what remains is best at its edge, x = 0.5, y = 0.3.
    auto objective = model_of(hill, 40, 0.01), limited = model_of([](double x, double) { return x; }, 40, 0.01);
    const auto points = grid(20);
    const Condition allowed = [](auto y) { return y[1] <= 0.5; };
    const SampledErrors errors(std::vector{objective.freedom(), limited.freedom()});
    std::vector<std::size_t> chosen;
    for (std::size_t step = 0; step < 4; ++step) {
        const std::vector<std::vector<Prediction>> now{objective.predict({points, 2}), limited.predict({points, 2})};
        auto gain = expected_improvement(now[0], probability_of(now, allowed, Judged::mean, errors), true);
        for (const std::size_t i : chosen) gain[i] = 0;
        const auto best = static_cast<std::size_t>(std::ranges::max_element(gain) - gain.begin());
        EXPECT_NEAR(points[2 * best], 0.5, 0.15);
        EXPECT_NEAR(points[2 * best + 1], 0.3, 0.25);
        const Rows there{std::span(points).subspan(2 * best, 2), 2};
        objective = objective.with_cases(there, std::span(&now[0][best].mean, 1));
        limited = limited.with_cases(there, std::span(&now[1][best].mean, 1));
        chosen.push_back(best);
    }
}

TEST(ProcessWindow, TradeOffFrontIsWhatNothingBeats) {
    const std::vector<double> good{1, 2, 3, 3, 0.5}, bad{1, 2, 4, 3, 2};
    EXPECT_EQ(trade_off_front(good, true, bad, false), (std::vector<std::size_t>{0, 1, 3}));
    EXPECT_EQ(trade_off_front(good, false, bad, true), (std::vector<std::size_t>{4, 2}));
    // By definition, on random figures.
    const auto set = ask_design("random", 2, {{"points", 200}});
    std::vector<double> a, b;
    for (std::size_t i = 0; i < set.size(); ++i) {
        a.push_back(set.point(i)[0]);
        b.push_back(set.point(i)[1]);
    }
    std::vector<std::size_t> expected;
    for (std::size_t i = 0; i < a.size(); ++i) {
        bool beaten = false;
        for (std::size_t j = 0; j < a.size(); ++j) beaten = beaten || (a[j] > a[i] && b[j] < b[i]);
        if (!beaten) expected.push_back(i);
    }
    std::ranges::sort(expected, {}, [&](std::size_t i) { return a[i]; });
    EXPECT_EQ(trade_off_front(a, true, b, false), expected);
}

}  // namespace grainsweep::tests::stats_process_window_test
