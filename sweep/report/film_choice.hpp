// Choice of cases of a database for films: they span the values of a response.
#pragma once

#include "sweep/store/store.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace grainsweep::report {

struct FilmChoice {
    std::string campaign, case_id;
    std::string says;  ///< "largest mfr, 0.41"
};

/// Returns at most `count` cases, shared between the campaigns. Each campaign has the completed cases with the smallest
/// and the largest main observable, and cases at even quantiles between them; a single one is the median. A campaign
/// without a finite value has none.
[[nodiscard]] std::vector<FilmChoice> cases_to_watch(const store::Store& store, std::size_t count);

}  // namespace grainsweep::report
