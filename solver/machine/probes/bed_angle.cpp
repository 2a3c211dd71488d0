// Lean of a bed: the angle by which its centre of volume is turned about an axis from straight below, right hand. For a
// bed that is a segment of a circle it is the slope of the surface.
#include "solver/machine/probe.hpp"
#include "solver/machine/selection.hpp"

#include <cmath>
#include <numbers>

namespace grainsweep::machine::probes {
namespace {

using geometry::cross;
using geometry::dot;
using geometry::norm;
using geometry::operator-;
using geometry::operator+=;
using geometry::operator*;

class BedAngleProbe final : public machine::Probe {
public:
    explicit BedAngleProbe(const Options& options)
        : selection_(options), axis_(options.vector("axis")), through_(options.vector("through", {})) {}
    double look(const Frame& frame) override {
        Vec3 moment{};
        double volume = 0;
        selection_.each(frame, [&](std::size_t i) {
            moment += frame.volume(i) * (frame.state.position[i] - through_);
            volume += frame.volume(i);
        });
        const Vec3 down = frame.gravity - dot(frame.gravity, axis_) * axis_;
        if (!(volume > 0 && norm(down) > 0)) return undefined;
        const Vec3 below = (1 / norm(down)) * down;
        return std::atan2(dot(moment, cross(axis_, below)), dot(moment, below)) * 180 / std::numbers::pi;
    }

private:
    Selection selection_;
    Vec3 axis_, through_;
};

constexpr std::array bed_angle_options = {
    of_option, in_option, option("axis", Field::Kind::direction, "", "the axis that the bed is raised about", true),
    option("through", Field::Kind::vector, "m", "a point on the axis; default: the origin")};

}  // namespace

ProbeInfo bed_angle() {
    return probe_row<BedAngleProbe>(
        "bed_angle", "deg", "angle of the centre of volume from straight below, about an axis", bed_angle_options);
}

}  // namespace grainsweep::machine::probes
