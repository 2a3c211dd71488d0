// Number type R of the closest points of curved shapes, so that one template serves a number and vectors of numbers. R
// has + - * /, and the functions fma, sqrt, min, max, where_less and like. This header defines them for double.
#pragma once

#include <cmath>

namespace grainsweep::geometry::number {

/// Returns `value` in the type of the first argument.
[[gnu::always_inline]] inline double like(double, double value) {
    return value;
}
[[gnu::always_inline]] inline double fma(double a, double b, double c) {
    return a * b + c;
}
[[gnu::always_inline]] inline double sqrt(double a) {
    return std::sqrt(a);
}
[[gnu::always_inline]] inline double min(double a, double b) {
    return b < a ? b : a;
}
[[gnu::always_inline]] inline double max(double a, double b) {
    return a < b ? b : a;
}
/// a < b ? c : d
[[gnu::always_inline]] inline double where_less(double a, double b, double c, double d) {
    return a < b ? c : d;
}

}  // namespace grainsweep::geometry::number

namespace grainsweep::geometry {

/// Distance and normal of a closest point, for a number or vectors of them.
template <class R>
struct Near {
    R distance, x, y, z;
};

}  // namespace grainsweep::geometry
