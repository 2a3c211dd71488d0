#include "solver/dem/step_control.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace grainsweep::dem {

namespace {

constexpr std::int64_t check_interval = 512, check_interval_of_few = 128, early_interval = 32;
constexpr std::size_t few_spheres = 100;
constexpr double grown_overlap = 1.2;  ///< divided by that at the last check: an early check
constexpr double same_bound = 0.1;     ///< relative change of the bound within which the last share is scaled
constexpr int most_guesses = 8;        ///< checks with a scaled share in a row
/// Parts are doubled after `calm_checks` at which they would have been below this share of the largest one.
constexpr double well_below = 0.75;
constexpr int calm_checks = 4;
constexpr double recommended_share = 0.5;  ///< in the words of a fault; the load may still grow

}  // namespace

bool StepControl::take_parts() {
    if (state_.wanted == state_.halvings) return false;
    state_.halvings = state_.wanted;
    state_.most = std::max(state_.most, state_.halvings);
    state_.calm = 0;
    state_.bound = 0;
    return true;
}

bool StepControl::due(std::int64_t steps, double overlap, std::size_t spheres) const {
    if (steps % (spheres > few_spheres ? check_interval : check_interval_of_few) == 0) return true;
    return steps % early_interval == 0 && overlap > grown_overlap * state_.overlap;
}

bool StepControl::look(const Network& network, double part, double overlap) {
    state_.overlap = overlap;
    const double bound = network.bound(part);
    // Without dampers the eigenvalue is 4 share^2, with dampers it is larger.
    const auto below = [bound](double share) { return bound <= 4 * share * share; };
    if (state_.halvings == 0 && below(allowed_)) return false;
    if (state_.halvings > 0 && below(well_below * allowed_ / 2)) {
        rest_or_double(0);
        return false;
    }
    if (state_.guesses >= most_guesses || !(std::abs(bound - state_.bound) <= same_bound * state_.bound)) {
        state_.bound = bound;
        return true;
    }
    const double share = state_.share * std::sqrt(bound / state_.bound);
    if (share > allowed_) {
        state_.bound = bound;
        return true;
    }
    ++state_.guesses;
    rest_or_double(share);
    return false;
}

/// After a check at which the parts need not be halved.
void StepControl::rest_or_double(double share) {
    if (state_.halvings == 0 || 2 * share > well_below * allowed_) {
        state_.calm = 0;
    } else if (++state_.calm == calm_checks) {
        state_.calm = 0;
        state_.wanted = state_.halvings - 1;
    }
}

bool StepControl::judge(const StepShare& found) {
    state_.share = found.share;
    state_.guesses = 0;
    if (!(found.share > allowed_)) {
        rest_or_double(found.share);
        return false;
    }
    if (!follows_) return true;
    double share = found.share;
    for (; share > allowed_ && state_.wanted < most_halvings; share /= 2) ++state_.wanted;
    return !(share <= 1);
}

bool StepControl::restore(const State& state) {
    const auto sound = [](std::int32_t x, std::int32_t most) { return x >= 0 && x <= most; };
    state_ = state;
    return sound(state.halvings, most_halvings) && sound(state.wanted, most_halvings) &&
           sound(state.most, most_halvings) && sound(state.calm, calm_checks) && sound(state.guesses, most_guesses) &&
           std::isfinite(state.overlap) && std::isfinite(state.bound) && std::isfinite(state.share) &&
           (follows_ || (state.halvings == 0 && state.wanted == 0));
}

std::string flaw_of_step(const StepShare& found, double part, std::span<const ContactForce> contacts, std::int32_t id) {
    int count = 0;
    double largest = 0;
    for (const ContactForce& c : contacts) {
        if (c.first != id && c.second != id) continue;
        ++count;
        largest = std::max(largest, c.normal_force);
    }
    char text[240];
    std::snprintf(
        text, sizeof text,
        "the time step of %.3g s is beyond %.3g s, the longest stable step of the loaded contacts (%d contacts, "
        "the largest of %.3g N); a step of %.2g s would do",
        part, part / found.share, count, largest, recommended_share * part / found.share);
    return text;
}

}  // namespace grainsweep::dem
