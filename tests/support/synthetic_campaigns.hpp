// Random smooth responses with random noise: how often the intervals of a response model hold.
#pragma once

#include "stats/random.hpp"
#include "stats/response_model.hpp"
#include "tests/support/ask_design.hpp"
#include "tests/support/known_responses.hpp"

#include <boost/math/distributions/students_t.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <variant>
#include <vector>

namespace grainsweep::tests {

/// Sum of eight cosines with random frequencies over two factors.
class RandomResponse {
public:
    explicit RandomResponse(std::uint64_t seed) {
        const stats::Stream stream(seed, 11);
        for (std::uint64_t k = 0; k < waves_.size(); ++k)
            waves_[k] = {normal_at(stream, 4 * k) / static_cast<double>(waves_.size()),
                         4 * normal_at(stream, 4 * k + 1), 2 * normal_at(stream, 4 * k + 2),
                         2 * std::numbers::pi * stream.uniform(8 * k + 6)};
        noise = 0.02 + 0.1 * stream.uniform(1000);
    }
    [[nodiscard]] double operator()(std::span<const double> u) const {
        double y = 0;
        for (const auto& w : waves_) y += w[0] * std::cos(w[1] * u[0] + w[2] * u[1] + w[3]);
        return y;
    }
    double noise = 0;

private:
    std::array<std::array<double, 4>, 8> waves_{};
};

struct IntervalCounts {
    int asked = 0, runs_50 = 0, runs_95 = 0, means_95 = 0, refused = 0;
};

/// `campaigns` of 60 cases, each model asked at 40 other points for the mean and for a single run.
inline IntervalCounts count_intervals(std::uint64_t campaigns) {
    IntervalCounts counts;
    for (std::uint64_t seed = 1; seed <= campaigns; ++seed) {
        const RandomResponse response(seed);
        const auto set = ask_design("halton", 2, {{"points", std::int64_t{60}}}, seed);
        const stats::Stream stream(seed, 12);
        std::vector<double> values;
        for (std::size_t i = 0; i < set.size(); ++i)
            values.push_back(response(set.point(i)) + response.noise * normal_at(stream, i));
        const auto fit = stats::fit_response({set.coordinates, 2}, values);
        if (std::holds_alternative<stats::Refusal>(fit)) {
            ++counts.refused;
            continue;
        }
        const auto fresh = ask_design("random", 2, {{"points", std::int64_t{40}}}, seed);
        const auto predictions = std::get<stats::ResponseModel>(fit).predict(stats::Rows{fresh.coordinates, 2});
        for (std::size_t i = 0; i < fresh.size(); ++i) {
            const double mean = response(fresh.point(i)), run = mean + response.noise * normal_at(stream, 1000 + i);
            const auto& p = predictions[i];
            ++counts.asked;
            counts.runs_50 +=
                std::abs(run - p.mean) < boost::math::quantile(boost::math::students_t(p.freedom), 0.75) * p.run_error()
                    ? 1
                    : 0;
            counts.runs_95 += std::abs(run - p.mean) < p.run_half_width() ? 1 : 0;
            counts.means_95 += std::abs(mean - p.mean) < p.mean_half_width() ? 1 : 0;
        }
    }
    return counts;
}

}  // namespace grainsweep::tests
