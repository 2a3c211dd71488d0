// Response models of several responses of the same points, fitted side by side.
#pragma once

#include "stats/response_model.hpp"

#include <cstddef>
#include <span>
#include <variant>
#include <vector>

namespace grainsweep::stats {

/// How many threads fit_responses() takes at most; at the start 1.
void allow_fits_at_once(std::size_t count);

/// fit_response() of every row of `values`, in their order, several at once. Fits are independent of one another: the
/// same bits as one after another. Throws what fit_response() throws.
[[nodiscard]] std::vector<std::variant<ResponseModel, Refusal>> fit_responses(
    Rows points, std::span<const std::vector<double>> values, const ResponseModelOptions& options = {});

}  // namespace grainsweep::stats
