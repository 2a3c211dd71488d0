#include "sweep/study/factor_axis.hpp"

#include "sweep/study/box_search.hpp"

#include <algorithm>

namespace grainsweep::study {
namespace {

std::size_t levels_of(const ModelFactor& factor) {
    return factor.is_word() ? factor.choices() : factor.numbers.size();
}

std::size_t places_of(const ModelFactor& factor, std::size_t count) {
    const auto levels = levels_of(factor);
    if (levels > 0) return levels;
    if (const auto multiples = along_axis(factor).multiples()) count = std::min(count, *multiples);
    return factor.high() > factor.low() ? count : 1;
}

}  // namespace

std::vector<double> points_along(const ModelFactor& factor, std::size_t count) {
    const auto places = places_of(factor, count);
    if (levels_of(factor) > 0 || places == 1) return cells_along(factor, count);
    std::vector<double> numbers;
    for (std::size_t k = 0; k < places; ++k)
        numbers.push_back(number_along(factor, static_cast<double>(k) / static_cast<double>(places - 1)));
    return numbers;
}

std::vector<double> cells_along(const ModelFactor& factor, std::size_t count) {
    const auto places = places_of(factor, count);
    std::vector<double> numbers;
    for (std::size_t k = 0; k < places; ++k)
        numbers.push_back(number_along(factor, (static_cast<double>(k) + 0.5) / static_cast<double>(places)));
    return numbers;
}

std::vector<double> cell_edges(const ModelFactor& factor, std::size_t count) {
    std::vector<double> edges;
    if (levels_of(factor) > 0) return edges;
    const auto places = places_of(factor, count);
    for (std::size_t k = 0; k <= places; ++k)
        edges.push_back(number_along(factor, static_cast<double>(k) / static_cast<double>(places)));
    return edges;
}

std::vector<Setting> settings_of_map(std::span<const ModelFactor> factors, const Setting& centre, std::size_t a,
                                     std::size_t b, std::size_t count) {
    const auto across = cells_along(factors[a], count), up = cells_along(factors[b], count);
    std::vector<Setting> settings;
    for (const double y : up)
        for (const double x : across) {
            settings.push_back(centre);
            place(factors, settings.back(), a, x);
            place(factors, settings.back(), b, y, std::span(&a, 1));
        }
    return settings;
}

}  // namespace grainsweep::study
