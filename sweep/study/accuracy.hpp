// Cost of each setting of the numerics, and its bias relative to the most accurate setting.
//
// Every setting runs the same points with the same random numbers (common_random_numbers), so differences of an
// observable come from the numerics:
//
//   bias = mean over points of (y_setting - y_against),   +- t_{0.975, n-1} sd/sqrt(n)
//
// n: number of points with an answer at both settings. Cost: mean processor time of a case with an answer.
#pragma once

#include "sweep/store/store.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace grainsweep::study {

/// Campaign of the database with one setting of the numerics.
struct NumericsCampaign {
    std::string campaign;
    std::string says;    ///< "fast", "reference with precision = mixed"
    bool moved = false;  ///< a setting with one other input
};

struct Bias {
    std::string observable, unit;
    std::size_t pairs = 0;
    double mean = 0;        ///< mean of the most accurate setting, of the pairs
    double bias = 0;        ///< NaN without a pair
    double half_width = 0;  ///< 95 % half-width; NaN with fewer than two pairs
    double scatter = 0;     ///< standard deviation of the differences
    double spread = 0;      ///< standard deviation of the setting's own answers; both NaN with fewer than two pairs

    /// Returns (|bias| + half_width)/|mean|, the bound of the relative bias.
    [[nodiscard]] double relative_bound() const;
};

struct NumericsCost {
    NumericsCampaign numerics;
    std::size_t cases = 0, answered = 0;
    double seconds = 0;  ///< processor time of a case with an answer
    std::vector<Bias> biases;
};

/// Returns cost and bias of each campaign relative to the last one, for the scalars with a value there.
[[nodiscard]] std::vector<NumericsCost> accuracy_of(const store::Store& store,
                                                    std::span<const NumericsCampaign> campaigns);

/// Returns the cheapest setting whose 95 % bound of the relative bias of every named observable is within the
/// tolerance; empty if only the most accurate setting is.
[[nodiscard]] std::optional<std::size_t> cheapest_within(std::span<const NumericsCost> costs,
                                                         std::span<const std::string> observables, double tolerance);

}  // namespace grainsweep::study
