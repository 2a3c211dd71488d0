// Parallel fits of several responses of the same points.
#pragma once

#include "stats/response_model.hpp"

#include <cstddef>
#include <span>
#include <variant>
#include <vector>

namespace grainsweep::stats {

/// Sets the largest number of threads of fit_responses(); initially 1.
void allow_fits_at_once(std::size_t count);

/// Returns fit_response() of every row of `values`, in their order, several at the same time. The fits are independent,
/// so their bits do not depend on the number of threads. Throws like fit_response().
[[nodiscard]] std::vector<std::variant<ResponseModel, Refusal>> fit_responses(
    Rows points, std::span<const std::vector<double>> values, const ResponseModelOptions& options = {});

}  // namespace grainsweep::stats
