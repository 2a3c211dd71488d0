// Kinetic energy of translation: sum of m v^2/2.
#include "solver/machine/probe.hpp"
#include "solver/machine/selection.hpp"

namespace grainsweep::machine::probes {
namespace {

class KineticEnergyProbe final : public machine::Probe {
public:
    explicit KineticEnergyProbe(const Options& options) : selection_(options) {}
    double look(const Frame& frame) override {
        double energy = 0;
        selection_.each(frame, [&](std::size_t i) {
            energy += frame.mass(i) / 2 * geometry::dot(frame.state.velocity[i], frame.state.velocity[i]);
        });
        return energy;
    }

private:
    Selection selection_;
};

constexpr std::array kinetic_energy_options = {of_option, in_option};

}  // namespace

ProbeInfo kinetic_energy() {
    return {"kinetic_energy", "J", "kinetic energy of translation", kinetic_energy_options,
            make_probe<KineticEnergyProbe>};
}

}  // namespace grainsweep::machine::probes
