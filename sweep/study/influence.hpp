// Which factor moves a response, from the values a campaign has: what `sensitivity` and the page show.
//
//   any design    first-order indices by binning: 16 bins of equal count, fewer below 256 points; a level, and a
//                 coordinate of a lattice, is a bin of its own
//   saltelli      the same of the first two points of every block, and total indices by Jansen 1999
//   morris        elementary effects per unit of the range: mu*, sigma (indices would mean nothing on so few points)
// Beside them: which way the response goes with each factor, and what the main effects leave unexplained, split into
// interactions and the scatter of single runs where replicates allow (stats/variance_split.hpp).
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

/// Which way the response goes with a factor, by its binned means.
enum class Trend {
    unknown,  ///< words have no order; or there is no telling from zero
    rises,    ///< the best rising curve explains 90 % of the variance of the binned means
    falls,
    bends  ///< neither
};
[[nodiscard]] std::string_view to_string(Trend trend);  ///< unknown: empty

struct FactorInfluence {
    std::string factor;                               ///< its name, or that of a group
    std::vector<std::string> members;                 ///< of a group of several factors that move together: their names
    std::size_t bins = 0;                             ///< behind `first`
    stats::SensitivityIndex first;                    ///< share of the variance the factor explains alone
    stats::SensitivityIndex first_saltelli;           ///< saltelli: the same by Saltelli et al. 2010
    stats::SensitivityIndex total;                    ///< saltelli: with all interactions
    std::optional<stats::ElementaryEffects> effects;  ///< morris
    stats::SensitivityIndex rank_correlation;         ///< Spearman's, of factor and response; words: none
    Trend trend = Trend::unknown;
};

struct Influence {
    enum class Method { given_data, saltelli, morris };
    Method method = Method::given_data;
    std::vector<FactorInfluence> factors;  ///< in the campaign's order; saltelli, morris: one a group
    std::int64_t used = 0;                 ///< cases (saltelli: base rows; morris: effects of the factor with fewest)
    std::int64_t excluded = 0;             ///< of the same, for want of a value
    stats::VarianceSplit split;            ///< of the variance of single runs; morris: pure error only
    std::vector<std::string> notes;        ///< what a reader must know before quoting the figures
};

/// What the indices leave unexplained, and what it is made of, in a sentence or two; empty where it cannot be said.
[[nodiscard]] std::string unexplained_text(const Influence& influence);

[[nodiscard]] Influence influence_of(const Responses& responses, const ResponseColumn& response);

}  // namespace grainsweep::study
