// Selected particles as a state with z upwards, for observables that have a floor and a top.
#pragma once

#include "solver/machine/selection.hpp"

#include <cmath>

namespace grainsweep::machine {

inline constexpr Field from_option =
    option("from", Field::Kind::vector, "m", "the point from which it counts; default: the origin");
inline constexpr Field along_option = option("along", Field::Kind::direction, "", "upwards; default: against gravity");

/// Returns the option "along"; by default the direction against gravity, or z without gravity.
[[nodiscard]] inline Vec3 up_of(const Frame& frame, const std::optional<Vec3>& along) {
    if (along) return *along;
    const double g = geometry::norm(frame.gravity);
    return g > 0 ? geometry::operator*(-1 / g, frame.gravity) : Vec3{0, 0, 1};
}

/// View by the options "of", "in", "from" and "along".
class Upright {
public:
    explicit Upright(const Options& options)
        : selection_(options), from_(options.vector("from", {})), along_(options.given<Vec3>("along")) {}

    /// Returns positions relative to "from", and velocities, of the selected particles.
    [[nodiscard]] dem::State state_of(const Frame& frame) const {
        using geometry::cross;
        const Vec3 up = up_of(frame, along_);
        const bool leans = up != Vec3{0, 0, 1};
        const Vec3 other = std::abs(up[0]) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
        const Vec3 sideways = cross(up, other), y = geometry::operator*(1 / geometry::norm(sideways), sideways);
        const Vec3 x = cross(y, up);
        const auto turned = [&](const Vec3& a) {
            return leans ? Vec3{geometry::dot(a, x), geometry::dot(a, y), geometry::dot(a, up)} : a;
        };
        dem::State state;
        selection_.each(frame, [&](std::size_t i) {
            state.id.push_back(frame.state.id[i]);
            state.position.push_back(turned(geometry::operator-(frame.state.position[i], from_)));
            state.velocity.push_back(turned(frame.state.velocity[i]));
            state.radius.push_back(frame.state.radius[i]);
            state.mobile.push_back(frame.state.mobile[i]);
        });
        return state;
    }

private:
    Selection selection_;
    Vec3 from_;
    std::optional<Vec3> along_;
};

}  // namespace grainsweep::machine
