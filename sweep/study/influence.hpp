// Influence of each factor on a response, from the stored values; shown by `sensitivity` and the report.
//
//   any design    first-order indices by binning: 16 bins of equal count, fewer below 256 points. Each level, and each
//                 coordinate of a lattice, is a bin of its own
//   saltelli      first-order indices from the first two points of every block, and total indices by Jansen 1999
//   morris        elementary effects per unit of the range: mu*, sigma; no indices, because the points are too few
// Shown beside them: the trend of the response with each factor, and the variance that main effects do not explain. If
// there are replicates, this part is split into interactions and scatter of single runs (stats/variance_split.hpp).
// Failed cases are left out and counted. Estimators and errors: stats/sensitivity.hpp.
#pragma once

#include "stats/sensitivity.hpp"
#include "stats/variance_split.hpp"
#include "sweep/study/responses.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::study {

/// Trend of the response with a factor, from its binned means.
enum class Trend {
    unknown,  ///< words have no order, or the influence cannot be distinguished from zero
    rises,    ///< the best rising curve explains 90 % of the variance of the binned means
    falls,
    bends  ///< neither
};
[[nodiscard]] std::string_view to_string(Trend trend);  ///< empty for `unknown`

struct FactorInfluence {
    std::string factor;                               ///< name of the factor, or of its group
    std::vector<std::string> members;                 ///< names of the factors of a group, which change together
    std::size_t bins = 0;                             ///< bins of `first`
    stats::SensitivityIndex first;                    ///< share of the variance the factor explains alone
    stats::SensitivityIndex first_saltelli;           ///< saltelli: `first` by Saltelli et al. 2010
    stats::SensitivityIndex total;                    ///< saltelli: with all interactions
    std::optional<stats::ElementaryEffects> effects;  ///< morris
    stats::SensitivityIndex rank_correlation;         ///< Spearman's, of factor and response; none for words
    Trend trend = Trend::unknown;
};

struct Influence {
    enum class Method { given_data, saltelli, morris };
    Method method = Method::given_data;
    std::vector<FactorInfluence> factors;  ///< in the campaign's order; saltelli, morris: one per group
    std::int64_t used = 0;                 ///< cases (saltelli: base rows; morris: effects of the factor with fewest)
    std::int64_t excluded = 0;             ///< left out because they have no value
    stats::VarianceSplit split;            ///< parts of the variance of single runs; morris: pure error only
    std::vector<std::string> notes;        ///< to be read before the numbers are quoted
};

/// Returns one or two sentences on the variance that the indices do not explain and its parts; empty if it is unknown.
[[nodiscard]] std::string unexplained_text(const Influence& influence);

[[nodiscard]] Influence influence_of(const Responses& responses, const ResponseColumn& response);

}  // namespace grainsweep::study
