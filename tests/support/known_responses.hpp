// Responses whose moments are known by dense quadrature, and campaigns that ask them: what coverage is counted on.
#pragma once

#include "stats/assisted_moments.hpp"
#include "stats/moment_statistics.hpp"
#include "stats/random.hpp"
#include "tests/support/ask_design.hpp"
#include "tests/support/spreading_response.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <span>
#include <string>
#include <vector>

namespace grainsweep::tests {

struct KnownResponse {
    std::string name;
    std::size_t dimensions;
    std::function<double(std::span<const double>)> mean;
    double noise;      ///< standard deviation of single runs, the same everywhere
    std::size_t grid;  ///< midpoints along a factor that give its moments to 1e-4 or better
};

/// The spreading response with its noise, a step, smooth with noise, waves no model follows, noise alone, and smooth
/// without noise, where the error is that of the integral and of the models alone.
inline std::vector<KnownResponse> known_responses() {
    using Point = std::span<const double>;
    return {
        {"spreading", 4, [](Point u) { return spreading_response(u); }, 0.0188, 64},
        {"step", 2, [](Point u) { return (u[0] + 0.3 * u[1] > 0.6 ? 1 : 0) + 0.2 * u[1]; }, 0.05, 2000},
        {"smooth", 3, [](Point u) { return std::sin(3 * u[0]) + u[1] * u[1] + u[1] * u[2]; }, 0.1, 100},
        {"waves", 3, [](Point u) { return std::sin(25 * u[0]) * std::cos(18 * u[1]) + 0.3 * u[2]; }, 0.1, 200},
        {"noise", 3, [](Point) { return 1.0; }, 0.2, 1},
        {"exact", 3, [](Point u) { return std::sin(3 * u[0]) + u[1] * u[1] + u[1] * u[2]; }, 0, 400},
    };
}

/// Mean, sd, g1, kurtosis of the response; with scatter: of its single runs, the noise being normal.
inline std::array<double, 4> true_statistics(const KnownResponse& response, bool with_scatter) {
    stats::RawMoments m{};
    std::vector<double> u(response.dimensions);
    const auto cells = static_cast<std::size_t>(std::pow(response.grid, response.dimensions) + 0.5);
    for (std::size_t cell = 0; cell < cells; ++cell) {
        std::size_t rest = cell;
        for (double& x : u) {
            x = (static_cast<double>(rest % response.grid) + 0.5) / static_cast<double>(response.grid);
            rest /= response.grid;
        }
        const double y = response.mean(u), v = with_scatter ? response.noise * response.noise : 0;
        m[0] += y;
        m[1] += y * y + v;
        m[2] += y * y * y + 3 * y * v;
        m[3] += y * y * y * y + 6 * y * y * v + 3 * v * v;
    }
    for (double& moment : m) moment /= static_cast<double>(cells);
    std::array<double, 4> values{};
    const auto all = stats::moment_statistics(m);
    for (std::size_t k = 0; k < 4; ++k) values[k] = all[k].value;
    return values;
}

/// Standard normal deviate of an address (Box & Muller 1958).
inline double normal_at(const stats::Stream& stream, std::uint64_t i) {
    return std::sqrt(-2 * std::log(1 - stream.uniform(2 * i))) *
           std::cos(2 * std::numbers::pi * stream.uniform(2 * i + 1));
}

struct KnownCampaign {
    std::vector<double> points, values;
    std::vector<std::size_t> sequences;
};

/// n Halton points in 8 random sequences, each run with its own noise.
inline KnownCampaign ask_known(const KnownResponse& response, std::int64_t n, std::uint64_t seed) {
    const auto set = ask_design("halton", response.dimensions, {{"points", n}, {"sequences", std::int64_t{8}}}, seed);
    KnownCampaign c{set.coordinates, {}, {}};
    const stats::Stream stream(seed, 77);
    for (std::size_t i = 0; i < set.size(); ++i) {
        c.values.push_back(response.mean(set.point(i)) + response.noise * normal_at(stream, i));
        c.sequences.push_back(i % 8);
    }
    return c;
}

/// 8 independent scramblings of 2^power Sobol points, one after the other.
inline std::vector<double> integration_points(std::size_t dimensions, unsigned power, std::uint64_t seed = 1) {
    std::vector<double> points;
    for (std::uint64_t k = 0; k < 8; ++k) {
        const auto set =
            ask_design("sobol", dimensions, {{"points", std::int64_t{1} << power}, {"scramble", std::string("random")}},
                       1000 * seed + k);
        points.insert(points.end(), set.coordinates.begin(), set.coordinates.end());
    }
    return points;
}

}  // namespace grainsweep::tests
