// Curves over time or over bins that a campaign measured, for the report.
#pragma once

#include "sweep/store/store.hpp"
#include "sweep/study/responses.hpp"

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace grainsweep::study {

/// Curve of one case. `label` names its factors; replicates have the same label.
struct Curve {
    std::size_t row = 0;  ///< row of Responses
    std::string label;
    std::vector<double> x, y;
};

/// Curves of one observable: of a series, y against time; of a profile, or of a histogram at one of its times, y
/// against bins.
struct CurveFamily {
    std::string name, unit, meaning, over;  ///< over: label of the horizontal axis
    bool over_bins = false;
    double at_time = std::numeric_limits<double>::quiet_NaN();  ///< of a histogram taken at several times
    std::vector<Curve> curves;
};

/// Curves of completed cases, at most `most_curves` of them chosen at random, each thinned to `most_samples`. A
/// histogram taken at several times is shown at one quarter of them.
struct CurveChoice {
    std::size_t most_curves = 24;
    std::size_t most_samples = 200;
};
struct Curves {
    std::size_t completed = 0, drawn = 0;  ///< cases
    std::vector<CurveFamily> families;     ///< in the order of the scene's observables
};
[[nodiscard]] Curves read_curves(const store::Store& store, const Responses& responses, const CurveChoice& choice = {});

}  // namespace grainsweep::study
