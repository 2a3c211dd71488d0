// Histogram of a response, and its mean in bins of each factor and in cells of two. A figure of ten thousand cases
// therefore has no more elements than one of a hundred.
#pragma once

#include "stats/variance_split.hpp"
#include "sweep/study/responses.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace grainsweep::study {

/// Histogram: counts in bins of equal width in [low, high]; the last bin includes high. One bin if all values are
/// equal.
struct Histogram {
    double low = 0, high = 0;
    std::vector<std::int64_t> counts;
};

/// Returns the histogram of the finite values in clamp(2 n^(1/3), 5, 40) bins (Rice's rule).
[[nodiscard]] Histogram histogram_of(std::span<const double> values);

/// Source of the 95 % errors of binned means.
///
///   parts       sampled designs: jackknife that leaves out parts of the design. It includes the spread of the other
///               factors in the bin and the scatter of single runs
///   pure_error  a lattice or a list with replicates: scatter of single runs, sigma t / sqrt(n), sigma^2 the pure
///               error; the settings of the other factors are fixed, so their spread is no error
///   none        a lattice or a list of single runs: the values in a bin differ by the other factors, so no error is
///               known
struct EffectErrors {
    enum class Source { none, pure_error, parts };
    Source source = Source::none;
    std::vector<std::size_t> parts;  ///< one label per settled row
    stats::PureError pure;           ///< of the replicates, if there are any
    std::string says;                ///< meaning of the whiskers in one sentence
};
[[nodiscard]] EffectErrors effect_errors(const Responses& responses, const ResponseColumn& response);

/// Mean response near one value of a factor.
struct EffectBin {
    double at = 0;          ///< mean of the factor in the bin, or index of the level
    double mean = 0;        ///< of the response
    double error = 0;       ///< 95 % half-width, see EffectErrors; NaN: none, or fewer than four parts in the bin
    double pure_error = 0;  ///< error from the scatter of single runs alone; NaN without replicates
    std::int64_t count = 0;
};

/// Returns the main effect of a factor. Each level, and each of up to 16 distinct values, is a bin. Otherwise there are
/// 16 bins of equal count, or fewer so that each has at least 8 cases. Rows without a response are left out.
[[nodiscard]] std::vector<EffectBin> main_effect(const FactorColumn& factor, std::span<const double> response,
                                                 const EffectErrors& errors);

/// Mean response in cells of two factors. Each level, and each of up to 12 distinct values, is a cell of its own.
/// Otherwise sqrt(n/8) cells, 3 to 14, divide the range evenly, a logarithmic range in its logarithm.
struct CellMeans {
    std::vector<double> x_edges, y_edges;  ///< for levels -0.5, 0.5, ...
    std::vector<double> means;             ///< row by row along y; NaN: cell without a case
};

/// Returns the means over the rows that have values of both factors and of the response.
[[nodiscard]] CellMeans cell_means(const FactorColumn& across, const FactorColumn& up, const ResponseColumn& response);

}  // namespace grainsweep::study
