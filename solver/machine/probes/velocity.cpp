// Mean velocity along a direction, weighted by mass, and its sum, the momentum; mean spin about a direction.
//
//     velocity = sum m v . e / sum m          momentum = sum m v . e          spin = sum m w . e / sum m
#include "solver/machine/probe.hpp"
#include "solver/machine/selection.hpp"

namespace grainsweep::machine::probes {
namespace {

enum class VelocityOf { mean, sum, spin };

template <VelocityOf what>
class VelocityProbe final : public machine::Probe {
public:
    explicit VelocityProbe(const Options& options) : selection_(options), along_(options.vector("along")) {}
    double look(const Frame& frame) override {
        double momentum = 0, mass = 0;
        selection_.each(frame, [&](std::size_t i) {
            const auto& of = what == VelocityOf::spin ? frame.state.angular_velocity : frame.state.velocity;
            momentum += frame.mass(i) * geometry::dot(of[i], along_);
            mass += frame.mass(i);
        });
        if (what == VelocityOf::sum) return momentum;
        return mass > 0 ? momentum / mass : undefined;
    }

private:
    Selection selection_;
    Vec3 along_;
};

constexpr std::array velocity_options = {
    of_option, in_option, option("along", Field::Kind::direction, "", "the direction of the component", true)};

template <VelocityOf what>
std::unique_ptr<machine::Probe> make_velocity(const Options& given) {
    return std::make_unique<VelocityProbe<what>>(given);
}

}  // namespace

ProbeInfo velocity() {
    return {"velocity", "m/s", "mean velocity along a direction, weighted by mass", velocity_options,
            make_velocity<VelocityOf::mean>};
}
ProbeInfo momentum() {
    return {"momentum", "kg m/s", "sum of mass times velocity along a direction", velocity_options,
            make_velocity<VelocityOf::sum>};
}
ProbeInfo spin() {
    return {"spin", "rad/s", "mean angular velocity about a direction, right hand, weighted by mass", velocity_options,
            make_velocity<VelocityOf::spin>};
}

}  // namespace grainsweep::machine::probes
