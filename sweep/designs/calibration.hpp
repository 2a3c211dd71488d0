// Calibration: waves of points that close in on the settings which reproduce what was measured.
//
// Bayesian history matching (Vernon, Goldstein & Bower 2010, Bayesian Analysis 5, 619). The first wave fills the box of
// the factors. Then, wave by wave, a response model of each target learns all cases so far. A setting is kept if no
// target is further off than 3 standard deviations of model, measurement, discrepancy and scatter together
// (stats/calibration.hpp). The next wave fills the kept settings. It ends after the last wave; or when the models are
// more certain than all other errors at every kept setting; or when a wave has ruled out less than a share `shrink` of
// the kept settings. Settings drawn from the posterior are then run: the predictive check.
//
// Where more than 5 % of the settings gave no answer to some target, those count as ruled out of whose five nearest
// neighbours most failed.
//
// With several experiments every wave runs all of them, and the models of all targets share the posterior. Then, while
// a predictive check misses a target by more than 2 standard deviations and waves are left, its runs are learned with
// the others and another wave follows.
//
// What the answers say is a pure function of the request: waves do not depend on the number of workers, nor on
// interruptions.
#pragma once

#include "stats/posterior.hpp"
#include "stats/response_model.hpp"
#include "sweep/designs/design.hpp"
#include "sweep/designs/measured_targets.hpp"

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace grainsweep::designs {

/// What the models say after a wave.
struct CalibrationWave {
    std::size_t settings = 0;  ///< of the wave
    std::size_t cases = 0;     ///< so far, all conditions
    std::size_t failed = 0;    ///< settings so far without an answer to some target
    bool of_checks = false;    ///< settings of a predictive check that missed: learned, and another wave follows
    double kept = 1;           ///< share of the box that is not ruled out
    /// Root mean square error of each target's model over the sd of its responses; NaN where there is no model.
    std::vector<double> model_error;
    std::vector<std::string> refusals;  ///< why there is none, target by target; empty: there is one
};

/// All that is known of a calibration.
struct Calibration {
    std::vector<std::string> factors;  ///< that are calibrated
    std::vector<FactorRange> ranges;   ///< of those
    std::vector<MeasuredTarget> targets;
    std::vector<CalibrationWave> waves;  ///< those answered
    bool waves_end = false;
    std::string why_they_end;                                 ///< empty while they go on
    std::vector<std::optional<stats::ResponseModel>> models;  ///< of the targets, from all cases of the waves
    std::vector<double> beyond;                               ///< how far each target lies beyond every case, in sd
    std::optional<stats::PosteriorSample> posterior;          ///< in [0, 1]^d of the factors, when the waves have ended
    std::optional<stats::PosteriorShape> shape;               ///< of it
    double least_implausibility = std::numeric_limits<double>::quiet_NaN();  ///< found anywhere
    std::vector<double> settings;            ///< of the waves answered, rows of d in [0, 1]
    std::vector<double> checked;             ///< settings of the predictive check, rows of d in [0, 1]
    std::vector<std::vector<double>> check;  ///< of each target the answers there, in their order; NaN: none yet
    PointSet points;                         ///< all that follow from the answers
};

/// Throws std::invalid_argument where the options are impossible together.
[[nodiscard]] Calibration calibration_of(const DesignRequest& request);

}  // namespace grainsweep::designs
