// Which factor moves a response, from the values a campaign has: what `sensitivity` and the page show.
//
//   any design    first-order indices by binning: 16 bins of equal count, fewer below 256 cases; a level, and a
//                 coordinate of a lattice, is a bin of its own
//   saltelli      the same, and total indices by Jansen 1999
//   morris        elementary effects per unit of the range: mu*, sigma (indices would mean nothing on so few points)
// Failed cases are left out and counted. Estimators and errors: stats/sensitivity.hpp.
#pragma once

#include "stats/sensitivity.hpp"
#include "sweep/report/responses.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace grainsweep::report {

struct FactorInfluence {
    std::string factor;
    std::size_t bins = 0;                             ///< behind `first`
    stats::SensitivityIndex first;                    ///< share of the variance the factor explains alone
    stats::SensitivityIndex first_saltelli;           ///< saltelli: the same by Saltelli et al. 2010
    stats::SensitivityIndex total;                    ///< saltelli: with all interactions
    std::optional<stats::ElementaryEffects> effects;  ///< morris
};

struct Influence {
    enum class Method { given_data, saltelli, morris };
    Method method = Method::given_data;
    std::vector<FactorInfluence> factors;  ///< in the campaign's order
    std::int64_t used = 0;                 ///< cases (saltelli: base rows; morris: effects of the factor with fewest)
    std::int64_t excluded = 0;             ///< of the same, for want of a value
    std::vector<std::string> notes;        ///< what a reader must know before quoting the figures
};

[[nodiscard]] Influence influence_of(const Responses& responses, const ResponseColumn& response);

}  // namespace grainsweep::report
