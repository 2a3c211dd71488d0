// Mean velocity along a direction, weighted by mass, and its sum, the momentum; mean spin about a direction; the
// fastest particle along a direction.
//
//     velocity = sum m v . e / sum m          momentum = sum m v . e          spin = sum m w . e / sum m
#include "solver/machine/probe.hpp"
#include "solver/machine/selection.hpp"

#include <algorithm>

namespace grainsweep::machine::probes {
namespace {

enum class VelocityOf { mean, sum, spin, fastest };

template <VelocityOf what>
class VelocityProbe final : public machine::Probe {
public:
    explicit VelocityProbe(const Options& options) : selection_(options), along_(options.vector("along")) {}
    double look(const Frame& frame) override {
        double momentum = 0, mass = 0, fastest = 0;
        selection_.each(frame, [&](std::size_t i) {
            const auto& of = what == VelocityOf::spin ? frame.state.angular_velocity : frame.state.velocity;
            const double component = geometry::dot(of[i], along_);
            const double own = what == VelocityOf::fastest ? 1 : frame.mass(i);
            momentum += own * component;
            mass += own;
            fastest = std::max(fastest, component);
        });
        if (what == VelocityOf::sum) return momentum;
        const double value = what == VelocityOf::fastest ? fastest : momentum / mass;
        return mass > 0 ? value : undefined;
    }

private:
    Selection selection_;
    Vec3 along_;
};

constexpr std::array velocity_options = {
    of_option, in_option, option("along", Field::Kind::direction, "", "the direction of the component", true)};

}  // namespace

ProbeInfo velocity() {
    return probe_row<VelocityProbe<VelocityOf::mean>>(
        "velocity", "m/s", "mean velocity along a direction, weighted by mass", velocity_options);
}
ProbeInfo momentum() {
    return probe_row<VelocityProbe<VelocityOf::sum>>("momentum", "kg m/s",
                                                     "sum of mass times velocity along a direction", velocity_options);
}
ProbeInfo fastest() {
    return probe_row<VelocityProbe<VelocityOf::fastest>>(
        "fastest", "m/s", "largest velocity along a direction; 0: none moves along it", velocity_options);
}
ProbeInfo spin() {
    return probe_row<VelocityProbe<VelocityOf::spin>>(
        "spin", "rad/s", "mean angular velocity about a direction, right hand, weighted by mass", velocity_options);
}

}  // namespace grainsweep::machine::probes
