// Published problems of two objectives, both minimised, as campaigns of a program that formulas answer.
//
//   bnh              Binh & Korn 1997: f1 = 4 x^2 + 4 y^2, f2 = (x - 5)^2 + (y - 5)^2, x in [0, 5], y in [0, 3],
//                    (x - 5)^2 + y^2 <= 25, (x - 8)^2 + (y + 3)^2 >= 7.7
//   fonseca_fleming  Fonseca & Fleming 1995, n = 3: f = 1 - exp(-sum (x_i -+ 1/sqrt(n))^2), x in [-4, 4]
//   zdt1             Zitzler, Deb & Thiele 2000, n = 4: f1 = x1, f2 = g (1 - sqrt(x1/g)), g = 1 + 9 mean(x2 ... xn)
#pragma once

#include "stats/hypervolume.hpp"
#include "stats/random.hpp"
#include "sweep/study/process_window.hpp"
#include "tests/support/answered.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace grainsweep::tests {

struct Problem {
    std::string name;
    std::vector<std::array<double, 2>> ranges;
    std::array<double, 2> reference;
    std::string where;
    int first;  ///< cases of a search before its first batch: the fewest that a model takes, a multiple of 4
    std::map<std::string, double> (*of)(const std::vector<double>& x);
    std::vector<std::array<double, 2>> (*front)();  ///< points of the true front

    [[nodiscard]] bool allows(const std::map<std::string, double>& y) const {
        return where.empty() || (y.at("c1") <= 25 && y.at("c2") >= 7.7);
    }
    [[nodiscard]] std::string campaign(int points, std::uint64_t seed) const {
        std::string factors, observables = R"("f1": {"unit": "1"}, "f2": {"unit": "1"})";
        if (!where.empty()) observables += R"(, "c1": {"unit": "1"}, "c2": {"unit": "1"})";
        for (std::size_t j = 0; j < ranges.size(); ++j)
            factors += fmt::format(R"({}{{"name": "x{}", "between": [{}, {}]}})", j == 0 ? "" : ", ", j + 1,
                                   ranges[j][0], ranges[j][1]);
        return fmt::format(R"({{"campaign": "c", "scene": "program", "seed": {}, "program": {{"command": ["sh"],
                "protocol": "lines", "observables": {{{}}}}}, "factors": [{}],
                "design": {{"kind": "halton", "points": {}}}}})",
                           seed, observables, factors, points);
    }
    [[nodiscard]] Formulas formulas() const {
        return [*this](const Inputs& inputs) -> std::optional<std::map<std::string, double>> {
            std::vector<double> x;
            for (std::size_t j = 0; j < ranges.size(); ++j) x.push_back(input(inputs, fmt::format("x{}", j + 1)));
            return of(x);
        };
    }
    [[nodiscard]] stats::Hypervolume nothing() const { return {reference, {false, false}}; }
    [[nodiscard]] double true_volume() const {
        auto volume = nothing();
        for (const auto& point : front()) volume.add(point);
        return volume.value();
    }
    [[nodiscard]] study::WindowRequest request(std::size_t next) const {
        return {.where = where, .objectives = {{"f1", false, reference[0]}, {"f2", false, reference[1]}}, .next = next};
    }
    /// Hypervolume of the answered cases, by their values.
    [[nodiscard]] double volume_of(const study::ModelCases& cases) const {
        auto volume = nothing();
        for (std::size_t i = 0; i < cases.settings.size(); ++i)
            if (const auto y = of(cases.settings[i]); allows(y)) volume.add({y.at("f1"), y.at("f2")});
        return volume.value();
    }
    [[nodiscard]] double random_search(int evaluations, std::uint64_t seed) const {
        const stats::Stream stream(seed, 77);
        auto volume = nothing();
        for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(evaluations); ++i) {
            std::vector<double> x;
            for (std::size_t j = 0; j < ranges.size(); ++j)
                x.push_back(std::lerp(ranges[j][0], ranges[j][1], stream.uniform(ranges.size() * i + j)));
            if (const auto y = of(x); allows(y)) volume.add({y.at("f1"), y.at("f2")});
        }
        return volume.value();
    }
};

[[nodiscard]] inline Problem bnh() {
    return {"bnh",
            {{0, 5}, {0, 3}},
            {140, 50},
            "c1 <= 25 and c2 >= 7.7",
            12,
            [](const std::vector<double>& x) {
                const auto square = [](double z) { return z * z; };
                return std::map<std::string, double>{{"f1", 4 * square(x[0]) + 4 * square(x[1])},
                                                     {"f2", square(x[0] - 5) + square(x[1] - 5)},
                                                     {"c1", square(x[0] - 5) + square(x[1])},
                                                     {"c2", square(x[0] - 8) + square(x[1] + 3)}};
            },
            [] {
                std::vector<std::array<double, 2>> front;  // x = y up to 3, then y = 3
                for (int i = 0; i <= 20000; ++i) {
                    const double x = 5.0 * i / 20000, y = std::min(x, 3.0);
                    front.push_back({4 * x * x + 4 * y * y, (x - 5) * (x - 5) + (y - 5) * (y - 5)});
                }
                return front;
            }};
}

[[nodiscard]] inline Problem fonseca_fleming() {
    return {"fonseca_fleming",
            {{-4, 4}, {-4, 4}, {-4, 4}},
            {1, 1},
            "",
            16,
            [](const std::vector<double>& x) {
                double less = 0, more = 0;
                for (const double one : x) {
                    less += std::pow(one - 1 / std::sqrt(3.0), 2);
                    more += std::pow(one + 1 / std::sqrt(3.0), 2);
                }
                return std::map<std::string, double>{{"f1", 1 - std::exp(-less)}, {"f2", 1 - std::exp(-more)}};
            },
            [] {
                std::vector<std::array<double, 2>> front;  // x_1 = x_2 = x_3 between -+ 1/sqrt(3)
                for (int i = 0; i <= 20000; ++i) {
                    const double x = 2.0 * i / 20000 - 1;
                    front.push_back({1 - std::exp(-(x - 1) * (x - 1)), 1 - std::exp(-(x + 1) * (x + 1))});
                }
                return front;
            }};
}

[[nodiscard]] inline Problem zdt1() {
    return {"zdt1",
            {{0, 1}, {0, 1}, {0, 1}, {0, 1}},
            {1.1, 6},
            "",
            20,
            [](const std::vector<double>& x) {
                const double g = 1 + 3 * (x[1] + x[2] + x[3]);
                return std::map<std::string, double>{{"f1", x[0]}, {"f2", g * (1 - std::sqrt(x[0] / g))}};
            },
            [] {
                std::vector<std::array<double, 2>> front;
                for (int i = 0; i <= 20000; ++i) front.push_back({i / 20000.0, 1 - std::sqrt(i / 20000.0)});
                return front;
            }};
}

}  // namespace grainsweep::tests
