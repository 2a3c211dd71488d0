// Failed cases near a setting. A setting whose nearest cases failed (stats/nearest_cases.hpp) is not recommended, and
// no model is believed there.
//
// Coordinates: a factor's place in its range, in the logarithm where the range is divided so; of a factor whose levels
// are words one coordinate per word, so that two words are at distance 1.
#pragma once

#include "stats/nearest_cases.hpp"
#include "sweep/study/response_models.hpp"

#include <string>
#include <vector>

namespace grainsweep::study {

using Near = stats::NearestCases::Near;

class CasesNear {
public:
    explicit CasesNear(const ModelCases& cases);

    [[nodiscard]] Near at(const Setting& setting) const { return nearest_.at(coordinates(setting)); }

private:
    [[nodiscard]] std::vector<double> coordinates(const Setting& setting) const;

    std::vector<ModelFactor> factors_;
    stats::NearestCases nearest_;
};

/// "4 of the 5 nearest cases failed (3 crashed, 1 unstable)"
[[nodiscard]] std::string near_text(const ModelCases& cases, const Near& near);
/// "12 of 40 cases failed (12 crashed)"; empty where none did.
[[nodiscard]] std::string failed_text(const ModelCases& cases);

}  // namespace grainsweep::study
