#include "tests/support/discrepancy.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace grainsweep::tests {
namespace {

/// whole - (factor/n) sum_i prod_j one(x_ij) + (1/n^2) sum_ik prod_j two(x_ij, x_kj): the shape that all
/// squared L2 discrepancies have. Sums run in extended precision where the machine has it: the terms cancel.
template <typename One, typename Two>
double double_sum(std::span<const double> points, std::size_t d, long double whole, double factor, One one, Two two) {
    const std::size_t n = points.size() / d;
    long double singles = 0;
    long double pairs = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const auto x = points.subspan(i * d, d);
        double product = 1;
        for (std::size_t j = 0; j < d; ++j) product *= one(x[j]);
        singles += product;
        for (std::size_t k = 0; k <= i; ++k) {
            double shared = 1;
            for (std::size_t j = 0; j < d; ++j) shared *= two(x[j], points[k * d + j]);
            pairs += (k == i ? 1 : 2) * static_cast<long double>(shared);
        }
    }
    const auto count = static_cast<long double>(n);
    return static_cast<double>(whole - factor * singles / count + pairs / (count * count));
}

}  // namespace

double squared_l2_star_discrepancy(std::span<const double> points, std::size_t dimensions) {
    // (1/3)^d - 2^(1-d)/n sum prod (1 - x^2) + 1/n^2 sum prod (1 - max(x, x'))
    const long double third = std::pow(1.0L / 3, static_cast<long double>(dimensions));
    return double_sum(
        points, dimensions, third, 2, [](double x) { return 0.5 * (1 - x * x); },
        [](double x, double y) { return 1 - std::max(x, y); });
}

double squared_centred_discrepancy(std::span<const double> points, std::size_t dimensions) {
    const auto one = [](double x) {
        const double z = std::abs(x - 0.5);
        return 1 + 0.5 * z - 0.5 * z * z;
    };
    const auto two = [](double x, double y) {
        return 1 + 0.5 * std::abs(x - 0.5) + 0.5 * std::abs(y - 0.5) - 0.5 * std::abs(x - y);
    };
    const long double whole = std::pow(13.0L / 12, static_cast<long double>(dimensions));
    return double_sum(points, dimensions, whole, 2, one, two);
}

double squared_wraparound_discrepancy(std::span<const double> points, std::size_t dimensions) {
    const auto two = [](double x, double y) {
        const double z = std::abs(x - y);
        return 1.5 - z * (1 - z);
    };
    const long double whole = -std::pow(4.0L / 3, static_cast<long double>(dimensions));
    return static_cast<double>(whole + double_sum(
                                           points, dimensions, 0, 0, [](double) { return 1.0; }, two));
}

double star_discrepancy_of_pair(std::span<const double> points, std::size_t dimensions, std::size_t first,
                                std::size_t second) {
    const std::size_t n = points.size() / dimensions;
    struct Place {
        double a;
        double b;
    };
    std::vector<Place> places(n);
    for (std::size_t i = 0; i < n; ++i) places[i] = {points[i * dimensions + first], points[i * dimensions + second]};
    std::ranges::sort(places, {}, &Place::a);

    // Walking the edge a up through the points, `inside` holds the sorted b of those left of it. For a given a,
    // the open box is worst just before a point enters, the closed one just after.
    const auto count = static_cast<double>(n);
    double worst = 0;
    std::vector<double> inside;
    const auto walk = [&](double a, bool closed) {
        for (std::size_t k = 0; k < inside.size(); ++k) {
            const double b = inside[k];
            if (closed)
                worst = std::max(worst, static_cast<double>(k + 1) / count - a * b);
            else
                worst = std::max(worst, a * b - static_cast<double>(k) / count);
        }
        if (!closed) worst = std::max(worst, a - static_cast<double>(inside.size()) / count);
    };
    for (std::size_t i = 0; i < n;) {
        const double a = places[i].a;
        walk(a, false);
        for (; i < n && places[i].a == a; ++i)
            inside.insert(std::ranges::upper_bound(inside, places[i].b), places[i].b);
        walk(a, true);
    }
    walk(1, false);
    return worst;
}

double worst_pair_star_discrepancy(std::span<const double> points, std::size_t dimensions) {
    double worst = 0;
    for (std::size_t first = 0; first < dimensions; ++first)
        for (std::size_t second = first + 1; second < dimensions; ++second)
            worst = std::max(worst, star_discrepancy_of_pair(points, dimensions, first, second));
    return worst;
}

}  // namespace grainsweep::tests
