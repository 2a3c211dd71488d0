// Number, mass, solid volume and mean diameter of the particles whose centres lie in a region.
#include "solver/machine/probe.hpp"
#include "solver/machine/selection.hpp"

namespace grainsweep::machine::probes {
namespace {

enum class Amount { count, mass, volume };

template <Amount of>
class AmountProbe final : public machine::Probe {
public:
    explicit AmountProbe(const Options& options) : selection_(options) {
        if (options.has("slower_than")) slower_than_ = options.number("slower_than");
    }
    double look(const Frame& frame) override {
        double sum = 0;
        selection_.each(frame, [&](std::size_t i) {
            if (slower_than_ && !(geometry::norm(frame.state.velocity[i]) < *slower_than_)) return;
            sum += of == Amount::count ? 1 : of == Amount::mass ? frame.mass(i) : frame.volume(i);
        });
        return sum;
    }

private:
    Selection selection_;
    std::optional<double> slower_than_;
};

class MeanDiameter final : public machine::Probe {
public:
    explicit MeanDiameter(const Options& options) : selection_(options) {}
    double look(const Frame& frame) override {
        double diameters = 0, number = 0;
        selection_.each(frame, [&](std::size_t i) {
            diameters += 2 * frame.state.radius[i];
            number += 1;
        });
        return number > 0 ? diameters / number : undefined;
    }

private:
    Selection selection_;
};

constexpr std::array mean_diameter_options = {of_option, in_option};
constexpr std::array amount_options = {of_option, in_option,
                                       option("slower_than", Field::Kind::quantity, "m/s",
                                              "only particles slower than this; default: all", false, positive_number)};

template <Amount of>
std::unique_ptr<machine::Probe> make_amount(const Options& given) {
    return std::make_unique<AmountProbe<of>>(given);
}

}  // namespace

ProbeInfo amount_count() {
    return {"count", "1", "number of particles in a region", amount_options, make_amount<Amount::count>};
}
ProbeInfo amount_mass() {
    return {"mass", "kg", "mass of the particles in a region", amount_options, make_amount<Amount::mass>};
}
ProbeInfo amount_volume() {
    return {"volume", "m3", "solid volume of the particles in a region", amount_options, make_amount<Amount::volume>};
}
ProbeInfo mean_diameter() {
    return {"mean_diameter", "m", "mean diameter of the particles in a region, by number", mean_diameter_options,
            make_probe<MeanDiameter>};
}

}  // namespace grainsweep::machine::probes
