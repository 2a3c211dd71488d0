// What a case of powder spreading answers.
#pragma once

#include "solver/scenes/kit/powder.hpp"

namespace grainsweep::spreading::record {

inline constexpr kit::Scalar mfr{
    "mfr", "1",
    "mass flow rate under the blade over that of the swept gap filled solid: (M(t2) - M(t1))/(t2 - t1)"
    "/(W gap v rho), M the mass of the centres behind the front face, with those that left the box there, t1 at "
    "2/7 "
    "of the travel, t2 where the sweep ended"};
inline constexpr kit::Scalar mfr_window{
    "mfr_window", "1",
    "mass between the planes of rear and front face and below the gap over that of the slot filled "
    "solid, W gap thickness rho; mean of the samples from t1 to t2"};
inline constexpr kit::Scalar mfr_thesis{
    "mfr_thesis", "s",
    "the same mass over W gap v rho, as eq. 15-17 of Wu (2020) are printed: mfr_window times "
    "thickness/speed"};
inline constexpr kit::Scalar mfr_standard_error{
    "mfr_standard_error", "1",
    "standard error of mfr from the spread of 10 consecutive blocks of the flux; undefined where nothing passed"};
inline constexpr kit::Scalar end_of_travel{"end_of_travel", "m", "travel of the blade when the sweep ended"};
inline constexpr kit::Scalar max_overlap{
    "max_overlap", "1",
    "largest overlap of two particles over the smaller diameter, over all steps of the sweep; 0: none touched"};
inline constexpr kit::Scalar packing_fraction{
    "packing_fraction", "1",
    "volume of the spread particles over that of a layer as high as the gap, from where the "
    "front face was at t1 to one thickness behind the blade at the end; undefined, as are layer_roughness and "
    "empty_share, where the blade did not get that far"};
inline constexpr kit::Scalar layer_roughness{
    "layer_roughness", "1",
    "root mean square deviation of the height of the spread layer's surface, seen from above "
    "on a grid of D/4, over the diameter; undefined where empty_share is above one half: there is no layer"};
inline constexpr kit::Scalar empty_share{"empty_share", "1", "share of the same grid that no particle covers"};
inline constexpr kit::Scalar particles{
    "particles", "1", "particles present at the end: those that left the box through its open faces are not"};
inline constexpr kit::Profile vx_profile{
    "vx_profile", "m/s",
    "mean velocity along the blade's motion in the 12 layers of thickness D/2 above the gap, "
    "within 6 D ahead of the front face, from t1 to t2, undefined where there was no particle; bin: top of the "
    "layer over the gap, in D",
    "top of the layer over the gap (D)"};
inline constexpr kit::Scalar vx_unevenness{
    "vx_unevenness", "1",
    "root mean square second difference of vx_profile from layer to layer, over the speed of the blade: 0 for a "
    "profile that rises evenly; undefined where no three neighbouring layers hold a "
    "particle per sample on average"};
inline constexpr kit::Series flux_series{"flux_series", "1",
                                         "mfr of each 1/140 of the travel; time since the blade started",
                                         "time since the blade started (s)"};

[[nodiscard]] inline std::vector<ObservableSpec> observables() {
    return kit::observed(mfr, mfr_window, mfr_thesis, mfr_standard_error, end_of_travel, max_overlap, packing_fraction,
                         layer_roughness, empty_share, particles, kit::bond_number, vx_profile, vx_unevenness,
                         flux_series);
}

}  // namespace grainsweep::spreading::record
