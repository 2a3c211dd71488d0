// Trade-off of two quantities: computed settings that no other beats, the hypervolume that they dominate, and what the
// front of the whole box may dominate beyond it (stats/hypervolume.hpp).
//
// The value of a computed setting is the mean response there by the models, which contain all its runs. The largest
// runs alone would make a front of lucky runs. A setting counts if the condition holds there with probability 1 - risk.
//
// 95 % half-width of the hypervolume: of how far it moves if the mean of one objective lies everywhere at the same end
// of its interval, in quadrature over the objectives. The front of the box has the computed settings and all settings
// that were searched, and may have points between them. Its upper end is that of all settings at once, at 3 standard
// errors of both objectives, with settings that meet the condition if the mean of one model, or the probability of an
// answer, lies at the end of its interval.
#pragma once

#include "stats/hypervolume.hpp"
#include "sweep/study/window_question.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace grainsweep::study {

/// Setting with answered cases.
struct ComputedSetting {
    Setting setting;  ///< of the question: NaN where a factor is averaged over
    std::int64_t runs = 0;
    double objective = 0, against = 0;  ///< means over the runs
    std::size_t source = 0;             ///< of the first run: ModelCases::sources
};

/// Returns the computed settings with both values, in the order of the first run.
[[nodiscard]] std::vector<ComputedSetting> computed_settings(const ModelCases& cases, const WindowQuestion& question,
                                                             const Goal& objective, const Goal& against);

/// Returns the judgement of computed settings.
[[nodiscard]] std::vector<Judgement> judge_computed(const WindowQuestion& question,
                                                    std::span<const ComputedSetting> computed);

/// Hypervolume of the front of computed settings.
struct FrontVolume {
    double value = 0;
    double error = 0;    ///< 95 % half-width
    double further = 0;  ///< by how much more the front of the box may dominate, at most by the models; too small where
                         ///< they see none
};

/// Returns what the settings dominate. They need both objectives.
[[nodiscard]] stats::Hypervolume dominated(const WindowQuestion& question, std::span<const Judgement> computed);
[[nodiscard]] FrontVolume front_volume(const WindowQuestion& question, std::span<const Judgement> computed,
                                       std::span<const Judgement> searched);

/// State of a search after a campaign, by the models of all cases.
struct BatchStanding {
    std::string campaign;
    std::int64_t cases = 0;               ///< answered cases that no earlier campaign has
    std::optional<Judgement> best{};      ///< of the settings computed so far; of one objective
    std::optional<FrontVolume> volume{};  ///< of the settings computed so far; of two objectives
};

/// Returns the state after each campaign of the search; empty: there is one campaign, or no objective.
[[nodiscard]] std::vector<BatchStanding> standings(const ModelCases& cases, const WindowQuestion& question);

}  // namespace grainsweep::study
