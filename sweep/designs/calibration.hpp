// Calibration: waves of points that narrow down the settings which reproduce the measurements.
//
// Bayesian history matching (Vernon, Goldstein & Bower 2010, Bayesian Analysis 5, 619). The first wave fills the box of
// the factors. After each wave, a response model of each target is fitted to all cases so far. A setting is kept if the
// deviation of every target is at most 3 standard deviations of model, measurement, discrepancy and scatter together
// (stats/calibration.hpp). The next wave fills the kept settings. The waves end after the last one. They end earlier in
// two cases: the error of the models is below all other errors at every kept setting, or a wave has ruled out less than
// a share `shrink` of the kept settings. Then settings drawn from the posterior are run as the predictive check.
//
// Levels, and at most 64 multiples of a step, divide their axis into equal parts; a setting is the middle of its part.
// A setting that comes again is run as a further replicate, so that the models see the scatter.
//
// A target may be the share of measured runs without a value, such as jams: its model is one of the probability of a
// completed case without a value, and its likelihood that of a count (stats/count_likelihood.hpp).
//
// Settings without an answer for some target weigh only if that depends on the factors (answering_settings.hpp). Where
// a share counts the missing values of an observable, they are no missing answers.
// Settings that the campaign's `where` excludes are neither failures nor candidates, and the posterior is 0 there.
//
// With several experiments every wave runs all of them, and all targets share the posterior. If a predictive check
// misses a target by more than 2 standard deviations and waves are left, its runs are added to the fit and another wave
// follows.
//
// The waves are a pure function of the request and depend neither on the number of workers nor on interruptions.
#pragma once

#include "stats/posterior.hpp"
#include "stats/probability_model.hpp"
#include "stats/response_model.hpp"
#include "sweep/designs/answering_settings.hpp"
#include "sweep/designs/design.hpp"
#include "sweep/designs/measured_targets.hpp"

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace grainsweep::designs {

/// Results of the models after a wave.
struct CalibrationWave {
    std::size_t settings = 0;  ///< settings of the wave
    std::size_t cases = 0;     ///< cases so far, under all conditions
    std::size_t failed = 0;    ///< settings so far that were run and have no answer to some target
    std::size_t excluded = 0;  ///< settings so far that `where` excludes
    bool of_checks = false;    ///< settings of a predictive check that missed; they are added to the fit, and another
                               ///< wave follows
    double kept = 1;           ///< share of the admitted box that is not ruled out
    /// Root mean square error of each target's model divided by the sd of its responses; NaN: no model.
    std::vector<double> model_error;
    std::vector<std::string> refusals;  ///< why a target has no model, target by target; empty: it has one
};

/// Model of a target: of its response, or of the probability that a case has no value.
using TargetModel = std::variant<stats::ResponseModel, stats::ProbabilityModel>;

/// Inputs of the models at some settings.
struct ModelInputs {
    std::vector<double> values;
    std::size_t width = 0;
    [[nodiscard]] stats::Rows rows() const { return {values, width}; }
};

/// State of a calibration.
struct Calibration {
    std::vector<Factor> factors;  ///< calibrated factors
    std::vector<MeasuredTarget> targets;
    std::vector<CalibrationWave> waves;  ///< completed waves
    bool waves_end = false;
    std::string why_they_end;                         ///< empty while they continue
    std::vector<std::optional<TargetModel>> models;   ///< one per target, from all cases of the waves
    std::vector<double> beyond;                       ///< distance of each target from the range of all cases, in sd
    AnsweringSettings answering;                      ///< from all cases of the waves
    std::optional<stats::PosteriorSample> posterior;  ///< in [0, 1]^d of the factors, after the last wave
    std::optional<stats::PosteriorShape> shape;       ///< shape of the posterior
    double least_implausibility = std::numeric_limits<double>::quiet_NaN();  ///< smallest value found
    std::vector<double> settings;            ///< settings of the completed waves, rows of d in [0, 1]
    std::size_t further = 0;                 ///< of these the first, which were computed elsewhere
    std::vector<double> checked;             ///< settings of the predictive check, rows of d in [0, 1]
    std::vector<std::vector<double>> check;  ///< answers of each target there, in their order; NaN: none
    bool checks_known = false;               ///< every run of the predictive check is settled
    PointSet points;                         ///< all points that follow from the answers

    /// Returns the models' inputs at settings of the calibrated factors: coordinates; for more than two words an
    /// indicator of each word but the first.
    [[nodiscard]] ModelInputs inputs(stats::Rows points) const;
};

/// Computes the calibration from the answers. Throws std::invalid_argument if the combination of options is impossible.
[[nodiscard]] Calibration calibration_of(const DesignRequest& request);

}  // namespace grainsweep::designs
