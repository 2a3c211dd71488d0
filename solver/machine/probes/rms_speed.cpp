// Root mean square speed of the particles that can move; 0 where there are none.
#include "solver/machine/probe.hpp"
#include "solver/machine/upright.hpp"
#include "solver/observables/heap.hpp"

namespace grainsweep::machine::probes {
namespace {

class RmsSpeed final : public machine::Probe {
public:
    explicit RmsSpeed(const Options& options) : particles_(options) {}
    double look(const Frame& frame) override { return observables::rms_speed(particles_.state_of(frame)); }

private:
    Upright particles_;
};

constexpr std::array rms_speed_options = {of_option, in_option};

}  // namespace

ProbeInfo rms_speed() {
    return probe_row<RmsSpeed>("rms_speed", "m/s", "root mean square speed; 0 without particles", rms_speed_options);
}

}  // namespace grainsweep::machine::probes
