// What a case of the rotating drum answers. Definitions as functions: solver/observables/turned_bed.hpp.
#pragma once

#include "solver/scenes/kit/powder.hpp"

namespace grainsweep::drum::record {

inline constexpr kit::Scalar angle_cm{
    "angle_cm", "deg",
    "dynamic angle of repose by the mass centre: the angle by which its radius from the axis is ahead of the vertical, "
    "mean over the frames; that of the surface of a bed that is a segment of a circle",
    "no frame was taken with powder in the drum"};
inline constexpr kit::Scalar angle_cm_error{
    "angle_cm_error", "deg", "standard error of angle_cm from the spread of 10 consecutive blocks of frames",
    "there are fewer than 20 frames"};
inline constexpr kit::Scalar angle_cm_deviation{
    "angle_cm_deviation", "deg", "standard deviation of angle_series: large where the bed slumps or surges",
    "no frame was taken with powder in the drum"};
inline constexpr kit::Scalar angle_surface{
    "angle_surface", "deg",
    "slope of the line through the surface: the heights where the mean solid fraction of cells of D by D by the length "
    "falls through 0.3, |x| <= 0.4 R",
    "the mean solid fraction falls through 0.3 in fewer than two columns of cells: too little powder"};
inline constexpr kit::Scalar surface_residual{
    "surface_residual", "1", "root mean square height of the surface above and below that line, over D",
    "the mean solid fraction falls through 0.3 in fewer than two columns of cells: too little powder"};
inline constexpr kit::Scalar angle_cover{
    "angle_cover", "deg",
    "slope of the line through the heights of `surface` with |x| <= 0.5 R, the middle half of the drum",
    "fewer than two columns of the middle half have a surface"};
inline constexpr kit::Scalar angle_cover_middle{"angle_cover_middle", "deg",
                                                "slope of the line through those with |x| <= 0.2 R, the middle fifth",
                                                "fewer than two columns of the middle fifth have a surface"};
inline constexpr kit::Scalar cover_area{"cover_area", "m2",
                                        "area of the cells of occupancy that are hidden half of the time or more"};
inline constexpr kit::Scalar surface_speed{
    "surface_speed", "1",
    "mean velocity down the line of angle_surface of the centres 0 to 1 D below it and within 2.5 D of the foot of the "
    "perpendicular from the axis, over the speed of the wall",
    "there is no line of angle_surface, or no centre within 1 D below it"};
inline constexpr kit::Scalar layer_depth{
    "layer_depth", "1",
    "depth of the flowing layer: where below that line the mean velocity along it changes sign, over D",
    "there is no line of angle_surface, or the velocity below it changes no sign"};
inline constexpr kit::Scalar wall_layer_speed{
    "wall_layer_speed", "1",
    "mean tangential speed of the spheres nearer than 0.1 D to the lower half of the wall, over that of centres that "
    "the drum carries round, w (R - D/2)",
    "no sphere was within 0.1 D of the lower half of the wall"};
inline constexpr kit::Scalar wall_slip{"wall_slip", "1", "1 - wall_layer_speed: 0, the wall carries its layer along",
                                       "no sphere was within 0.1 D of the lower half of the wall"};
inline constexpr kit::Scalar torque{
    "torque", "N m",
    "torque that turns drum and plates against the powder: the work of their forces over the angle, mean over all "
    "steps "
    "of the measured time, with the moments of rolling resistance, mean over the frames"};
inline constexpr kit::Scalar coordination{
    "coordination", "1", "number of other particles a particle touches, mean over particles and frames",
    "no frame was taken"};
inline constexpr kit::Scalar kinetic_energy{"kinetic_energy", "J",
                                            "of the particles' translation, mean over the frames"};
inline constexpr kit::Scalar max_overlap{
    "max_overlap", "1",
    "largest overlap of two particles over the smaller diameter, over all steps of the measured time"};
inline constexpr kit::Scalar particles{"particles", "1", "particles in the drum"};
inline constexpr kit::Profile occupancy{
    "occupancy", "1",
    "share of the frames in which a particle hides the centre of a cell from a view along the axis, of the cells whose "
    "centres lie in the drum; bin: column + columns times row, counted from the least x and z, columns = "
    "2 ceil(R/occupancy_cell)",
    "cell"};
inline constexpr kit::Profile surface{
    "surface", "m",
    "height over the axis where occupancy falls through 0.5, seen from above, per column of cells; bin: x, the drum "
    "raises the bed towards negative x",
    "x (m)"};
inline constexpr kit::Series angle_series{"angle_series", "deg", "angle_cm of each frame; time since the start",
                                          "time since the start (s)"};

[[nodiscard]] inline std::vector<ObservableSpec> observables() {
    return kit::observed(angle_cm, angle_cm_error, angle_cm_deviation, angle_surface, surface_residual, angle_cover,
                         angle_cover_middle, cover_area, surface_speed, layer_depth, wall_layer_speed, wall_slip,
                         torque, coordination, kinetic_energy, max_overlap, particles, kit::bond_number, occupancy,
                         surface, angle_series);
}

}  // namespace grainsweep::drum::record
