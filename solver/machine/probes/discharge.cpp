// Discharge from a region, or from the domain: all particles filled in or fed whose centres are not in the region now.
// Gone particles count with the size that they had.
//
//     share = mass outside / mass of all
#include "solver/machine/probe.hpp"
#include "solver/machine/selection.hpp"

#include <numbers>

namespace grainsweep::machine::probes {
namespace {

enum class Discharge { mass, number, diameters, share };

template <Discharge of>
class DischargeProbe final : public machine::Probe {
public:
    explicit DischargeProbe(const Options& options)
        : of_species_(options.numbers("of")), from_(options.region("from")) {}

    double look(const Sight& sight) override {
        double outside = 0, all = 0;
        std::size_t i = 0;  // of the state, in which ids ascend
        for (std::size_t id = 0; id < sight.radius.size(); ++id) {
            const bool present = i < sight.size() && sight.id(i) == id;
            const bool inside = present && (!from_ || from_->contains(sight.state.position[i]));
            if (present) ++i;
            if (!of_species_.empty() && std::ranges::find(of_species_, sight.species[id]) == of_species_.end())
                continue;
            const double amount = amount_of(sight, id);
            all += amount;
            if (!inside) outside += amount;
        }
        if (of != Discharge::share) return outside;
        return all > 0 ? outside / all : undefined;
    }

private:
    static double amount_of(const Sight& sight, std::size_t id) {
        const double r = sight.radius[id];
        if (of == Discharge::number) return 1;
        if (of == Discharge::diameters) return 2 * r;
        return sight.density[id] * 4 / 3 * std::numbers::pi * r * r * r;
    }

    std::vector<std::size_t> of_species_;
    std::optional<Region> from_;
};

constexpr std::array discharge_options = {
    of_option, option("from", Field::Kind::region, "", "the region that they left, by centres; default: the domain")};

template <Discharge of>
std::unique_ptr<machine::Probe> make_discharge(const Options& given) {
    return std::make_unique<DischargeProbe<of>>(given);
}

}  // namespace

ProbeInfo discharged_mass() {
    return {"discharged_mass", "kg", "mass that has left a region or the domain", discharge_options,
            make_discharge<Discharge::mass>};
}
ProbeInfo discharged_number() {
    return {"discharged_number", "1", "particles that have left a region or the domain", discharge_options,
            make_discharge<Discharge::number>};
}
ProbeInfo discharged_diameters() {
    return {"discharged_diameters", "m", "sum of the diameters of the particles that have left a region or the domain",
            discharge_options, make_discharge<Discharge::diameters>};
}
ProbeInfo discharged_share() {
    return {"discharged_share", "1",
            "mass that has left a region or the domain divided by that of all particles so far", discharge_options,
            make_discharge<Discharge::share>};
}

}  // namespace grainsweep::machine::probes
