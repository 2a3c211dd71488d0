// Where a condition on a campaign's responses holds, and the best setting there.
//
// Every observable that condition or objective names has a response model (response_models.hpp); the models' errors
// are independent of one another (stats/process_window.hpp). window_question.hpp has the probability P(x) that the
// condition holds at a setting, with that of an answer in it: no setting is best, counted for the share or on the front
// where P or the probability of an answer is below 1 - risk, and the best one answers surely where one does. The
// objective may be a factor, too (the fastest setting that is good enough): it has no error, and next cases are those
// of the largest P(x) (x_j - x_j*), the expected improvement on the best x_j* of the window. The box is searched at
// 4,096 Sobol points (levels as they are), less those that the campaign's `where` leaves out; the best is then improved
// by Sobol points in boxes about it that shrink to a thousandth of the range. Best is the largest mean less one
// standard error, the effective best of Huang et al. 2006 (stats/process_window.hpp), with which next cases are
// compared, too. Settings are rounded to what an engineer can set: a two-thousandth of the range or finer. Of factors
// that follow a distribution the box is its range (stats::Distribution::range), the points are its quantiles, and a
// share of them is a probability. Nothing is drawn: same cases in, same window out.
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
    std::vector<ObservableModel> models;  ///< the objective's first, where it is an observable
    std::shared_ptr<const Answers> answers;
    bool objective_is_factor = false;
    double risk = 0.05;                  ///< of the request
    std::vector<Setting> searched;       ///< of the box
    double share_of_box = 0;             ///< of the searched points with P >= 1 - risk
    double share_error = 0;              ///< standard error of that share: sqrt(s (1 - s)/n), an upper bound for Sobol
    double share_failed = 0;             ///< of the searched points where P(answer) is below 1 - risk
    std::optional<Judgement> best;       ///< with P >= 1 - risk; none: there is no such setting
    std::optional<Judgement> surest;     ///< where there is no best: the setting of largest P
    std::vector<Judgement> front;        ///< trade-off of objective and `against`, by growing objective
    std::optional<std::size_t> against;  ///< index of a model
    bool against_maximised = false;
    std::vector<Judgement> next;
    std::vector<std::string> notes;
};

/// Throws WrongQuestion for a condition that cannot be read, an unknown name, and models that are refused.
[[nodiscard]] Window window_of(const store::Store& store, const ModelCases& cases, const WindowRequest& request);

/// What the models of a window say of further settings.
[[nodiscard]] std::vector<Judgement> judge_settings(const ModelCases& cases, const WindowRequest& request,
                                                    const Window& window, const Admits& admits,
                                                    std::span<const Setting> settings);

/// A campaign file that runs the next cases: `name` its campaign, a list of the settings. Its seed is that of the
/// campaign plus `number`, the batch's from 1: a setting that is asked again is a new run.
[[nodiscard]] std::string next_campaign(const ModelCases& cases, const Window& window, std::string_view name,
                                        std::uint64_t number);

}  // namespace grainsweep::study
