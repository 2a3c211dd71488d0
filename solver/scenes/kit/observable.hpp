// Observable of a scene, defined once: it declares the observable and records its values.
//
//     inline constexpr Scalar mfr{"mfr", "1", "mass flow rate under the blade ..."};
//     info.observables = observed(mfr, flux_series);      mfr.record(into, flux); flux_series.in(into).push_back(...)
#pragma once

#include "solver/scenes/values.hpp"

#include <cmath>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::kit {

struct Scalar {
    std::string_view name, unit, meaning;
    std::string_view absent = {};  ///< why a completed case can be without a value

    void record(Observations& into, double value) const { into.scalars.insert_or_assign(std::string(name), value); }
    /// Records the value if it is finite; otherwise it stays undefined.
    void record_known(Observations& into, double value) const {
        if (std::isfinite(value)) record(into, value);
    }
    [[nodiscard]] ObservableSpec spec() const {
        return {std::string(name), std::string(unit), std::string(meaning), Shape::scalar, {}, std::string(absent)};
    }
};

/// Observable with several values along time (series) or bins (profile).
template <Shape shape>
struct Curve {
    std::string_view name, unit, meaning, over;

    /// Returns its samples for appending. From then on the observable exists, even if it is empty.
    [[nodiscard]] std::vector<Sample>& in(Observations& into) const { return into.series[std::string(name)]; }
    [[nodiscard]] ObservableSpec spec() const {
        return {std::string(name), std::string(unit), std::string(meaning), shape, std::string(over)};
    }
};
using Series = Curve<Shape::series>;
using Profile = Curve<Shape::profile>;

template <class... Observable>
[[nodiscard]] std::vector<ObservableSpec> observed(const Observable&... observables) {
    return {observables.spec()...};
}

}  // namespace grainsweep::kit
