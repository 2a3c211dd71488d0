// What a campaign will probably cost, before anything is run.
#pragma once

#include "sweep/campaign/campaign.hpp"

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace grainsweep::campaign {

/// A warning of the scene that some cases of a campaign draw.
struct Caution {
    std::string kind;
    std::string sentence;  ///< of the first of them
    std::int64_t first_point = 0;
    std::int64_t questions = 0;  ///< how many draw it
};

struct Forecast {
    std::int64_t places = 0;      ///< cases as placed in the design
    std::int64_t questions = 0;   ///< of those different from each other
    std::int64_t proven = 0;      ///< questions whose answer is known without simulation
    std::int64_t impossible = 0;  ///< questions whose inputs do not go together: they will be rejected
    std::string first_reason;     ///< of the first of those
    std::int64_t first_point = 0;
    double total_seconds = 0;    ///< of one plain core
    double longest_seconds = 0;  ///< the most expensive question
    double largest_bytes = 0;    ///< memory of the question that needs most
    std::int64_t largest_point = 0;
    std::vector<Caution> cautions;
    std::vector<double> seconds;  ///< of each place's question; 0 where it is proven or impossible
};

/// Warnings before a campaign runs, one sentence each: cautions with their counts, cases that stand at several places,
/// a rule of convergence that cannot be met.
[[nodiscard]] std::vector<std::string> warnings_of(const Campaign& campaign, const Forecast& forecast);

/// What is known of a case before it is computed.
struct Prediction {
    bool proven = false;     ///< its answer is known without simulation
    CostEstimate cost;       ///< 0 where it is proven or impossible
    std::string impossible;  ///< why its inputs do not go together; empty: they do
};
/// Throws std::invalid_argument where a file that the inputs name cannot be read.
[[nodiscard]] Prediction predict(const SceneInfo& scene, const Inputs& inputs);

/// Whether a scene accepts inputs, which is known without running them: where not, their case is rejected. Files that
/// they name are read once.
[[nodiscard]] std::function<bool(const Inputs&)> acceptance(const SceneInfo& scene);

/// Throws WrongQuestion where "the case of point 3" (`which`) needs more memory than `room`, bytes.
void require_memory(const std::string& which, double bytes, double room);

/// A calibration of which no wave ends early.
struct LongestCourse {
    std::int64_t waves = 0, points_per_wave = 0, checks = 0;  ///< checks: of all rounds
    double seconds = 0;                                       ///< of one plain core, at the mean cost of the first wave
};
/// Returns what a calibration costs at most; none for a campaign of another design.
[[nodiscard]] std::optional<LongestCourse> longest_course(const Campaign& campaign, const Forecast& forecast);

/// Adds the scene's own estimates over different questions without a proven answer. Throws WrongQuestion where all
/// questions are impossible, and where one needs more memory than `room`, bytes.
[[nodiscard]] Forecast forecast(const SceneInfo& scene, const Cases& cases,
                                double room = std::numeric_limits<double>::infinity());

}  // namespace grainsweep::campaign
