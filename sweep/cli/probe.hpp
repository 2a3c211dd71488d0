// One case of a campaign, computed to measure the time of the others.
#pragma once

#include "sweep/campaign/campaign.hpp"
#include "sweep/campaign/case.hpp"
#include "sweep/campaign/forecast.hpp"
#include "sweep/report/table.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace grainsweep::cli {

struct Probe {
    std::int64_t point = 0;
    campaign::CaseId case_id;
    campaign::Outcome outcome{};
    std::string message;
    double predicted = 0;  ///< seconds
    double measured = 0;   ///< seconds: processor time of a scene, time of a program
};

/// Computes, in this process, the case of median predicted cost among the cases that are not settled, proven or
/// impossible. Empty if there is no such case. The answer is not stored.
[[nodiscard]] std::optional<Probe> probe_median_case(const campaign::Campaign& campaign, const campaign::Cases& cases,
                                                     const campaign::Forecast& forecast,
                                                     const std::vector<bool>& settled);

/// Multiplies all predicted seconds by the ratio of measured to predicted seconds of the probe.
void scale_by(const Probe& probe, campaign::Forecast& forecast);

[[nodiscard]] std::string probe_text(const Probe& probe);
[[nodiscard]] report::Json probe_json(const Probe& probe);

/// Returns a text such as "0.25 s" or "1 min 15 s".
[[nodiscard]] std::string seconds_text(double seconds);

}  // namespace grainsweep::cli
