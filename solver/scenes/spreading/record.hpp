// Observables of powder spreading.
#pragma once

#include "solver/scenes/kit/powder.hpp"

#include <string_view>

namespace grainsweep::spreading::record {

inline constexpr kit::Scalar mfr{
    "mfr", "1",
    "mass flow rate under the tool over that of the swept gap filled solid: (M(t2) - M(t1))/(t2 - t1)"
    "/(W gap v rho), M the mass of the centres behind the edge of the tool (of a blade the front face, of a roller the "
    "axis, of a surface the foremost of its lowest points), with those that left the box there, t1 at 2/7 "
    "of the travel, t2 where the sweep ended"};
inline constexpr kit::Scalar mfr_window{
    "mfr_window", "1",
    "mass between the planes of rear and front face and below the gap over that of the slot filled "
    "solid, W gap thickness rho; mean of the samples from t1 to t2; of a blade only",
    "the tool is no blade"};
inline constexpr kit::Scalar mfr_thesis{
    "mfr_thesis", "s",
    "the same mass over W gap v rho, as eq. 15-17 of Wu (2020) are printed: mfr_window times "
    "thickness/speed; of a blade only",
    "the tool is no blade"};
inline constexpr kit::Scalar mfr_standard_error{
    "mfr_standard_error", "1",
    "standard error of mfr from the spread of 10 consecutive blocks of the flux; undefined where nothing passed",
    "no particle passed the tool, or all blocks of the flux are too short"};
inline constexpr kit::Scalar end_of_travel{"end_of_travel", "m", "travel of the tool when the sweep ended"};
inline constexpr kit::Scalar max_overlap{
    "max_overlap", "1",
    "largest overlap of two particles over the smaller diameter, over all steps of the sweep; 0: none touched"};
inline constexpr kit::Scalar packing_fraction{
    "packing_fraction", "1",
    "volume of the spread particles over that of a layer as high as the gap, from where the "
    "edge was at t1 to one thickness behind a blade at the end, 5 D behind a roller's axis or the rear of a surface; "
    "of a further layer what the bed has gained; undefined, as are layer_roughness, empty_share and patch_sd, "
    "where the tool did not get that far, and above 0.64 (unequal spheres: 0.87), which is no packing: spheres that "
    "stick out over the gap or fill hollows below",
    "the rear of the tool did not get behind the part of the layer that is measured: lengthen travel or take a thinner "
    "tool; or what it laid, over a layer as high as the gap, is more than a packing of such spheres holds"};
inline constexpr kit::Scalar layer_roughness{
    "layer_roughness", "1",
    "root mean square deviation of the height of the spread layer's surface, seen from above "
    "on a grid of D/4, over the diameter; undefined where empty_share is above one half: there is no layer",
    "the rear of the tool did not get behind the part of the layer that is measured: lengthen travel or take a thinner "
    "tool; or empty_share is above one half"};
inline constexpr kit::Scalar empty_share{"empty_share", "1",
                                         "share of the same grid that no particle of the layer covers",
                                         "the rear of the tool did not get behind the part of the layer that is "
                                         "measured: lengthen travel or take a thinner tool"};
inline constexpr kit::Scalar patch_sd{
    "patch_sd", "1",
    "standard deviation of the packing fraction over patches of the same layer, "
    "squares of about 5 D: how uneven it is; "
    "undefined of fewer than four",
    "the rear of the tool did not get behind the part of the layer that is measured: lengthen travel or take a thinner "
    "tool; or the measured part has fewer than four patches"};
inline constexpr kit::Scalar solid_behind{
    "solid_behind", "1",
    "volume of the particles with centres 5 to 15 D behind the tool (the rear face of a blade, the axis of a roller, "
    "the rearmost point of a surface) and below the gap, over that volume; mean of the samples from where these lie "
    "behind the place of the edge at t1",
    "the rear of the tool did not get behind the part of the layer that is measured: lengthen travel or take a thinner "
    "tool"};
inline constexpr kit::Scalar tool_force{
    "tool_force", "N/m",
    "force of the powder on the tool against its travel, over the width W; mean from t1 to t2, over every step"};
inline constexpr kit::Scalar tool_lift{"tool_lift", "N/m", "the same, upwards"};
inline constexpr kit::Scalar particles{
    "particles", "1",
    "particles present at the end: those that left the box through its open faces or were taken away between layers "
    "are not"};
inline constexpr kit::Profile vx_profile{
    "vx_profile", "m/s",
    "mean velocity along the travel in the 12 layers of thickness D/2 above the gap, "
    "within 6 D ahead of the edge, from t1 to t2, undefined where there was no particle; bin: top of the "
    "layer over the gap, in D",
    "top of the layer over the gap (D)"};
inline constexpr kit::Scalar vx_unevenness{
    "vx_unevenness", "1",
    "root mean square second difference of vx_profile from layer to layer, over the speed of the tool: 0 for a "
    "profile that rises evenly; undefined where no three neighbouring layers hold a "
    "particle per sample on average",
    "no three neighbouring layers ahead of the tool hold a particle per sample"};
inline constexpr kit::Series flux_series{"flux_series", "1",
                                         "mfr of each 1/140 of the travel; time since the tool started",
                                         "time since the tool started (s)"};

// With several layers there is one value per layer; observables without "by_layer" belong to the last layer.
inline constexpr std::string_view number_of_layer = "number of the layer";
inline constexpr kit::Profile mfr_by_layer{
    "mfr_by_layer", "1", "mfr of each layer, of the powder supplied for it; several layers only", number_of_layer};
inline constexpr kit::Profile packing_by_layer{
    "packing_by_layer", "1",
    "packing_fraction of each layer: what the bed has gained with it, so that it grows towards that of the bed as "
    "more powder fills what the layers below have settled; several layers only",
    number_of_layer};
inline constexpr kit::Profile patch_sd_by_layer{"patch_sd_by_layer", "1", "patch_sd of each layer; several layers only",
                                                number_of_layer};
inline constexpr kit::Profile roughness_by_layer{"roughness_by_layer", "1",
                                                 "layer_roughness of each layer; several layers only", number_of_layer};
inline constexpr kit::Profile empty_share_by_layer{"empty_share_by_layer", "1",
                                                   "empty_share of each layer; several layers only", number_of_layer};
inline constexpr kit::Profile force_by_layer{"force_by_layer", "N/m", "tool_force of each layer; several layers only",
                                             number_of_layer};
inline constexpr kit::Profile bed_packing{
    "bed_packing", "1",
    "solid fraction of the finished bed between the levels of each layer, spheres cut by the levels; several layers "
    "only",
    number_of_layer};

[[nodiscard]] inline std::vector<ObservableSpec> observables() {
    return kit::observed(mfr, mfr_window, mfr_thesis, mfr_standard_error, end_of_travel, max_overlap, packing_fraction,
                         layer_roughness, empty_share, patch_sd, solid_behind, tool_force, tool_lift, particles,
                         kit::bond_number, vx_profile, vx_unevenness, flux_series, mfr_by_layer, packing_by_layer,
                         patch_sd_by_layer, roughness_by_layer, empty_share_by_layer, force_by_layer, bed_packing);
}

}  // namespace grainsweep::spreading::record
