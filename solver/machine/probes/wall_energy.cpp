// Energy of walls that the powder moves, and what changed it: pressed and driven walls, free bodies.
//
//     kinetic = start + contacts + own + bounds + turning + residual
//
// The engine books the work of every force where it changes a speed (geometry::BodyEnergy), so that the residual is
// rounding at any time step. `turning` is the error of the integrator in a free turn. Contacts of a wall took
//
//     loss = impact_energy - wall_work - contacts
//
// out of the motion of powder and wall; contact_energy is the stored part of this loss. wall_work is the work of the
// forces on the powder at the speed that the laws use. `contacts` is their work on the wall at the mean speed of the
// step.
#include "solver/machine/probe.hpp"
#include "solver/machine/selection.hpp"

#include <array>

namespace grainsweep::machine::probes {
namespace {

enum class EnergyPart { kinetic, contacts, own, bounds, turning, residual };
constexpr std::array<std::string_view, 6> energy_parts = {"kinetic", "contacts", "own",
                                                          "bounds",  "turning",  "residual"};

double part_of(EnergyPart part, const geometry::BodyEnergy& energy, const dem::Wall& wall) {
    switch (part) {
        case EnergyPart::kinetic:
            return geometry::kinetic_energy(wall.motions);
        case EnergyPart::contacts:
            return energy.contacts;
        case EnergyPart::own:
            return energy.own;
        case EnergyPart::bounds:
            return energy.bounds;
        case EnergyPart::turning:
            return energy.turning;
        case EnergyPart::residual:
            break;
    }
    return geometry::kinetic_energy(wall.motions) - energy.sum();
}

class WallEnergy final : public machine::Probe {
public:
    explicit WallEnergy(const Options& options)
        : walls_(options),
          part_(static_cast<EnergyPart>(std::ranges::find(energy_parts, options.word("part", "kinetic")) -
                                        energy_parts.begin())) {}
    double look(const Frame& frame) override {
        return walls_.sum(
            [&](std::size_t w) { return part_of(part_, frame.engine.wall_energy(w), frame.engine.wall(w)); });
    }

private:
    SelectedWalls walls_;
    EnergyPart part_;
};

/// Stored in contacts at this moment.
class ContactEnergy final : public machine::Probe {
public:
    explicit ContactEnergy(const Options& options) : walls_(options) {}
    double look(const Frame& frame) override {
        double total = 0;
        for (const auto& contact : frame.contacts)
            if (walls_.admit(contact)) total += contact.stored;
        return total;
    }

private:
    SelectedWalls walls_;
};

constexpr std::array wall_energy_options = {
    walls_option,
    option("part", Field::Kind::word, "",
           "'kinetic': the energy now; its change since the start is the work of 'contacts', of the wall's 'own' force "
           "and weight, of the 'bounds' of its speed, the error of 'turning', and the 'residual'; default: 'kinetic'",
           false, {}, energy_parts)};
constexpr std::array contact_energy_options = {only_walls_option};

}  // namespace

ProbeInfo contact_energy() {
    return probe_row<ContactEnergy>("contact_energy", "J",
                                    "energy that contacts store in their springs and by cohesion",
                                    contact_energy_options, {.contacts = true});
}
ProbeInfo wall_energy() {
    return probe_row<WallEnergy>("wall_energy", "J",
                                 "kinetic energy of pressed, driven and free walls, or a part of its balance",
                                 wall_energy_options, {.source = Source::sums});
}

}  // namespace grainsweep::machine::probes
