#include "sweep/cli/probe.hpp"

#include "sweep/campaign/program.hpp"
#include "sweep/cli/program_case.hpp"
#include "sweep/cli/progress.hpp"
#include "sweep/workers/compute.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace grainsweep::cli {
namespace {

campaign::CaseResult probed_answer(const campaign::Case& question, std::optional<double> limit_seconds) {
    if (auto program = campaign::known_program(question.scene))
        return answer_by_program(std::move(program), question, 1, limit_seconds, {}, {});
    NoArtefacts artefacts;
    return workers::compute(question, 1, artefacts, std::nullopt, [](const Scene&) { return true; }).value();
}

}  // namespace

std::optional<Probe> probe_median_case(const campaign::Campaign& campaign, const campaign::Cases& cases,
                                       const campaign::Forecast& forecast, const std::vector<bool>& settled) {
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < cases.size(); ++i)
        if (!settled[i] && cases.is_first(i) && forecast.seconds[i] > 0) open.push_back(i);
    if (open.empty()) return std::nullopt;
    const auto median = open.begin() + static_cast<std::ptrdiff_t>(open.size() / 2);
    std::ranges::nth_element(open, median, {}, [&](std::size_t i) { return std::pair(forecast.seconds[i], i); });
    const auto question = cases.question(*median);
    const auto result = probed_answer(question, campaign.limits.wall_seconds);
    return Probe{cases.place(*median).point,
                 question.id,
                 result.outcome,
                 result.message,
                 forecast.seconds[*median],
                 result.program ? result.cost.wall_seconds : result.cost.cpu_seconds};
}

void scale_by(const Probe& probe, campaign::Forecast& forecast) {
    const double factor = probe.measured / probe.predicted;
    forecast.total_seconds *= factor;
    forecast.longest_seconds *= factor;
    for (double& seconds : forecast.seconds) seconds *= factor;
}

std::string probe_text(const Probe& probe) {
    auto text =
        fmt::format("point {} took {}, {} were predicted; the times above are scaled by {:.2g}", probe.point,
                    seconds_text(probe.measured), seconds_text(probe.predicted), probe.measured / probe.predicted);
    if (probe.outcome != campaign::Outcome::completed)
        text += fmt::format(". It ended as {}{}{}", campaign::to_string(probe.outcome),
                            probe.message.empty() ? "" : ": ", probe.message);
    return text;
}

report::Json probe_json(const Probe& probe) {
    return {{"point", probe.point},
            {"case_id", probe.case_id},
            {"outcome", campaign::to_string(probe.outcome)},
            {"message", probe.message},
            {"predicted_seconds", probe.predicted},
            {"measured_seconds", probe.measured}};
}

std::string seconds_text(double seconds) {
    return seconds < 60 ? fmt::format("{:.2g} s", seconds) : duration(seconds);
}

}  // namespace grainsweep::cli
