// Granular temperature: a third of the mean square of the velocity about its mean, weighted by mass.
//
//     T = sum m |v - u|^2/(3 sum m),   u = sum m v/sum m
#include "solver/machine/probe.hpp"
#include "solver/machine/selection.hpp"

namespace grainsweep::machine::probes {
namespace {

using geometry::dot;
using geometry::operator-;
using geometry::operator+=;
using geometry::operator*;

double granular_temperature_of(const Frame& frame, const Selection& selection) {
    double mass = 0, squares = 0;
    Vec3 momentum{};
    selection.each(frame, [&](std::size_t i) {
        mass += frame.mass(i);
        momentum += frame.mass(i) * frame.state.velocity[i];
    });
    if (!(mass > 0)) return undefined;
    const Vec3 mean = (1 / mass) * momentum;
    selection.each(frame, [&](std::size_t i) {
        const Vec3 v = frame.state.velocity[i] - mean;
        squares += frame.mass(i) * dot(v, v);
    });
    return squares / (3 * mass);
}

constexpr std::array granular_temperature_options = {of_option, in_option};

}  // namespace

ProbeInfo granular_temperature() {
    return probe_row<SelectionProbe<granular_temperature_of>>("granular_temperature", "m2/s2",
                                                              "a third of the mean square velocity about the mean",
                                                              granular_temperature_options);
}

}  // namespace grainsweep::machine::probes
