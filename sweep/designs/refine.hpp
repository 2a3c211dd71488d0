// Where an answer passes a threshold along one factor, for every combination of the levels of the others: bisection
// with repeats.
//
// Both ends of the factor's range are asked first. While they lie on different sides of the threshold the middle of the
// bracket is run, in the factor's own scale, until the bracket is no wider than `width`. A level is run twice, then in
// pairs up to `replicates` times, until Student's 95 % interval of its mean excludes the threshold; then its mean
// decides on which side it lies. Repeated looks raise the error rate of the interval above 5 %, and an undecided level
// counts by its mean. So a bracket where the answer scatters across the threshold is a bracket of the mean, with that
// risk. If the answer crosses the threshold more than once, only one crossing is found.
//
// A round, one question or pair of each combination that is not done, depends on the answers to the rounds before and
// on nothing else: not on the number of workers, nor on interruptions.
#pragma once

#include "sweep/designs/design.hpp"

#include <cstddef>
#include <vector>

namespace grainsweep::designs {

/// One value of the factor, and what is known there.
struct RefinedLevel {
    double coordinate = 0;        ///< in [0, 1]
    double value = 0;             ///< of the factor
    std::vector<double> answers;  ///< of the repeats that brought one
    std::size_t asked = 0;        ///< repeats, with or without an answer
    std::size_t unanswered = 0;   ///< repeats that ended without one

    [[nodiscard]] double mean() const;        ///< NaN without answers
    [[nodiscard]] double half_width() const;  ///< Student's, 95 %; NaN below two answers
};

/// What is known of one combination of the other factors' levels.
struct Bracket {
    enum class State {
        open,        ///< answers are missing
        found,       ///< as narrow as asked
        below,       ///< both ends of the range lie below the threshold
        above,       ///< or at it or above
        unanswered,  ///< a level has no answer in any repeat
    };
    State state = State::open;
    std::vector<std::size_t> levels;  ///< of the other factors, in their order, by number
    RefinedLevel low, high;           ///< the innermost known on either side, by the value of the factor
    std::size_t runs = 0;             ///< answered or not
};

[[nodiscard]] const char* to_string(Bracket::State state);

/// The brackets that follow from request.answers, the last factor fastest. Throws std::invalid_argument where the
/// options are impossible together.
[[nodiscard]] std::vector<Bracket> brackets(const DesignRequest& request);

}  // namespace grainsweep::designs
