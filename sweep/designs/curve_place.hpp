// Place along a series or profile as a word: "surface@0.0042", time or bin in SI units.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace grainsweep::designs {

struct CurvePlace {
    std::string observable;
    std::optional<double> at;  ///< empty: the word is only the observable's name
};

/// Returns the place in a word. Throws std::invalid_argument if there is no number behind the @.
[[nodiscard]] CurvePlace place_on_curve(std::string_view word);
/// Returns the shortest text that reads back as the same place.
[[nodiscard]] std::string word_of(const CurvePlace& place);

}  // namespace grainsweep::designs
