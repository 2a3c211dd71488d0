// Calibration: waves of points that close in on the settings which reproduce what was measured.
//
// Bayesian history matching (Vernon, Goldstein & Bower 2010, Bayesian Analysis 5, 619). The first wave fills the box of
// the factors. Then, wave by wave, a response model of each target is made from all cases so far; a setting is kept
// where no target is further off than 3 standard deviations of model, measurement, discrepancy and scatter together
// (stats/calibration.hpp); the next wave fills what is kept. It ends after the last wave; or when the models are surer
// than everything else everywhere kept, so that more cases could not rule out more; or when a wave has ruled out less
// than a share `shrink` of what was kept. Settings drawn from the posterior are then run: the predictive check.
//
// What the answers say is a pure function of the request: waves do not depend on the number of workers, nor on
// interruptions.
#pragma once

#include "stats/posterior.hpp"
#include "stats/response_model.hpp"
#include "sweep/designs/design.hpp"

#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::designs {

/// What was measured, under which condition.
struct MeasuredTarget {
    std::string observable;  ///< a scalar, or a place along a curve (curve_place.hpp)
    double value = 0;
    double error = 0;                            ///< standard error of the measurement
    double discrepancy = 0;                      ///< standard deviation of what the simulation leaves out
    std::map<std::string, std::size_t> level{};  ///< of each condition factor, by number
    std::size_t curve = 0;                       ///< targets of one measured curve share a number above 0
    bool operator==(const MeasuredTarget&) const = default;
};

/// Covariance of measurement and discrepancy, row-major: errors are independent; along a curve discrepancies are off
/// together, with the correlation exp(-|x - x'|/L), L a quarter of the curve's length: what the simulation leaves out
/// does not change from one point of a curve to the next.
[[nodiscard]] std::vector<double> covariance_of(std::span<const MeasuredTarget> targets);

/// Targets as one line of text, as the option "targets" holds them, and back.
[[nodiscard]] std::string text_of(const std::vector<MeasuredTarget>& targets);
/// Throws std::invalid_argument for any other text.
[[nodiscard]] std::vector<MeasuredTarget> targets_in(std::string_view text);

/// What the models say after a wave.
struct CalibrationWave {
    std::size_t settings = 0;  ///< of the wave
    std::size_t cases = 0;     ///< so far, all conditions
    std::size_t failed = 0;    ///< of those, without an answer to some target
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
