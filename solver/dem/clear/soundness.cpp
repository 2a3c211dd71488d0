// Checks of the clear engine: states beyond the limits are reported with kind, place and time (limits.hpp).
#include "solver/dem/clear/engine.hpp"
#include "solver/dem/limits.hpp"
#include "solver/dem/shaking.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace grainsweep::dem::clear {

using namespace geometry;

/// Returns whether every position is a number and every speed is possible in this case. Else reports and repairs the
/// state.
bool ClearEngine::sound() {
    for (std::size_t i = 0; i < p_.size(); ++i) {
        if (!mobile(i)) continue;
        const double speed = norm(p_.velocity[i]);
        char text[200];
        if (!finite(p_.position[i]) || !std::isfinite(speed) || !finite(p_.angular_velocity[i])) {
            p_.position[i] = position_at_build_[i];
            p_.velocity[i] = Vec3{};
            p_.angular_velocity[i] = Vec3{};
            if (bodies_.is_member(i)) bodies_.repair(bodies_.body_of(i));
            report("the motion of a particle is no longer a number", i);
        } else if (speed * part_ > largest_sound_displacement * radius(i)) {
            std::snprintf(text, sizeof text, "a particle moves %.3g of its radius in one time step (limit %.3g)",
                          speed * part_ / radius(i), largest_sound_displacement);
            report(text, i);
        } else if (speed > speed_limit_) {
            report(flaw_of_speed(speed, speed_limit_), i);
        }
    }
    return fault_.empty();
}

void ClearEngine::set_speed_limit() {
    double start = 0;
    double lightest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < p_.size(); ++i) {
        if (!mobile(i)) continue;
        start = std::max(start, norm(p_.velocity[i]));
        if (spins_) start = std::max(start, radius(i) * norm(p_.angular_velocity[i]));
        lightest = std::min(lightest, 1 / inverse_mass(i));
    }
    double wall = fastest(shaking_);
    for (const auto& contacts : walls_)
        if (contacts.wall.present()) wall = std::max(wall, contacts.wall.fastest());
    double fall = 0;  // through the domain; without limit along a periodic axis
    for (std::size_t k = 0; k < 3; ++k) {
        if (gravity_[k] == 0) continue;
        fall = domain_.periodic[k] ? std::numeric_limits<double>::infinity()
                                   : std::hypot(fall, std::sqrt(2 * std::abs(gravity_[k]) * domain_.length(k)));
    }
    double active = 0;
    const double still = start;
    (void)mechanical_energy(active);
    const double released =
        p_.size() > 0 && lightest < std::numeric_limits<double>::infinity() ? std::sqrt(2 * active / lightest) : 0.0;
    speed_limit_ = largest_sound_speed_factor * (still + wall + fall + released);
    balance_.restart();
    judge_wall_speeds();
}

/// A wall that moves farther than a radius in a step could pass particles unseen.
void ClearEngine::judge_wall_speeds() {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < p_.size(); ++i) least = std::min(least, radius(i));
    for (std::size_t w = 0; w < walls_.size() && fault_.empty(); ++w) {
        if (!walls_[w].wall.present()) continue;
        fault_ = flaw_of_wall_speed(w, walls_[w].wall.fastest_surface(), part_, least, work_.steps);
    }
}

/// Reports centres that have passed a wall without an inside. A centre that passed in this step is no farther from the
/// wall than both moved.
void ClearEngine::judge_passages(const Contacts& contacts) {
    const auto& wall = contacts.wall;
    const double way_of_wall = part_ * wall.fastest_surface();
    std::size_t t = 0;
    for (std::uint32_t entry = 0; entry < contacts.near.size(); ++entry) {
        const std::size_t i = contacts.near[entry];
        double distance = radius(i);
        for (; t < contacts.touches.size() && contacts.touches[t].entry == entry; ++t)
            distance = std::min(distance, contacts.touches[t].place.distance);
        const Vec3 moved = part_ * p_.velocity[i];
        if (distance > norm(moved) + way_of_wall) continue;
        if (wall.passed(wall.pose_before(wall_time() - part_), p_.position[i] - moved, p_.position[i]))
            report("the centre of a particle passed through wall " + std::to_string(&contacts - walls_.data()), i);
    }
}

