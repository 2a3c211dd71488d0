// Observables of a TPMS discharge.
#pragma once

#include "solver/scenes/kit/powder.hpp"

namespace grainsweep::tpms_record {

inline constexpr std::string_view time = "time (sqrt(2 L/g))";

inline constexpr kit::Scalar retention{"retention", "1",
                                       "mobile centres in the cell at the end over those at the start"};
inline constexpr kit::Scalar time_to_half{"time_to_half", "sqrt(2 L/g)",
                                          "when half has left; undefined if it never does",
                                          "less than half has left until the end"};
inline constexpr kit::Scalar time_to_tenth{"time_to_tenth", "sqrt(2 L/g)",
                                           "when a tenth is left; undefined if it never is",
                                           "more than a tenth is left at the end"};
inline constexpr kit::Scalar discharge_rate{
    "discharge_rate", "1/sqrt(2 L/g)",
    "share of the powder that leaves per sqrt(2 L/g) while the second quarter leaves; undefined if half never "
    "does",
    "less than half has left until the end"};
inline constexpr kit::Scalar beverloo_rate{
    "beverloo_rate", "1/sqrt(2 L/g)",
    "the same by Beverloo's law for the outlet and the packing's density; undefined in a tilted cell",
    "the cell is tilted, or its outlet is closed"};
inline constexpr kit::Scalar outlet_diameter{
    "outlet_diameter", "particle diameters",
    "largest round opening in the lower face between the surfaces of wall particles"};
inline constexpr kit::Scalar peak_velocity{
    "peak_velocity", "sqrt(2 g L)",
    "largest speed along gravity in the cell, at any sample; 0: nothing moved along it"};
inline constexpr kit::Scalar max_overlap{"max_overlap", "particle diameters",
                                         "largest overlap after any step; 0: nothing touched"};
inline constexpr kit::Scalar max_force{"max_force", "m 9.81 m/s2",
                                       "largest contact force, at any sample; 0: nothing touched"};
inline constexpr kit::Scalar particles{"particles", "1", "mobile particles at the start"};
inline constexpr kit::Scalar wall_particles{"wall_particles", "1", "frozen particles of the shell"};
inline constexpr kit::Series retention_series{"retention_series", "1", "retention every 0.0165 sqrt(2 L/g)", time};
inline constexpr kit::Series velocity_series{
    "velocity_series", "sqrt(2 g L)", "largest speed along gravity in the cell; undefined while it is empty", time};
inline constexpr kit::Series mobile_series{
    "mobile_series", "1", "mobile particles not yet gone (two diameters outside the cell) over those at the start",
    time};
inline constexpr kit::Series at_rest_series{
    "at_rest_series", "1", "those in the cell slower than 0.001 sqrt(2 g L) over those at the start", time};
inline constexpr kit::Profile overlap_histogram{
    "overlap_histogram", "1",
    "share of contacts per bin of overlap, twenty bins per decade, every 0.165 sqrt(2 L/g); below 1e-6: the "
    "first; none "
    "where nothing touches",
    "overlap (particle diameters)"};
inline constexpr kit::Profile force_histogram{
    "force_histogram", "1",
    "share of contacts per bin of force, twenty bins per decade, every 0.165 sqrt(2 L/g); below 1e-3: the first; "
    "none "
    "where nothing touches",
    "force (m 9.81 m/s2)"};
inline constexpr kit::Profile retained_profile{
    "retained_profile", "1", "retention of those of twenty layers along z that held powder; bin: z/L", "z/L"};

[[nodiscard]] inline std::vector<ObservableSpec> observables() {
    return kit::observed(retention, time_to_half, time_to_tenth, discharge_rate, beverloo_rate, outlet_diameter,
                         peak_velocity, max_overlap, max_force, particles, wall_particles, kit::bond_number,
                         retention_series, velocity_series, mobile_series, at_rest_series, overlap_histogram,
                         force_histogram, retained_profile);
}

}  // namespace grainsweep::tpms_record
