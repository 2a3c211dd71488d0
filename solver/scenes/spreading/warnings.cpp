#include "solver/scenes/spreading/warnings.hpp"

#include "solver/dem/material.hpp"
#include "solver/geometry/loose_parts.hpp"
#include "solver/scenes/kit/rare_sizes.hpp"
#include "solver/scenes/kit/sentence.hpp"
#include "solver/scenes/spreading/filling.hpp"
#include "solver/scenes/spreading/study.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

namespace grainsweep::spreading {
namespace {

using kit::sentence;

constexpr double narrowest = 5;           // largest diameters between a particle and its periodic image
constexpr double fewest_particles = 200;  // of which a layer's statistics can be formed
constexpr double largest_overlap = 0.1;   // of a diameter: beyond it contact laws of small overlaps say nothing
constexpr double steps_per_vibration = 20;
constexpr double thickest = 0.1;  // m, of a usual tool along the travel

/// Largest overlap of two equal spheres that meet at the speed, over their diameter (Hertz 1882):
/// d = (15 m* v^2/(16 E* sqrt(R*)))^(2/5).
double hertz_overlap(const Study& s, double speed) {
    const double radius = s.diameter / 4;
    const double mass = s.particle_mass() / 2;
    const double energy = 15 * mass * speed * speed / (16 * dem::effective_modulus(s.material) * std::sqrt(radius));
    return std::pow(energy, 0.4) / s.diameter;
}

/// The gap against the particles, the layer and the width.
void warn_of_gap(std::vector<Warning>& warnings, const Study& s, double layer) {
    const double smallest = s.sizes.smallest() * s.diameter;
    if (s.gap < smallest / 2)
        warnings.push_back({"gap below half a diameter",
                            sentence("a gap of %.3g m is %.2g of the smallest diameter: the tool meets particles "
                                     "below their centre and pushes them ahead, so that next to nothing is spread",
                                     s.gap, s.gap / smallest)});
    else if (s.gap < smallest)
        warnings.push_back(
            {"gap below one diameter",
             sentence("a gap of %.3g m is %.2g of the smallest diameter: a particle passes only where it is "
                      "squeezed, so that few or none do, about half of the base or more stays bare, and "
                      "the flux depends on youngs_modulus and speed",
                      s.gap, s.gap / smallest)});
    if (s.gap >= layer)
        warnings.push_back(
            {"gap above the layer",
             sentence("the gap of %.3g m (%.3g diameters) is above the settled layer, about %.3g m high: the "
                      "tool hardly touches the powder",
                      s.gap, s.gap / s.diameter, layer)});
    else if (s.gap > s.width)
        warnings.push_back({"gap above the width",
                            sentence("the gap of %.3g diameters is more than the period of the layer of %.3g diameters "
                                     "(width): what is spread is higher than it is wide and feels its own images",
                                     s.gap / s.diameter, s.width / s.diameter)});
}

void warn_of_layer(std::vector<Warning>& warnings, const Study& s, double layer) {
    const double largest = s.sizes.largest() * s.diameter;
    if (layer < largest)
        warnings.push_back({"layer below one diameter",
                            sentence("layer_area and travel give a layer of %.3g diameters: single particles, no layer",
                                     layer / s.diameter)});
    if (static_cast<double>(s.particles) < fewest_particles)
        warnings.push_back(
            {"few particles", sentence("%.0f particles are too few for a steady flux: make layer_area or width "
                                       "larger or the diameter smaller",
                                       static_cast<double>(s.particles))});
    if (s.width < narrowest * largest)
        warnings.push_back(
            {"narrow layer", sentence("the layer repeats itself after %.3g of the largest diameters: particles "
                                      "feel their own images below about %.0f",
                                      s.width / largest, narrowest)});
    // A collision may turn the whole start velocity upwards: v t - g t^2/2 = -layer.
    const double thrown = std::numbers::sqrt3 * start_velocity;
    const double back = (thrown + std::sqrt(thrown * thrown + 2 * s.gravity * layer)) / s.gravity;
    const double settling = static_cast<double>(s.settle_steps) * s.time_step;
    if (settling < back)
        warnings.push_back(
            {"layer still falling",
             sentence("settle_time of %.3g s is too short: particles start with up to %.2g m/s, and those thrown up "
                      "are back on the bed after %.2g s; later ones fall on the spread layer and raise "
                      "layer_roughness",
                      settling, thrown, back)});
}

/// A corner of the file that is far from its place draws its triangles out to a needle.
void warn_of_needles(std::vector<Warning>& warnings, const Study& s) {
    using geometry::End;
    const std::pair<End, const char*> ends[] = {
        {{2, false}, "lowest"}, {{0, true}, "foremost"}, {{0, false}, "rearmost"}};
    for (const auto& [end, name] : ends)
        if (const auto needle = geometry::needle_at(s.surface, end, small_share))
            warnings.push_back(
                {"tip of the tool",
                 std::string("the ") + name +
                     sentence(
                         " point of the surface is the tip of a needle, %.3g m long and %.3g m thick, %.3g m along "
                         "y: if it is no part of the tool, remove it from the file",
                         needle->length, needle->width, needle->tip[1])});
}

/// Powder above the gap is pushed ahead and slopes at about 30 degrees: h^2/(2 tan 30) = (layer - gap) travel.
void warn_of_height(std::vector<Warning>& warnings, const Study& s, double layer) {
    const double heap = layer + std::sqrt(2 * std::numbers::inv_sqrt3 * std::max(layer - s.gap, 0.0) * s.travel);
    const double top = s.gap + s.surface.high()[2];
    if (top < heap)
        warnings.push_back(
            {"low tool", sentence("the top of the tool is %.3g m over the base, and the powder ahead of it piles up to "
                                  "about %.3g m: it passes over the tool and falls on the spread layer",
                                  top, heap)});
}

void warn_of_tool(std::vector<Warning>& warnings, const Study& s, double layer) {
    if (s.tool == Tool::file) {
        warn_of_needles(warnings, s);
        warn_of_height(warnings, s, layer);
    }
    const double measured = (1 - measured_from) * s.travel;
    if (s.behind + s.clearance >= measured)
        warnings.push_back(
            {s.tool == Tool::blade ? "blade thicker than the measured travel" : "tool thicker than the measured travel",
             sentence(
                 "the tool reaches %.3g m behind its edge, and the layer is at rest from %.3g m behind that on: no "
                 "spread layer is left within the measured travel of %.3g m, and packing_fraction, "
                 "layer_roughness, empty_share and patch_sd have no value",
                 s.behind, s.clearance, measured)});
    const double thickness = s.ahead + s.behind;
    if (s.tool == Tool::file && (thickness > thickest || thickness < s.diameter))
        warnings.push_back(
            {"size of the tool", sentence("the surface is %.3g m thick along the travel (%.3g diameters) and %.3g m "
                                          "high: is tool_scale the file's unit of length?",
                                          thickness, thickness / s.diameter, s.surface.high()[2])});
    if (s.travel < 10 * s.diameter)
        warnings.push_back(
            {"short travel", sentence("a travel of %.3g m is %.2g diameters: the flux does not become steady", s.travel,
                                      s.travel / s.diameter)});
    const double period = s.vibration_frequency > 0 ? 1 / s.vibration_frequency : 0;
    if (s.vibration_frequency > 0 && period < steps_per_vibration * s.time_step)
        warnings.push_back(
            {"vibration faster than the time step",
             sentence("a vibration of %.4g Hz has %.2g time steps of %.3g s in a period: at least %.0f follow it",
                      s.vibration_frequency, period / s.time_step, s.time_step, steps_per_vibration)});
    const double shaking = 2 * std::numbers::pi * s.vibration_frequency * s.vibration_amplitude;
    const double fastest = std::hypot(s.speed * (1 + std::abs(s.roller_spin)), shaking);
    const double overlap = hertz_overlap(s, fastest);
    if (overlap > largest_overlap)
        warnings.push_back(
            {"particles too soft for the speed",
             sentence("at %.3g m/s particles of this stiffness overlap by about %.2g of a diameter, and contact "
                      "laws hold for small overlaps: raise youngs_modulus",
                      fastest, overlap)});
}

}  // namespace

std::vector<Warning> warnings_of(const Inputs& inputs, const Files& files) {
    const Study s = study_of(inputs, files);
    const double layer = s.layer_area / (settled_fraction * layer_length(s));
    std::vector<Warning> warnings;
    warn_of_gap(warnings, s, layer);
    warn_of_layer(warnings, s, layer);
    warn_of_tool(warnings, s, layer);
    kit::warn_of_rare_sizes(warnings, s.sizes, s.diameter, static_cast<double>(s.particles));
    return warnings;
}

}  // namespace grainsweep::spreading
