// Colours of levels on the report page: readers with any colour vision tell them apart, on both grounds.
#include "tests/support/places.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace grainsweep::tests::report_colours_test {

using Linear = std::array<double, 3>;
using Matrix = std::array<Linear, 3>;

double linear_of(int byte) {
    const double c = byte / 255.0;
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

Linear colour_of(const std::string& hex) {
    Linear colour{};
    for (std::size_t k = 0; k < 3; ++k) colour[k] = linear_of(std::stoi(hex.substr(1 + 2 * k, 2), nullptr, 16));
    return colour;
}

Linear times(const Matrix& m, const Linear& x) {
    Linear result{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) result[i] += m[i][j] * x[j];
    return result;
}

/// Oklab (Ottosson 2020).
Linear lab_of(const Linear& x) {
    constexpr Matrix cones = {{{0.4122214708, 0.5363325363, 0.0514459929},
                               {0.2119034982, 0.6806995451, 0.1073969566},
                               {0.0883024619, 0.2817188376, 0.6299787005}}},
                     axes = {{{0.2104542553, 0.7936177850, -0.0040720468},
                              {1.9779984951, -2.4285922050, 0.4505937099},
                              {0.0259040371, 0.7827717662, -0.8086757660}}};
    Linear lms = times(cones, x);
    for (double& c : lms) c = std::cbrt(std::max(c, 0.0));
    return times(axes, lms);
}

/// Ratio of luminances by WCAG 2.
double contrast(const Linear& a, const Linear& b) {
    const auto light = [](const Linear& x) { return 0.2126 * x[0] + 0.7152 * x[1] + 0.0722 * x[2] + 0.05; };
    return std::max(light(a), light(b)) / std::min(light(a), light(b));
}

/// Values of a property of the style sheet: on paper, and on the dark ground.
std::vector<std::vector<std::string>> values_of(const std::string& property) {
    std::ifstream stream(source("sweep/report/page/page.css"));
    const std::regex form("--" + property + ": ([^;]+);");
    std::vector<std::vector<std::string>> all;
    for (std::string line; std::getline(stream, line);) {
        std::smatch found;
        if (!std::regex_search(line, found, form)) continue;
        std::istringstream words(found.str(1));
        auto& values = all.emplace_back();
        for (std::string word; words >> word;) values.push_back(word);
    }
    return all;
}

TEST(ReportColours, LevelsDifferForEveryColourVision) {
    // Machado, Oliveira & Fernandes (2009), doi 10.1109/TVCG.2009.113, severity 1: none, protan, deutan, tritan.
    constexpr std::array<Matrix, 4> visions = {
        {{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
         {{{0.152286, 1.052583, -0.204868}, {0.114503, 0.786281, 0.099216}, {-0.003882, -0.048116, 1.051998}}},
         {{{0.367322, 0.860646, -0.227968}, {0.280085, 0.672501, 0.047413}, {-0.011820, 0.042940, 0.968881}}},
         {{{1.255528, -0.076749, -0.178779}, {-0.078411, 0.930809, 0.147602}, {0.004733, 0.691367, 0.303900}}}}};
    const auto levels = values_of("levels"), cards = values_of("card");
    ASSERT_EQ(levels.size(), 2u);
    ASSERT_EQ(cards.size(), 2u);
    for (std::size_t theme = 0; theme < 2; ++theme) {
        ASSERT_EQ(levels[theme].size(), 8u);
        for (const auto& level : levels[theme])
            EXPECT_GE(contrast(colour_of(level), colour_of(cards[theme].front())), 3) << level << " on its ground";
        for (std::size_t vision = 0; vision < visions.size(); ++vision)
            for (std::size_t a = 0; a < 8; ++a)
                for (std::size_t b = 0; b < a; ++b) {
                    double square = 0;
                    const auto seen = [&](const std::string& hex) {
                        Linear x = times(visions[vision], colour_of(hex));
                        for (double& c : x) c = std::clamp(c, 0.0, 1.0);
                        return lab_of(x);
                    };
                    const Linear one = seen(levels[theme][a]), other = seen(levels[theme][b]);
                    for (std::size_t k = 0; k < 3; ++k) square += (one[k] - other[k]) * (one[k] - other[k]);
                    // About six differences that are just noticeable.
                    EXPECT_GT(std::sqrt(square), 0.12)
                        << levels[theme][a] << " and " << levels[theme][b] << ", vision " << vision;
                }
    }
}

}  // namespace grainsweep::tests::report_colours_test
