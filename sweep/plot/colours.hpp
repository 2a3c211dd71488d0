// Colours of figures for print.
//
// Categories: Okabe & Ito, "Color Universal Design" (2008), which readers with any colour vision can distinguish.
// Colour scale: viridis (van der Walt & Smith 2015), whose lightness increases uniformly, also in a grey print.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace grainsweep::plot {

struct Colour {
    double red = 0, green = 0, blue = 0, alpha = 1;
};
inline constexpr Colour black{0, 0, 0}, blue{0, 0.447, 0.698}, vermilion{0.835, 0.369, 0}, grey{0.6, 0.6, 0.6};

[[nodiscard]] inline Colour faded(Colour tone, double alpha) {
    tone.alpha = alpha;
    return tone;
}

/// Returns the colour of a category: eight different colours, then the same again.
[[nodiscard]] inline Colour category(std::size_t k) {
    static constexpr std::array<Colour, 8> tones = {{{0, 0.447, 0.698},
                                                     {0.835, 0.369, 0},
                                                     {0, 0.62, 0.451},
                                                     {0.8, 0.475, 0.655},
                                                     {0.902, 0.624, 0},
                                                     {0.337, 0.706, 0.914},
                                                     {0, 0, 0},
                                                     {0.6, 0.6, 0.6}}};
    return tones[k % tones.size()];
}

/// Returns a colour of viridis: 0 dark blue, 1 yellow.
[[nodiscard]] inline Colour along_scale(double share) {
    static constexpr std::array<Colour, 9> stops = {{{0.267, 0.005, 0.329},
                                                     {0.282, 0.156, 0.471},
                                                     {0.243, 0.290, 0.538},
                                                     {0.192, 0.408, 0.557},
                                                     {0.149, 0.510, 0.557},
                                                     {0.122, 0.620, 0.537},
                                                     {0.208, 0.718, 0.475},
                                                     {0.431, 0.808, 0.345},
                                                     {0.993, 0.906, 0.144}}};
    const double at = std::clamp(share, 0.0, 1.0) * static_cast<double>(stops.size() - 1);
    const auto k = std::min(static_cast<std::size_t>(at), stops.size() - 2);
    const double rest = at - static_cast<double>(k);
    const auto mixed = [&](double Colour::*part) {
        return stops[k].*part + rest * (stops[k + 1].*part - stops[k].*part);
    };
    return {mixed(&Colour::red), mixed(&Colour::green), mixed(&Colour::blue)};
}

}  // namespace grainsweep::plot
