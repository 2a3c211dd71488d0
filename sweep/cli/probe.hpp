// One case of a campaign, computed to find out what the others will take.
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

/// Computes, in this process, the case of median predicted cost among those that are not settled, proven or impossible;
/// none where there is no such case. Nothing is stored.
[[nodiscard]] std::optional<Probe> probe_median_case(const campaign::Campaign& campaign, const campaign::Cases& cases,
                                                     const campaign::Forecast& forecast,
                                                     const std::vector<bool>& settled);

/// Multiplies predicted seconds by measured seconds divided by predicted ones.
void scale_by(const Probe& probe, campaign::Forecast& forecast);

[[nodiscard]] std::string probe_text(const Probe& probe);
[[nodiscard]] report::Json probe_json(const Probe& probe);

/// 0.25 s, 1 min 15 s.
[[nodiscard]] std::string seconds_text(double seconds);

}  // namespace grainsweep::cli
