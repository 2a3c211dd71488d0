// Moments of a campaign by two estimators: plain, and with a response model as control variate, which needs fewer cases
// for the same error (equations and checks of the errors: stats/assisted_moments.hpp).
//
// All rules except `assisted` judge the plain estimate. The other estimate is shown beside it, with and without the
// scatter of single runs. Both estimators use the same cases: the settled prefix of the design, by its independent
// sequences. They refer to the box without the parts that the campaign's `where` excludes (4 scramblings of 8,192 Sobol
// points). Features: those of the campaign file, else the factors, or their logarithms if the range is wide. Ratios of
// factors are not tried here: choosing one by its error would use the same cases that the model then corrects.
//
// The variance of single runs comes from replicates, if at least 100 cases repeat another case of their point.
// Otherwise it is the square of NAME_standard_error, if the scene has this observable (0 where undefined), else
// unknown.
#pragma once

#include "stats/assisted_moments.hpp"
#include "sweep/store/store.hpp"
#include "sweep/study/history.hpp"
#include "sweep/study/responses.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace grainsweep::study {

struct Estimators {
    std::optional<stats::AssistedMoments> assisted;  ///< empty: refused
    std::string refused;                             ///< reason: one sentence without a full stop
    std::vector<std::string> features;
    std::size_t without_value = 0;  ///< settled cases
    std::string scatter_from;       ///< "replicates" or the observable that states it; empty: unknown
};

/// Returns both estimates, and those of `levels` with the model. Throws InputError if a feature of the campaign file
/// cannot be evaluated.
[[nodiscard]] Estimators estimators_of(const store::Store& store, const Responses& responses,
                                       const ResponseColumn& response, std::span<const stats::Level> levels = {});

}  // namespace grainsweep::study
