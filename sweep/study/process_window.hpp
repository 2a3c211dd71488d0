// Where a condition on a campaign's responses holds, and the best setting there.
//
// Every observable that condition or objective names has a response model (response_models.hpp); the models' errors
// are independent of one another and normal (stats/process_window.hpp). At a setting x
//
//   P(x) = sum over the subsets U of the observables that can be undefined of
//          prod_{k in U} (1 - d_k(x)) prod_{k not in U} d_k(x) P(condition holds | those in U undefined)
//
// with d_k(x) the probability that observable k is defined there. A comparison with an undefined value is not true, and
// the condition does not hold where the objective is undefined. Where the nearest cases failed (cases_near.hpp), or a
// feature of a model has no number, P is 0: no setting there is best, surest, on the front or run next, and none counts
// for the share. The objective may be a
// factor, too (the fastest setting that is good enough): it has no error, and next cases are those of the largest P(x)
// (x_j - x_j*), the expected improvement on the best x_j* of the window. The box is searched at 4,096 Sobol points
// (levels as they are), less those that the campaign's `where` leaves out; the best is then improved by Sobol points in
// boxes about it that shrink to a thousandth of the range. Best is the largest mean less one standard error, the
// effective best of Huang et al. 2006 (stats/process_window.hpp), with which next cases are compared, too. Settings are
// rounded to what an engineer can set: a two-thousandth of the range or finer. Of factors that follow a distribution
// the box is its range (stats::Distribution::range), the points are its quantiles, and a share of them is a
// probability. Nothing is drawn: same cases in, same window out.
#pragma once

#include "stats/process_window.hpp"
#include "sweep/study/box_search.hpp"
#include "sweep/study/cases_near.hpp"
#include "sweep/study/condition.hpp"
#include "sweep/study/response_models.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace grainsweep::study {

struct WindowRequest {
    std::string where{};      ///< empty: holds everywhere
    std::string objective{};  ///< observable or factor; empty: none, the setting where the condition is surest
    bool maximise = true;
    double risk = 0.05;
    stats::Judged judged = stats::Judged::mean;
    std::size_t next = 0;           ///< cases to run next
    std::size_t candidates = 4096;  ///< Sobol points of the box
};

/// A setting and what the models say of it.
struct Judgement {
    Setting setting;
    std::vector<stats::Prediction> predictions;  ///< one per model
    std::vector<double> defined;                 ///< the same: probability that the observable is defined
    stats::Prediction objective{};               ///< where there is one; of a factor its value, without error
    Near near;                                   ///< failed cases near the setting
    bool believed = true;                        ///< the nearest cases have answers, every feature has a number
    double probability = std::numeric_limits<double>::quiet_NaN();
};

struct Window {
    std::vector<ObservableModel> models;  ///< the objective's first, where it is an observable
    bool objective_is_factor = false;
    std::vector<Setting> searched;       ///< of the box
    double share_of_box = 0;             ///< of the searched points with P >= 1 - risk
    double share_error = 0;              ///< standard error of that share: sqrt(s (1 - s)/n), an upper bound for Sobol
    double share_failed = 0;             ///< of the searched points whose nearest cases failed
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
                                                    const Window& window, std::span<const Setting> settings);

/// A campaign file that runs the next cases: `name` its campaign, a list of the settings. Its seed is that of the
/// campaign plus `number`, the batch's from 1: a setting that is asked again is a new run.
[[nodiscard]] std::string next_campaign(const ModelCases& cases, const Window& window, std::string_view name,
                                        std::uint64_t number);

}  // namespace grainsweep::study
