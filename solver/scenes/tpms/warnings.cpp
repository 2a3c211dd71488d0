#include "solver/scenes/tpms/warnings.hpp"

#include "solver/dem/material.hpp"
#include "solver/dem/shaking.hpp"
#include "solver/dem/time_step.hpp"
#include "solver/geometry/tpms_outlet.hpp"
#include "solver/scenes/kit/sentence.hpp"
#include "solver/scenes/tpms/question.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>
#include <string>
#include <tuple>

namespace grainsweep {
namespace {

using kit::sentence;

constexpr double tight_shell = 1;         // diameters: a thinner shell of spheres has holes that spheres pass
constexpr double loosest_packing = 0.55;  // random loose packing
constexpr double largest_overlap = 0.1;   // of a diameter: beyond it the case is reported unstable
constexpr double shares = 64;             // of the edge, in which shells are tabulated
constexpr double coarse_step = 0.4;       // of the Rayleigh time
constexpr double felt_vibration = 0.01;   // of gravity

/// Outlet over edge where the shell is k/64 of the edge. Forming it takes milliseconds: kept.
double outlet_share(geometry::TpmsCell cell, int side, int k) {
    static std::map<std::tuple<geometry::TpmsCell, int, int>, double> known;
    static std::mutex guard;
    const std::lock_guard lock(guard);
    const auto [found, fresh] = known.try_emplace({cell, side, k}, 0);
    const double thickness = std::clamp(k / shares, 1e-3, 0.499);  // allowed thickness of a shell
    if (fresh) found->second = geometry::outlet_diameter(geometry::TpmsShell(cell, side, 1, thickness));
    return found->second;
}

/// Between the surfaces of wall particles, in diameters, to a few hundredths of the edge.
double outlet_of(const TpmsQuestion& q) {
    const double place = shares * q.shell / q.edge;
    const int k = static_cast<int>(place);
    const double thin = outlet_share(q.cell, q.side, k), thick = outlet_share(q.cell, q.side, k + 1);
    return q.edge * (thin + (place - k) * (thick - thin)) - 1;
}

void warn_of_cell(std::vector<Warning>& warnings, const TpmsQuestion& q) {
    if (q.shell < tight_shell)
        warnings.push_back(
            {"leaky shell", sentence("a shell of %.2g diameters is thinner than its spheres: the powder leaks "
                                     "through the wall; take at least %.0f",
                                     q.shell, tight_shell)});
    if (const double outlet = outlet_of(q); outlet < 1)
        warnings.push_back(
            {"closed outlet", sentence("the largest opening of the lower face is %.2g diameters wide with an "
                                       "edge of %.3g and a shell of %.3g: nothing can leave there",
                                       std::max(outlet, 0.0), q.edge, q.shell)});
    if (!q.packing_given && q.packing_fraction < loosest_packing)
        warnings.push_back(
            {"packing looser than powder at rest",
             sentence("a packing_fraction of %.3g is below random loose packing, %.2f: the powder collapses "
                      "before it flows",
                      q.packing_fraction, loosest_packing)});
}

void warn_of_motion(std::vector<Warning>& warnings, const TpmsQuestion& q) {
    if (q.end_time < 1)
        warnings.push_back(
            {"ends before anything has fallen out",
             sentence("end_time of %.3g sqrt(2 L/g) is less than the free fall through the cell, 1", q.end_time)});
    const double mass = dem::sphere_mass(q.diameter / 2, q.material.density) / 2;
    const double speed = q.free_fall_speed();
    const double overlap =
        std::pow(15 * mass * speed * speed / (16 * dem::effective_modulus(q.material) * std::sqrt(q.diameter / 4)),
                 0.4) /
        q.diameter;
    if (overlap > largest_overlap)
        warnings.push_back(
            {"particles too soft for the cell",
             sentence("after the fall through the cell, at %.3g m/s, two particles overlap by about %.2g of a "
                      "diameter (Hertz); from %.1f on a case is reported unstable: raise youngs_modulus",
                      speed, overlap, largest_overlap)});
    const double rayleigh = dem::rayleigh_time(q.material, q.diameter / 2);
    if (q.time_step > coarse_step * rayleigh)
        warnings.push_back(
            {"coarse time step", sentence("time_step of %.3g s is %.2g of the Rayleigh time; contacts are "
                                          "resolved below about %.1f",
                                          q.time_step, q.time_step / rayleigh, coarse_step)});
    if (dem::is_still(q.shaking)) return;
    const double peak = 2 * std::numbers::pi * q.shaking.frequency * dem::fastest(q.shaking);
    if (peak < felt_vibration * q.gravity)
        warnings.push_back(
            {"vibration too weak to matter",
             sentence("its peak acceleration is %.2g of gravity: with amplitude and frequency as they are the "
                      "powder hardly feels it",
                      peak / q.gravity)});
    if (dem::fastest(q.shaking) > speed)
        warnings.push_back(
            {"vibration faster than free fall",
             sentence("the cell moves at up to %.3g m/s, the powder falls at %.3g m/s at most: it is thrown, not "
                      "let out",
                      dem::fastest(q.shaking), speed)});
}

}  // namespace

std::vector<Warning> tpms_discharge_warnings(const Inputs& inputs, const Files&) {
    const TpmsQuestion question(inputs, 1);
    std::vector<Warning> warnings;
    warn_of_cell(warnings, question);
    warn_of_motion(warnings, question);
    return warnings;
}

}  // namespace grainsweep
