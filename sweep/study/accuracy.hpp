// What each setting of the numerics costs and how far its answers lie from those of the most accurate one.
//
// The same points are asked at every setting with the same random numbers (common_random_numbers), so that the
// difference of an observable is that of the numerics:
//
//   bias = mean over points of (y_setting - y_against),   +- t_{0.975, n-1} sd/sqrt(n)
//
// over the n points that have an answer at both. Cost: mean processor time of a case with an answer.
#pragma once

#include "sweep/store/store.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace grainsweep::study {

/// One way to compute the points: a campaign of the database.
struct NumericsCampaign {
    std::string campaign;
    std::string says;  ///< "fast", "reference with precision = mixed"
};

struct Bias {
    std::string observable, unit;
    std::size_t pairs = 0;
    double mean = 0;        ///< of the most accurate setting, over the pairs
    double bias = 0;        ///< NaN without a pair
    double half_width = 0;  ///< of 95 %; NaN with fewer than two pairs
    double scatter = 0;     ///< standard deviation of the differences

    /// |bias| + half_width over |mean|: what the setting may be off by.
    [[nodiscard]] double relative_bound() const;
};

struct NumericsCost {
    NumericsCampaign numerics;
    std::size_t cases = 0, answered = 0;
    double seconds = 0;  ///< processor time of a case with an answer
    std::vector<Bias> biases;
};

/// Of each campaign against the last. Observables: those scalars that have a value there.
[[nodiscard]] std::vector<NumericsCost> accuracy_of(const store::Store& store,
                                                    std::span<const NumericsCampaign> campaigns);

/// The cheapest setting whose bias of every named observable is within the tolerance, relative to its mean, with 95 %;
/// none where that is no other than the most accurate one.
[[nodiscard]] std::optional<std::size_t> cheapest_within(std::span<const NumericsCost> costs,
                                                         std::span<const std::string> observables, double tolerance);

}  // namespace grainsweep::study
