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
// The front of computed cases has the observed values, averaged over the runs of a setting. The front of predictions
// has only settings at which both errors of the mean are at most a tenth of the range of the computed values.
//
// Of two objectives, the front has settings where the condition holds (trade_off.hpp). The best setting has the largest
// product of both gains over the reference point. The next cases maximise P(x) EHVI(x) (stats/hypervolume.hpp) times
// the part of the error that one run removes, the larger of the two objectives. The box is searched further about the
// settings of the largest such gain and about the front of predictions.
//
// The cases of a batch differ: by at least a tenth of the range of a searched factor, or as much as is possible with
// half the gain of the best case, at least a fortieth.
//
// The 95 % half-width of the share of the box has three parts in quadrature: of counting, of every model of an
// observable, and of the model of failures. The last is half the difference of the shares at the two ends of the 95 %
// interval of the probability of an answer.
//
// For factors with a distribution, the box is their range (stats::Distribution::range) and the points are quantiles, so
// a share of points is a probability. No random numbers are used: the same cases give the same window.
#pragma once

#include "sweep/study/trade_off.hpp"
#include "sweep/study/window_question.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace grainsweep::study {

/// Computed setting of a front.
struct FrontSetting : ComputedSetting {
    std::optional<Judgement> judged{};  ///< by the models; of two objectives
};

struct Window {
    std::vector<ObservableModel> models;  ///< the models of the objectives first
    std::shared_ptr<const Answers> answers;
    std::vector<Goal> goals;                   ///< one per objective
    double risk = 0.05;                        ///< of WindowRequest
    std::vector<Setting> searched;             ///< settings searched in the box
    double share_of_box = 0;                   ///< share of the searched points with P >= 1 - risk
    double share_error = 0;                    ///< its 95 % half-width, with the errors of the models
    double share_low = 0, share_high = 0;      ///< the ends of its 95 % interval
    double share_failed = 0;                   ///< share of the searched points where P(answer) is below 1 - risk
    std::optional<Judgement> best;             ///< best setting with P >= 1 - risk; empty: there is no such setting
    std::optional<Judgement> surest;           ///< setting of largest P, if there is no best
    std::vector<FrontSetting> computed_front;  ///< trade-off between objective and `against`, of the cases
    std::vector<Judgement> front;              ///< the same of predictions, by ascending objective
    std::optional<Goal> against;               ///< the second objective, or a bounded observable
    std::optional<FrontVolume> volume;         ///< of two objectives
    std::vector<BatchStanding> batches;        ///< of a search of several campaigns
    std::vector<Judgement> next;
    std::vector<std::string> notes;
};

/// Computes the window. Throws InputError for an invalid condition, an unknown name, and refused models.
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
