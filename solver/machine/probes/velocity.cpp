// Mean velocity along a direction, weighted by mass, and its sum, the momentum.
//
//     velocity = sum m v . e / sum m          momentum = sum m v . e
#include "solver/machine/probes/probes.hpp"
#include "solver/machine/selection.hpp"

namespace grainsweep::machine::probes {
namespace {

template <bool mean>
class VelocityProbe final : public machine::Probe {
public:
    explicit VelocityProbe(const Options& options) : selection_(options), along_(options.vector("along")) {}
    double look(const Sight& sight) override {
        double momentum = 0, mass = 0;
        selection_.each(sight, [&](std::size_t i) {
            momentum += sight.mass(i) * geometry::dot(sight.state.velocity[i], along_);
            mass += sight.mass(i);
        });
        if (!mean) return momentum;
        return mass > 0 ? momentum / mass : undefined;
    }

private:
    Selection selection_;
    Vec3 along_;
};

constexpr std::array velocity_options = {
    of_option, in_option, OptionSpec{"along", OptionSpec::Kind::direction, "", "the direction of the component", true}};

template <bool mean>
std::unique_ptr<machine::Probe> make_velocity(const Options& given) {
    return std::make_unique<VelocityProbe<mean>>(given);
}

}  // namespace

const ProbeInfo velocity{"velocity", "m/s", "mean velocity along a direction, weighted by mass", velocity_options,
                         make_velocity<true>};
const ProbeInfo momentum{"momentum", "kg m/s", "sum of mass times velocity along a direction", velocity_options,
                         make_velocity<false>};

}  // namespace grainsweep::machine::probes
