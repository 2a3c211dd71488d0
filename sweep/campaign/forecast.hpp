// Expected cost of a campaign, before it runs.
#pragma once

#include "sweep/campaign/campaign.hpp"

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace grainsweep::campaign {

/// Warning of the scene about some cases of a campaign.
struct Caution {
    std::string kind;
    std::string sentence;  ///< warning of the first case
    std::int64_t first_point = 0;
    std::int64_t questions = 0;  ///< number of distinct cases with this warning
};

struct Forecast {
    std::int64_t places = 0;      ///< cases as placed in the design
    std::int64_t questions = 0;   ///< distinct cases
    std::int64_t proven = 0;      ///< distinct cases whose answer is known without simulation
    std::int64_t impossible = 0;  ///< distinct cases with an impossible combination of inputs, which will be rejected
    std::string first_reason;     ///< reason of the first impossible case
    std::int64_t first_point = 0;
    double total_seconds = 0;    ///< of one average core
    double longest_seconds = 0;  ///< of the most expensive case
    double largest_bytes = 0;    ///< memory of the case that needs most
    std::int64_t largest_point = 0;
    std::vector<Caution> cautions;
    std::vector<double> seconds;  ///< of the case at each place; 0 if it is proven or impossible
};

/// Returns warnings before a campaign runs, one sentence each: cautions with their counts, repeated cases, a
/// convergence rule that cannot be met.
[[nodiscard]] std::vector<std::string> warnings_of(const Campaign& campaign, const Forecast& forecast);

/// Prediction about a case before it is computed.
struct Prediction {
    bool proven = false;     ///< the answer is known without simulation
    CostEstimate cost;       ///< 0 if it is proven or impossible
    std::string impossible;  ///< why the combination of its inputs is impossible; empty: it is possible
    std::vector<Warning> warnings = {};
};
/// Returns the prediction. Throws std::invalid_argument if a file among the inputs cannot be read.
[[nodiscard]] Prediction predict(const SceneInfo& scene, const Inputs& inputs);

/// Returns a function that checks, without running a case, whether a scene accepts inputs; otherwise their case is
/// rejected. Files are read once.
[[nodiscard]] std::function<bool(const Inputs&)> acceptance(const SceneInfo& scene);

/// Throws InputError if a case, `which` such as "the case of point 3", needs more memory than `room`, bytes.
void require_memory(const std::string& which, double bytes, double room);

/// Longest course of a calibration, in which no wave ends early.
struct LongestCourse {
    std::int64_t waves = 0, points_per_wave = 0, checks = 0;  ///< checks: in all rounds
    double seconds = 0;                                       ///< of one average core, at the mean cost of the first
                                                              ///< wave
};
/// Returns the largest cost of a calibration; empty for a campaign of another design.
[[nodiscard]] std::optional<LongestCourse> longest_course(const Campaign& campaign, const Forecast& forecast);

/// Returns the sum of the scene's estimates for distinct cases without a proven answer. Throws InputError if all
/// cases are impossible, or one needs more memory than `room`, bytes.
[[nodiscard]] Forecast forecast(const SceneInfo& scene, const Cases& cases,
                                double room = std::numeric_limits<double>::infinity());

}  // namespace grainsweep::campaign
