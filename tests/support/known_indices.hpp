// Responses whose sensitivity indices have closed forms: what the coverage of their intervals is counted on.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace grainsweep::tests {

struct KnownIndices {
    std::string name;
    std::size_t dimensions;
    std::function<double(std::span<const double>)> mean;
    double noise;                             ///< standard deviation of single runs
    std::vector<double> first, total, pairs;  ///< shares of the variance of the mean response
    double share = 1;                         ///< of the variance of single runs, the mean response's
    std::int64_t cases = 128;                 ///< that a model of it needs
};

/// f_1(x_1) + ... + f_d(x_d) of these variances.
inline KnownIndices additive_response(std::string name, std::function<double(std::span<const double>)> mean,
                                      const std::vector<double>& variances, double noise) {
    double whole = 0;
    for (const double v : variances) whole += v;
    std::vector<double> first;
    for (const double v : variances) first.push_back(v / whole);
    const std::size_t d = variances.size();
    return {std::move(name),
            d,
            std::move(mean),
            noise,
            first,
            first,
            std::vector<double>(d * (d - 1) / 2, 0.0),
            whole / (whole + noise * noise)};
}

/// The product of (|4 x_j - 2| + a_j)/(1 + a_j) (Saltelli & Sobol 1995).
inline KnownIndices g_function(std::string name, std::vector<double> a) {
    const std::size_t d = a.size();
    std::vector<double> v;
    double product = 1;
    for (const double x : a) {
        v.push_back(1 / (3 * (1 + x) * (1 + x)));
        product *= 1 + v.back();
    }
    KnownIndices known{std::move(name), d, {}, 0, {}, {}, {}, 1, 256};
    for (std::size_t j = 0; j < d; ++j) {
        known.first.push_back(v[j] / (product - 1));
        known.total.push_back(v[j] * product / (1 + v[j]) / (product - 1));
        for (std::size_t k = j + 1; k < d; ++k) known.pairs.push_back(v[j] * v[k] / (product - 1));
    }
    known.mean = [a = std::move(a)](std::span<const double> u) {
        double y = 1;
        for (std::size_t j = 0; j < a.size(); ++j) y *= (std::abs(4 * u[j] - 2) + a[j]) / (1 + a[j]);
        return y;
    };
    return known;
}

/// Linear, additive without and with scatter, Ishigami (Ishigami & Homma 1990), a product, a g-function, and a linear
/// one whose second factor is lost in the scatter.
inline std::vector<KnownIndices> known_indices() {
    using Point = std::span<const double>;
    const auto bent = [](Point u) { return std::sin(3 * u[0]) + 2 * u[1] * u[1] + 0.5 * u[2]; };
    const double mean = (1 - std::cos(3.0)) / 3;
    const std::vector<double> of_bent = {0.5 - std::sin(6.0) / 12 - mean * mean, 16.0 / 45, 1.0 / 48, 0};
    return {
        additive_response(
            "linear", [](Point u) { return u[0] + 0.5 * u[1]; }, {1.0 / 12, 1.0 / 48, 0}, 0),
        additive_response("additive", bent, of_bent, 0),
        additive_response("scattered", bent, of_bent, 0.3),
        {"ishigami",
         3,
         [](Point u) {
             const auto x = [&](std::size_t j) { return std::numbers::pi * (2 * u[j] - 1); };
             return std::sin(x(0)) + 7 * std::pow(std::sin(x(1)), 2) + 0.1 * std::pow(x(2), 4) * std::sin(x(0));
         },
         0,
         {0.3139051911, 0.4424111448, 0},
         {0.5575888552, 0.4424111448, 0.2436836642},
         {0, 0.2436836642, 0},
         1,
         256},
        {"product",
         3,
         [](Point u) { return u[0] * u[1] + u[2]; },
         0,
         {3.0 / 19, 3.0 / 19, 12.0 / 19},
         {4.0 / 19, 4.0 / 19, 12.0 / 19},
         {1.0 / 19, 0, 0}},
        g_function("g_function", {0, 0.5, 3, 9}),
        additive_response(
            "lost", [](Point u) { return u[0] + 0.05 * u[1]; }, {1.0 / 12, 0.0025 / 12, 0}, 0.12),
    };
}

}  // namespace grainsweep::tests
