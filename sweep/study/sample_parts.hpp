// Parts of a campaign's cases that are left out in turn, to estimate the errors of its sample.
#pragma once

#include "sweep/study/responses.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace grainsweep::study {

struct SampleParts {
    std::vector<std::size_t> labels;  ///< one per settled row, 0 ... G-1; repeats of a point have the same
    bool independent = false;         ///< the parts are independent replicates of one another
    std::string what;  ///< text such as "the 8 independent sequences"; empty: the points are no sample (a lattice, a
                       ///< list)
};

/// Returns the independent sequences if there are at least four, else eight batches of points or whole blocks
/// (saltelli, morris). A list, which has no order, is divided at random.
[[nodiscard]] SampleParts sample_parts(const Responses& responses);

}  // namespace grainsweep::study
