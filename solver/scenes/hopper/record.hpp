// What a case of the hopper answers. Definitions as functions: solver/observables/outflow.hpp.
#pragma once

#include "solver/scenes/kit/powder.hpp"

namespace grainsweep::hopper::record {

inline constexpr kit::Scalar rate{
    "rate", "kg/s",
    "mass per time through the opening: least-squares slope of mass_series while 10 to 50 % of the powder is out; "
    "undefined for fewer than three values",
    "fewer than three values of mass_series lie between 10 and 50 % of the powder: it jams, or frame_interval is too "
    "long"};
inline constexpr kit::Scalar rate_error{"rate_error", "kg/s",
                                        "standard error of rate from the spread of 5 consecutive blocks",
                                        "fewer than ten values of mass_series lie between 10 and 50 % of the powder"};
inline constexpr kit::Scalar rate_scaled{
    "rate_scaled", "1", "rate over rho g^(1/2) D^(5/2); of a slot over rho g^(1/2) D^(3/2) and its length",
    "fewer than three values of mass_series lie between 10 and 50 % of the powder: it jams, or frame_interval is too "
    "long"};
inline constexpr kit::Scalar beverloo_rate{
    "beverloo_rate", "kg/s",
    "Beverloo's law for a round opening (Beverloo, Leniger & van de Velde 1961): 0.58 rho bulk_fraction g^(1/2) "
    "(opening_size - 1.4 D)^(5/2)",
    "the opening is a slot, or bulk_fraction has no value"};
inline constexpr kit::Scalar bulk_fraction{
    "bulk_fraction", "1",
    "solid fraction of the settled powder in the container's cross-section, from 3 D above the floor or cone to 3 D "
    "below the height that 95 % of the centres do not reach; undefined for less powder",
    "the settled powder is less than 6 D high"};
inline constexpr kit::Scalar jammed{
    "jammed", "1",
    "1: nothing left during the last 10 sqrt(opening_size/g) while the space over the opening, as high as wide and "
    "at least 2 D, is filled to more than 0.2; 0: not so"};
inline constexpr kit::Scalar discharged{"discharged", "1", "share of the mass outside at the end"};
inline constexpr kit::Scalar flow_time{"flow_time", "s", "time from the opening to the end of the case"};
inline constexpr kit::Scalar segregation{
    "segregation", "1",
    "mean diameter of the spheres that left while 10 to 50 % were out over that of all, less 1: negative, the small "
    "ones leave first; of unequal spheres only",
    "all spheres are equal, or rate has no value"};
inline constexpr kit::Scalar max_overlap{
    "max_overlap", "1", "largest overlap of two particles over the smaller diameter, over all steps from the opening"};
inline constexpr kit::Scalar particles{"particles", "1", "particles filled in"};
inline constexpr kit::Series mass_series{"mass_series", "kg", "mass outside; time since the opening",
                                         "time since the opening (s)"};

[[nodiscard]] inline std::vector<ObservableSpec> observables() {
    return kit::observed(rate, rate_error, rate_scaled, beverloo_rate, bulk_fraction, jammed, discharged, flow_time,
                         segregation, max_overlap, particles, kit::bond_number, mass_series);
}

}  // namespace grainsweep::hopper::record
