// report --watch N: films of the cases that span what a campaign found, computed again in this process.
#pragma once

#include "sweep/report/page.hpp"
#include "sweep/store/store.hpp"

#include <cstdint>
#include <vector>

namespace grainsweep::cli {

/// At most `count` films in all, smaller than those of `replay --watch`: fewer frames and spheres, velocity alone as
/// colour. Says on standard error which case is computed, what it left out and why.
[[nodiscard]] std::vector<report::PageFilm> films_of(const store::Store& store, std::int64_t count);

}  // namespace grainsweep::cli
