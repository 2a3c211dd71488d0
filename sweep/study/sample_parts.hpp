// A campaign's cases in parts that are left out in turn: where the errors of its sample come from.
#pragma once

#include "sweep/study/responses.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace grainsweep::study {

struct SampleParts {
    std::vector<std::size_t> labels;  ///< one per settled row, 0 ... G-1; repeats of a point have the same
    bool independent = false;         ///< the parts repeat one another independently
    std::string what;  ///< "the 8 independent sequences"; empty: the points are no sample (a lattice, a list)
};

/// Independent sequences where there are at least four, else eight stretches of whole blocks (saltelli, morris) or
/// points; a list, which has no order, in parts drawn at random.
[[nodiscard]] SampleParts sample_parts(const Responses& responses);

}  // namespace grainsweep::study