/// Reports frozen spheres in walls that forces move. Between two rebuilds a wall moves by less than a radius.
void ClearEngine::judge_frozen() {
    std::vector<std::uint32_t> frozen;
    for (std::size_t w = 0; w < walls_.size(); ++w) {
        const MovingWall& wall = walls_[w].wall;
        if (!wall.free() || !wall.present()) continue;
        frozen.clear();
        for (std::uint32_t i = 0; i < p_.size(); ++i)
            if (!mobile(i) && wall.wall().touches(p_.kind[i])) frozen.push_back(i);
        if (const auto entry = wall.reaches(frozen, p_.position, radii(), deepest_frozen))
            report(flaw_of_frozen(w), frozen[*entry]);
    }
}

/// Energy minus the work of moving walls and of shaking must not grow: contacts store or dissipate.
void ClearEngine::check_energy() {
    double active = 0;
    const double energy = mechanical_energy(active);
    const auto flaw = balance_.flaw({.steps = work_.steps,
                                     .balance = energy - work_of_walls_ - work_of_shaking_ + work_of_wrapping_,
                                     .active = active,
                                     .walls = work_of_walls_});
    if (!flaw) return;
    std::size_t fastest_particle = 0;
    for (std::size_t i = 1; i < p_.size(); ++i)
        if (norm(p_.velocity[i]) > norm(p_.velocity[fastest_particle])) fastest_particle = i;
    report(*flaw, fastest_particle);
}

/// Compares the length of a part with the longest stable step of the present contacts.
void ClearEngine::check_network() {
    gather_network();
    if (!control_.look(network_, part_, std::max(largest_overlap_, largest_wall_overlap_))) return;
    const StepShare found = network_.share(part_);
    if (!control_.judge(found, network_)) return;
    std::vector<ContactForce> all;
    contacts(all);
    const auto i = static_cast<std::size_t>(found.sphere);
    report(flaw_of_step(found, part_, all, p_.id[i]), i);
}

/// The first fault stays: later ones follow from it.
void ClearEngine::report(const std::string& what, std::size_t i) {
    if (!fault_.empty()) return;
    fault_ = what + place_and_time(p_.id[i], p_.position[i], work_.steps, time_after(work_.steps));
}

void ClearEngine::report_contacts() {
    const auto judge = [&](std::size_t i, double share, double deepest, double stiffness, const std::string& partner) {
        const std::string flaw = flaw_of_contact(share, std::sqrt(swing_factor_ * stiffness), deepest);
        if (!flaw.empty()) report(flaw + partner, i);
    };
    for (std::size_t i = 0; i < p_.size(); ++i)
        for (std::uint32_t k = list_.begin(i); k < list_.end(i); ++k) {
            const std::size_t j = list_[k].j();
            const Vec3 branch = p_.position[i] - (p_.position[j] + image_shifts_[list_[k].image()]);
            const double r = norm(branch);
            const double overlap = radius(i) + radius(j) - r;
            judge(i, overlap / (2 * std::min(radius(i), radius(j))), largest_sound_overlap,
                  slope_over(std::sqrt(effective_radius(i, j) * overlap)) / reduced_mass(i, j, (1 / r) * branch) *
                      stiffness_[pair(i, j)],
                  "particle " + std::to_string(p_.id[j]));
        }
    for (std::size_t w = 0; w < walls_.size(); ++w)
        for (const auto& [entry, place] : walls_[w].touches) {
            const std::size_t i = walls_[w].near[entry];
            const double overlap = radius(i) - place.distance;
            judge(i, overlap / (2 * radius(i)), deepest_in_walls_,
                  slope_over(std::sqrt(radius(i) * overlap)) * inverse_mass(i) * walls_[w].stiffness[p_.kind[i]],
                  "wall " + std::to_string(w));
        }
}

}  // namespace grainsweep::dem::clear
