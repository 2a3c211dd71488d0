// Chooses the cases of a database that are worth watching: they span the values of a response.
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

/// At most that number of cases, shared by the campaigns: of the completed cases of each, by its main observable, the
/// smallest, the largest and cases at even quantiles between them; one alone is the median. A campaign without a
/// finite value has none.
[[nodiscard]] std::vector<FilmChoice> cases_to_watch(const store::Store& store, std::size_t count);

}  // namespace grainsweep::report
