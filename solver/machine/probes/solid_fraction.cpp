// Solid fraction of a region: solid volume of the spheres with centres in it, divided by the volume of the region.
#include "solver/machine/probe.hpp"
#include "solver/machine/selection.hpp"

namespace grainsweep::machine::probes {
namespace {

class SolidFractionProbe final : public machine::Probe {
public:
    explicit SolidFractionProbe(const Options& options)
        : selection_(options), volume_(options.region("in")->volume().value()) {}
    double look(const Frame& frame) override {
        double solid = 0;
        selection_.each(frame, [&](std::size_t i) { solid += frame.volume(i); });
        return solid / volume_;
    }

private:
    Selection selection_;
    double volume_;
};

constexpr std::array solid_fraction_options = {
    of_option, option("in", Field::Kind::region, "", "the region: a box, cylinder or ball", true)};

std::string flaw_of_solid_fraction(const Options& given) {
    return given.region("in")->volume() ? "" : "a solid fraction needs a region with a volume: a box, cylinder or ball";
}

}  // namespace

ProbeInfo solid_fraction() {
    return probe_row<SolidFractionProbe>("solid_fraction", "1",
                                         "solid volume divided by the volume of a region, by centres",
                                         solid_fraction_options, {.flaw = flaw_of_solid_fraction});
}

}  // namespace grainsweep::machine::probes
