// What an answer is about, as a word: "angle"; "surface@0.0042", a place along a series or profile (time or bin in SI
// units); "flow_time!", whether a completed case has no value.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace grainsweep::designs {

struct CurvePlace {
    std::string observable;
    std::optional<double> at;  ///< place along a curve; empty: the observable is a scalar
    bool missing = false;      ///< the answer is 1 where a completed case has no value, and 0 where it has one
};

/// Returns the place in a word. Throws std::invalid_argument if there is no number behind the @.
[[nodiscard]] CurvePlace place_on_curve(std::string_view word);
/// Returns the shortest text that reads back as the same place.
[[nodiscard]] std::string word_of(const CurvePlace& place);

}  // namespace grainsweep::designs
