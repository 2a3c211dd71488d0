// Rows of the catalogue, one per probe, each defined in the file of its name.
#pragma once

#include "solver/machine/probe.hpp"

namespace grainsweep::machine::probes {

extern const ProbeInfo amount_count, amount_mass, amount_volume, mean_diameter;
extern const ProbeInfo bed_angle;
extern const ProbeInfo bed_surface_angle, bed_surface_residual, bed_surface_speed, bed_layer_depth;
extern const ProbeInfo centre;
extern const ProbeInfo contact_energy, wall_energy;
extern const ProbeInfo contact_force, contact_force_density, fabric;
extern const ProbeInfo coordination;
extern const ProbeInfo cover, cover_angle, cover_area, cover_outline;
extern const ProbeInfo bed_fraction;
extern const ProbeInfo discharged_mass, discharged_number, discharged_diameters, discharged_share;
extern const ProbeInfo flow_mass, flow_number;
extern const ProbeInfo granular_temperature;
extern const ProbeInfo heap_angle, heap_height, heap_outline, heap_residual, heap_run_out;
extern const ProbeInfo height_of_share, mean_height;
extern const ProbeInfo impact_energy, impact_energy_spectrum, impact_number, impact_number_spectrum;
extern const ProbeInfo kinetic_energy;
extern const ProbeInfo lacey, mass_share;
extern const ProbeInfo overlap;
extern const ProbeInfo profile;
extern const ProbeInfo radius;
extern const ProbeInfo residence_time, residence_time_density, residence_time_sd;
extern const ProbeInfo rms_speed;
extern const ProbeInfo solid_fraction;
extern const ProbeInfo stress, stress_profile;
extern const ProbeInfo velocity, momentum, spin;
extern const ProbeInfo wall_angle, wall_position;
extern const ProbeInfo wall_layer_speed;
extern const ProbeInfo wall_wear, wall_wear_profile;
extern const ProbeInfo rolling_torque;
extern const ProbeInfo wall_force, wall_torque, wall_work, wall_pressure;

}  // namespace grainsweep::machine::probes
