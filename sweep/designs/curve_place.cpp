#include "sweep/designs/curve_place.hpp"

#include <array>
#include <charconv>
#include <stdexcept>

namespace grainsweep::designs {

CurvePlace place_on_curve(std::string_view word) {
    const auto mark = word.find('@');
    if (mark == std::string_view::npos) {
        const bool missing = word.ends_with('!');
        return {std::string(word.substr(0, word.size() - (missing ? 1 : 0))), std::nullopt, missing};
    }
    CurvePlace place{std::string(word.substr(0, mark)), 0.0, false};
    const char* const last = word.data() + word.size();
    const auto [end, error] = std::from_chars(word.data() + mark + 1, last, *place.at);
    if (error != std::errc{} || end != last)
        throw std::invalid_argument("no place along a curve: '" + std::string(word) + "'");
    return place;
}

std::string word_of(const CurvePlace& place) {
    if (!place.at) return place.observable + (place.missing ? "!" : "");
    std::array<char, 32> text{};
    return place.observable + '@' +
           std::string(text.data(), std::to_chars(text.data(), text.data() + text.size(), *place.at).ptr);
}

}  // namespace grainsweep::designs
