// What a campaign measured over time or over bins: the curves that the page draws.
#pragma once

#include "sweep/store/store.hpp"
#include "sweep/study/responses.hpp"

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace grainsweep::study {

/// One case; `label` says its factors, the same for its repeats.
struct Curve {
    std::size_t row = 0;  ///< of the responses
    std::string label;
    std::vector<double> x, y;
};

/// One observable: of a series y over time; of a profile, or of a histogram at one of its times, y over bins.
struct CurveFamily {
    std::string name, unit, meaning, over;  ///< over: words of the horizontal axis
    bool over_bins = false;
    double at_time = std::numeric_limits<double>::quiet_NaN();  ///< of a histogram taken at several times
    std::vector<Curve> curves;
};

/// The curves of completed cases, at most `most_curves` of them drawn at random, thinned to `most_samples` each.
/// A histogram taken at several times is shown at the one a quarter of the way.
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
