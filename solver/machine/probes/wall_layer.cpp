// Speed of the particles that a turning drum carries along.
#include "solver/machine/probe.hpp"
#include "solver/machine/probes/section.hpp"

#include <array>

namespace grainsweep::machine::probes {
namespace {

class WallLayer final : public machine::Probe {
public:
    explicit WallLayer(const Options& options)
        : look_(options), radius_(options.number("radius")), diameter_(options.number("diameter")) {}
    double look(const Frame& frame) override {
        const auto section = look_(frame);
        if (!section) return undefined;
        return observables::wall_layer_speed(*section, radius_, diameter_).value_or(undefined);
    }

private:
    SectionLook look_;
    double radius_, diameter_;
};

constexpr std::array wall_layer_options = {
    of_option, in_option, section_axis_option, section_through_option, section_radius_option, section_diameter_option};

}  // namespace

ProbeInfo wall_layer_speed() {
    return probe_row<WallLayer>(
        "wall_layer_speed", "m/s",
        "mean speed about the axis of a drum, of the particles nearer than 0.1 D to the lower half of its wall",
        wall_layer_options);
}

}  // namespace grainsweep::machine::probes
