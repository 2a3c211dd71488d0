// Catalogue of probes. Each row is a function in the file of the probe.
#include "solver/machine/probe.hpp"

#include <algorithm>
#include <vector>

namespace grainsweep::machine {
namespace probes {

ProbeInfo amount_count(), amount_mass(), amount_volume(), bed_angle(), bed_fraction(), bed_layer_depth(),
    bed_surface_angle(), bed_surface_residual(), bed_surface_speed(), centre(), contact_energy(), contact_force(),
    contact_force_density(), contact_histogram(), contact_number(), coordination(), cover(), cover_angle(),
    cover_area(), cover_outline(), discharged_diameters(), discharged_mass(), discharged_number(), discharged_share(),
    fabric(), fastest(), flow_mass(), flow_number(), granular_temperature(), heap_angle(), heap_height(),
    heap_outline(), heap_residual(), heap_run_out(), height_of_share(), impact_energy(), impact_energy_spectrum(),
    impact_number(), impact_number_spectrum(), kinetic_energy(), lacey(), largest_contact_force(), layer_bare_share(),
    layer_fraction(), layer_roughness(), layer_unevenness(), mass_share(), mean_diameter(), mean_height(), momentum(),
    nematic_order(), orientation(), overlap(), particle_force(), particle_torque(), point_fraction(), profile(),
    radius(), residence_time(), residence_time_density(), residence_time_sd(), rms_speed(), rolling_torque(),
    rotational_energy(), size_share(), solid_fraction(), spin(), stress(), stress_profile(), velocity(),
    velocity_above(), velocity_bend(), wall_angle(), wall_energy(), wall_force(), wall_layer_speed(), wall_position(),
    wall_pressure(), wall_torque(), wall_wear(), wall_wear_profile(), wall_work();

}  // namespace probes

std::span<const ProbeInfo> probe_catalogue() {
    using namespace probes;
    static const auto all = [] {
        std::vector<ProbeInfo> rows;
        for (const auto& row : {amount_count,
                                amount_mass,
                                amount_volume,
                                bed_angle,
                                bed_fraction,
                                bed_layer_depth,
                                bed_surface_angle,
                                bed_surface_residual,
                                bed_surface_speed,
                                centre,
                                contact_energy,
                                contact_force,
                                contact_force_density,
                                contact_histogram,
                                contact_number,
                                coordination,
                                cover,
                                cover_angle,
                                cover_area,
                                cover_outline,
                                discharged_diameters,
                                discharged_mass,
                                discharged_number,
                                discharged_share,
                                fabric,
                                fastest,
                                flow_mass,
                                flow_number,
                                granular_temperature,
                                heap_angle,
                                heap_height,
                                heap_outline,
                                heap_residual,
                                heap_run_out,
                                height_of_share,
                                impact_energy,
                                impact_energy_spectrum,
                                impact_number,
                                impact_number_spectrum,
                                kinetic_energy,
                                lacey,
                                largest_contact_force,
                                layer_bare_share,
                                layer_fraction,
                                layer_roughness,
                                layer_unevenness,
                                mass_share,
                                mean_diameter,
                                mean_height,
                                momentum,
                                nematic_order,
                                orientation,
                                overlap,
                                particle_force,
                                particle_torque,
                                point_fraction,
                                profile,
                                radius,
                                residence_time,
                                residence_time_density,
                                residence_time_sd,
                                rms_speed,
                                rolling_torque,
                                rotational_energy,
                                size_share,
                                solid_fraction,
                                spin,
                                stress,
                                stress_profile,
                                velocity,
                                velocity_above,
                                velocity_bend,
                                wall_angle,
                                wall_energy,
                                wall_force,
                                wall_layer_speed,
                                wall_position,
                                wall_pressure,
                                wall_torque,
                                wall_wear,
                                wall_wear_profile,
                                wall_work})
            rows.push_back(row());
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
