// What a response looks like over its values and over each factor: binned, so that a picture of ten thousand cases
// is as light as one of a hundred.
#pragma once

#include "stats/variance_split.hpp"
#include "sweep/study/responses.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace grainsweep::study {

/// Counts in bins of equal width over [low, high]; the last bin includes high. All values equal: one bin.
struct Histogram {
    double low = 0, high = 0;
    std::vector<std::int64_t> counts;
};

/// Finite values in clamp(2 n^(1/3), 5, 40) bins (Rice's rule).
[[nodiscard]] Histogram histogram_of(std::span<const double> values);

/// Where the 95 % errors of binned means come from.
///
///   parts       a sample: the design's parts left out in turn (jackknife), which holds the spread of the other factors
///               over the bin and the scatter of single runs
///   pure_error  a lattice or a list with replicates: the scatter of single runs, sigma t / sqrt(n) with sigma^2 the
///               pure error; the means are over just these settings of the other factors, which are no sample
///   none        a lattice or a list of single runs: the values in a bin differ by the other factors, which says
///               nothing of an error
struct EffectErrors {
    enum class Source { none, pure_error, parts };
    Source source = Source::none;
    std::vector<std::size_t> parts;  ///< one label per settled row
    stats::PureError pure;           ///< of the replicates, where there are any
    std::string says;                ///< what whiskers are, in one sentence
};
[[nodiscard]] EffectErrors effect_errors(const Responses& responses, const ResponseColumn& response);

/// The mean response near one value of a factor.
struct EffectBin {
    double at = 0;          ///< mean of the factor in the bin, or index of the level
    double mean = 0;        ///< of the response
    double error = 0;       ///< 95 % half-width, see EffectErrors; NaN: none, or fewer than four parts in the bin
    double pure_error = 0;  ///< what the scatter of single runs alone gives; NaN without replicates
    std::int64_t count = 0;
};

/// Main effect of a factor: levels and up to 16 distinct values each make a bin, else 16 bins of equal count (fewer
/// where that would leave less than 8 cases in each). Rows without a response are left out.
[[nodiscard]] std::vector<EffectBin> main_effect(const FactorColumn& factor, std::span<const double> response,
                                                 const EffectErrors& errors);

}  // namespace grainsweep::study
