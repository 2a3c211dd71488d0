// What tests of the study share: an archive of answered campaigns of known responses, and its reading.
#pragma once

#include "stats/random.hpp"
#include "sweep/study/history.hpp"
#include "tests/support/answered.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

namespace grainsweep::tests {

inline constexpr double none = std::numeric_limits<double>::quiet_NaN();

inline std::string halton(const std::string& name, int points, const std::string& more = "") {
    return R"({"campaign": ")" + name + R"(", "scene": "rehearsal",
        "factors": [{"name": "x1", "between": [0, 1]}, {"name": "x2", "between": [0, 0.5]}],
        "design": {"kind": "halton", "sequences": 8, "points": )" +
           std::to_string(points) + "}" + more + "}";
}

/// First-order indices 0.8 and 0.2 (x2 spans half of its unit): V = 4 a^2/12 + a^2/12 with 2 x1 and 2 x2.
inline double linear(const Inputs& inputs) {
    return 1 + 2 * input(inputs, "x1") + 2 * input(inputs, "x2");
}

/// A uniform disturbance of the case, of standard deviation sigma: what a scene's own random numbers do.
inline std::optional<double> disturbed(double y, double sigma, std::uint64_t salt, std::uint64_t count) {
    const double u = stats::Stream(salt, count).uniform(0);
    return y + sigma * std::sqrt(12.0) * (u - 0.5);
}

inline std::string lattice(const std::string& name, int replicates) {
    return R"({"campaign": ")" + name + R"(", "scene": "rehearsal", "replicates": )" + std::to_string(replicates) +
           R"(, "factors": [{"name": "x1", "between": [0, 1]}, {"name": "x2", "between": [0, 1]}],
        "design": {"kind": "lattice", "levels": [2, 5]}})";
}

struct Study : testing::Test {
    Folder folder;
    store::Store store{folder / "a.db", store::Store::Mode::create};

    study::Responses ask(const std::string& name) {
        return study::read_responses(store, study::find_campaigns(store, name).front());
    }
};

}  // namespace grainsweep::tests
