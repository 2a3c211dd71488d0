// Kinetic energy of translation: sum of m v^2/2.
#include "solver/machine/probes/probes.hpp"
#include "solver/machine/selection.hpp"

namespace grainsweep::machine::probes {
namespace {

class KineticEnergyProbe final : public machine::Probe {
public:
    explicit KineticEnergyProbe(const Options& options) : selection_(options) {}
    double look(const Sight& sight) override {
        double energy = 0;
        selection_.each(sight, [&](std::size_t i) {
            energy += sight.mass(i) / 2 * geometry::dot(sight.state.velocity[i], sight.state.velocity[i]);
        });
        return energy;
    }

private:
    Selection selection_;
};

constexpr std::array kinetic_energy_options = {of_option, in_option};

}  // namespace

const ProbeInfo kinetic_energy{"kinetic_energy", "J", "kinetic energy of translation", kinetic_energy_options,
                               [](const Options& given) -> std::unique_ptr<machine::Probe> {
                                   return std::make_unique<KineticEnergyProbe>(given);
                               }};

}  // namespace grainsweep::machine::probes
