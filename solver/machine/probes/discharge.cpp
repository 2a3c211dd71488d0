// Discharge from a region, or from the domain: all particles filled in or fed whose centres are not in the region now.
// Gone particles count with the size that they had, glued ones never.
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
    explicit DischargeProbe(const Options& options) : of_(options), from_(options.region("from")) {}

    double look(const Frame& frame) override {
        double outside = 0, all = 0;
        const auto from = now(from_);
        std::size_t i = 0;  // of the state, in which ids ascend
        for (std::size_t id = 0; id < frame.radius.size(); ++id) {
            const bool present = i < frame.size() && frame.id(i) == id;
            const bool glued = present && frame.state.mobile[i] == 0;
            const bool inside = present && (!from || from->contains(frame.state.position[i]));
            if (present) ++i;
            if (glued || !frame.is_particle(id) || !of_.hold(frame, id)) continue;
            const double amount = amount_of(frame, id);
            all += amount;
            if (!inside) outside += amount;
        }
        if (of != Discharge::share) return outside;
        return all > 0 ? outside / all : undefined;
    }

private:
    static double amount_of(const Frame& frame, std::size_t id) {
        const double r = frame.radius[id];
        if (of == Discharge::number) return 1;
        if (of == Discharge::diameters) return 2 * r;
        return frame.density[id] * 4 / 3 * std::numbers::pi * r * r * r;
    }

    SelectedSpecies of_;
    std::optional<Region> from_;
};

constexpr std::array discharge_options = {
    species_option,
    option("from", Field::Kind::region, "", "the region that they left, by centres; default: the domain")};

template <Discharge of>
ProbeInfo discharged(std::string_view name, std::string_view unit, std::string_view meaning) {
    return probe_row<DischargeProbe<of>>(name, unit, meaning, discharge_options, {.so_far = true});
}

}  // namespace

ProbeInfo discharged_mass() {
    return discharged<Discharge::mass>("discharged_mass", "kg", "mass that has left a region or the domain");
}
ProbeInfo discharged_number() {
    return discharged<Discharge::number>("discharged_number", "1", "particles that have left a region or the domain");
}
ProbeInfo discharged_diameters() {
    return discharged<Discharge::diameters>(
        "discharged_diameters", "m", "sum of the diameters of the particles that have left a region or the domain");
}
ProbeInfo discharged_share() {
    return discharged<Discharge::share>(
        "discharged_share", "1", "mass that has left a region or the domain divided by that of all particles so far");
}

}  // namespace grainsweep::machine::probes
