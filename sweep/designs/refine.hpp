// Threshold crossing of an answer along one factor, for every combination of the levels of the others, by bisection
// with replicates.
//
// Both ends of the factor's range are run first. If they lie on different sides of the threshold, the middle of the
// bracket, in the factor's scale, is run until the bracket is at most `width` wide. A value is run twice, then in pairs
// up to `replicates` times, until Student's 95 % interval of its mean excludes the threshold. The mean then decides on
// which side it lies. Repeated looks raise the error rate of the interval above 5 %, and an undecided value counts by
// its mean. If the answer scatters across the threshold, the bracket is therefore a bracket of the mean, with this
// risk. If the answer crosses the threshold more than once, only one crossing is found.
//
// A round has one run or pair for each unfinished combination. It depends only on the answers of earlier rounds, not on
// the number of workers or on interruptions.
#pragma once

#include "sweep/designs/design.hpp"

#include <cstddef>
#include <vector>

namespace grainsweep::designs {

/// Value of the factor with its answers.
struct RefinedLevel {
    double coordinate = 0;        ///< in [0, 1]
    double value = 0;             ///< of the factor
    std::vector<double> answers;  ///< answers of the replicates
    std::size_t asked = 0;        ///< replicates, with or without an answer
    std::size_t unanswered = 0;   ///< replicates without an answer

    [[nodiscard]] double mean() const;        ///< NaN without answers
    [[nodiscard]] double half_width() const;  ///< Student's, 95 %; NaN below two answers
};

/// Bracket of one combination of the other factors' levels.
struct Bracket {
    enum class State {
        open,        ///< answers are missing
        found,       ///< as narrow as requested
        below,       ///< both ends of the range are below the threshold
        above,       ///< both ends are at the threshold or above
        unanswered,  ///< a value has no answer in any replicate
    };
    State state = State::open;
    std::vector<std::size_t> levels;  ///< levels of the other factors, in their order, by number
    RefinedLevel low, high;           ///< innermost values on both sides
    std::size_t runs = 0;             ///< runs, with or without an answer
};

[[nodiscard]] const char* to_string(Bracket::State state);

/// Returns the brackets that follow from request.answers; the last factor varies fastest. Throws std::invalid_argument
/// if the combination of options is impossible.
[[nodiscard]] std::vector<Bracket> brackets(const DesignRequest& request);

}  // namespace grainsweep::designs
