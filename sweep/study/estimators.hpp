// Moments of a campaign by two estimators: plain, and with a response model as control variate, which says the same
// from fewer cases (stats/assisted_moments.hpp has the equations and how the errors are checked).
//
// The rules but `assisted` judge the plain one; the other is shown beside it, with and without the scatter of
// single runs. Both estimators use the same cases: the settled prefix of the design, by its independent sequences. They
// refer to the box without the parts that the campaign's `where` leaves out (4 scramblings of 8,192 Sobol points).
// Features: as the campaign file has them, else the factors, logarithms where the range is wide. Ratios of factors are
// not tried here: which one lowers the error is a choice by the very cases that are corrected.
//
// The variance of single runs comes from replicates, where at least 100 cases repeat others of their point. Otherwise
// it is the square of NAME_standard_error, where the scene states it (0 where undefined), or unknown.
#pragma once

#include "stats/assisted_moments.hpp"
#include "sweep/store/store.hpp"
#include "sweep/study/history.hpp"
#include "sweep/study/responses.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace grainsweep::study {

struct Estimators {
    std::optional<stats::AssistedMoments> assisted;  ///< none: refused
    std::string refused;                             ///< why: one sentence without a full stop
    std::vector<std::string> features;
    std::size_t without_value = 0;  ///< settled cases
    std::string scatter_from;       ///< "replicates" or the observable that states it; empty: unknown
};

/// Throws WrongQuestion where a feature of the campaign file cannot be evaluated.
[[nodiscard]] Estimators estimators_of(const store::Store& store, const Responses& responses,
                                       const ResponseColumn& response);

}  // namespace grainsweep::study
