// Solid fraction of a bed in a vessel of constant cross-section. It is measured from three diameters above the bottom
// to three below the 95 % quantile of the centres' heights.
#include "solver/machine/probe.hpp"
#include "solver/machine/upright.hpp"
#include "solver/observables/settled.hpp"

namespace grainsweep::machine::probes {
namespace {

class BedFraction final : public machine::Probe {
public:
    explicit BedFraction(const Options& options)
        : upright_(options), diameter_(options.number("diameter")), section_(options.number("section")) {}
    double look(const Frame& frame) override {
        return observables::settled_fraction(upright_.state_of(frame), 0, diameter_, section_);
    }

private:
    Upright upright_;
    double diameter_, section_;
};

constexpr Interval positive_size{0, std::numeric_limits<double>::infinity(), true, true};
constexpr std::array bed_fraction_options = {
    of_option,
    in_option,
    option("from", Field::Kind::vector, "m", "a point of the bottom; default: the origin"),
    along_option,
    option("diameter", Field::Kind::quantity, "m", "diameter of the particles", true, positive_size),
    option("section", Field::Kind::quantity, "m2", "cross-section of the vessel", true, positive_size)};

}  // namespace

ProbeInfo bed_fraction() {
    return probe_row<BedFraction>("bed_fraction", "1",
                                  "solid fraction of a bed, three diameters clear of its bottom and its top",
                                  bed_fraction_options);
}

}  // namespace grainsweep::machine::probes
