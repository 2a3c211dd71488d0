// One place along a series or profile, as a word: "surface@0.0042", time or bin in SI units.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace grainsweep::designs {

struct CurvePlace {
    std::string observable;
    std::optional<double> at;  ///< none: the word is the observable's name alone
};

/// Throws std::invalid_argument where no number stands behind the @.
[[nodiscard]] CurvePlace place_on_curve(std::string_view word);
/// The shortest text that comes back as the same place.
[[nodiscard]] std::string word_of(const CurvePlace& place);

}  // namespace grainsweep::designs
