// Settings at which a condition on a campaign's responses holds, and the best of them.
//
// Every observable in the condition or the objective has a response model (response_models.hpp). The errors of
// different models are taken as independent (stats/process_window.hpp). window_question.hpp defines P(x), the
// probability that the condition holds at a setting. A setting where P or the probability of an answer is below 1 -
// risk does not count in the share, is not on the front, and is not the best. Settings whose answer is certain are
// preferred as the best.
//
// The objective may be a factor (the fastest setting that is good enough). It then has no error. The next cases
// maximise P(x) (x_j - x_j*), the expected improvement on the best value x_j* in the window.
//
// The box is searched at 4,096 Sobol points (levels as they are), without those that the campaign's `where` excludes.
// The best setting is then improved by Sobol points in boxes around it that shrink to a thousandth of the range. Best
// means the largest mean minus one standard error, the effective best of Huang et al. 2006 (stats/process_window.hpp).
// Next cases are compared with it, too. Settings are rounded to a two-thousandth of the range or finer.
//
// For factors with a distribution, the box is their range (stats::Distribution::range) and the points are quantiles, so
// a share of points is a probability. No random numbers are used: the same cases give the same window.
#pragma once

#include "sweep/study/window_question.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace grainsweep::study {

struct Window {
    std::vector<ObservableModel> models;  ///< the model of the objective first, if it is an observable
    std::shared_ptr<const Answers> answers;
    bool objective_is_factor = false;
    double risk = 0.05;                  ///< of WindowRequest
    std::vector<Setting> searched;       ///< settings searched in the box
    double share_of_box = 0;             ///< share of the searched points with P >= 1 - risk
    double share_error = 0;              ///< its 95 % half-width, with the errors of the models
    double share_failed = 0;             ///< share of the searched points where P(answer) is below 1 - risk
    std::optional<Judgement> best;       ///< best setting with P >= 1 - risk; empty: there is no such setting
    std::optional<Judgement> surest;     ///< setting of largest P, if there is no best
    std::vector<Judgement> front;        ///< trade-off between objective and `against`, by ascending objective
    std::optional<std::size_t> against;  ///< index of a model
    bool against_maximised = false;
    std::vector<Judgement> next;
    std::vector<std::string> notes;
};

/// Computes the window. Throws WrongQuestion for an invalid condition, an unknown name, and refused models.
[[nodiscard]] Window window_of(const store::Store& store, const ModelCases& cases, const WindowRequest& request);

/// Returns the predictions of a window's models at other settings.
[[nodiscard]] std::vector<Judgement> judge_settings(const ModelCases& cases, const WindowRequest& request,
                                                    const Window& window, const Admits& admits,
                                                    std::span<const Setting> settings);

/// Returns a campaign file that runs the next cases as the campaign `name` with a list of settings. Its seed is the
/// campaign's seed plus `number`, the number of the batch from 1, so that a repeated setting is a new run.
[[nodiscard]] std::string next_campaign(const ModelCases& cases, const Window& window, std::string_view name,
                                        std::uint64_t number);

}  // namespace grainsweep::study
