// report --watch N: films of cases that span the results of a campaign, computed again in this process.
#pragma once

#include "sweep/report/page.hpp"
#include "sweep/store/store.hpp"

#include <cstdint>
#include <vector>

namespace grainsweep::cli {

/// Returns at most `count` films, smaller than the films of `replay --watch`: fewer frames and spheres, only velocity
/// as colour. Prints on standard error which case is computed, and which cases are left out and why.
[[nodiscard]] std::vector<report::PageFilm> films_of(const store::Store& store, std::int64_t count);

}  // namespace grainsweep::cli
