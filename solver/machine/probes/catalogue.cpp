#include "solver/machine/probes/probes.hpp"

#include <algorithm>
#include <array>

namespace grainsweep::machine {

std::span<const ProbeInfo> probe_catalogue() {
    static const auto all = [] {
        std::array rows = {
            probes::amount_count,
            probes::amount_mass,
            probes::amount_volume,
            probes::bed_angle,
            probes::bed_fraction,
            probes::bed_layer_depth,
            probes::bed_surface_angle,
            probes::bed_surface_residual,
            probes::bed_surface_speed,
            probes::centre,
            probes::contact_energy,
            probes::contact_force,
            probes::contact_force_density,
            probes::coordination,
            probes::cover,
            probes::cover_angle,
            probes::cover_area,
            probes::cover_outline,
            probes::discharged_diameters,
            probes::discharged_mass,
            probes::discharged_number,
            probes::discharged_share,
            probes::fabric,
            probes::flow_mass,
            probes::flow_number,
            probes::granular_temperature,
            probes::heap_angle,
            probes::heap_height,
            probes::heap_outline,
            probes::heap_residual,
            probes::heap_run_out,
            probes::height_of_share,
            probes::impact_energy,
            probes::impact_energy_spectrum,
            probes::impact_number,
            probes::impact_number_spectrum,
            probes::kinetic_energy,
            probes::lacey,
            probes::mass_share,
            probes::mean_diameter,
            probes::mean_height,
            probes::momentum,
            probes::overlap,
            probes::profile,
            probes::radius,
            probes::residence_time,
            probes::residence_time_density,
            probes::residence_time_sd,
            probes::rms_speed,
            probes::rolling_torque,
            probes::solid_fraction,
            probes::spin,
            probes::stress,
            probes::stress_profile,
            probes::velocity,
            probes::wall_angle,
            probes::wall_energy,
            probes::wall_force,
            probes::wall_layer_speed,
            probes::wall_position,
            probes::wall_pressure,
            probes::wall_torque,
            probes::wall_wear,
            probes::wall_wear_profile,
            probes::wall_work,
        };
        std::ranges::sort(rows, {}, &ProbeInfo::name);
        return rows;
    }();
    return all;
}

const ProbeInfo* find_probe(std::string_view name) {
    const auto all = probe_catalogue();
    const auto found = std::ranges::find(all, name, &ProbeInfo::name);
    return found == all.end() ? nullptr : &*found;
}

}  // namespace grainsweep::machine
