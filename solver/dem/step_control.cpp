#include "solver/dem/step_control.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace grainsweep::dem {

namespace {

constexpr std::int64_t check_interval = 1024, check_interval_of_few = 128, early_interval = 32;
constexpr std::size_t few_spheres = 100;
constexpr double grown_overlap = 2;  ///< divided by that at the last check: an early check
constexpr double same_bound = 0.1;   ///< relative change of the bound within which the last share is scaled
constexpr int most_guesses = 16;     ///< checks with a scaled share in a row
/// Looks in a row at which the share is exceeded: before steps are halved, and before a fixed step is reported, which
/// may be somewhat too long while powder falls into place.
constexpr int looks_to_halve = 3, looks_to_report = 8;
constexpr double far_beyond = 1.2;  ///< share of a fixed step that is reported as early
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
    return steps % early_interval == 0 && (!seen_.empty() || overlap > grown_overlap * state_.overlap);
}

bool StepControl::look(const Network& network, double part, double overlap) {
    state_.overlap = overlap;
    const bool again = looks_again();
    const double bound = network.bound(part);
    const double most = std::sqrt(bound) / 2;  // without dampers the eigenvalue is 4 share^2, with dampers it is larger
    if (most <= (state_.halvings > 0 ? well_below * allowed_ / 2 : allowed_)) {
        rest(most);
        return false;
    }
    if (again) return true;
    if (state_.guesses < most_guesses && std::abs(bound - state_.bound) <= same_bound * state_.bound) {
        const double guess = state_.share * std::sqrt(bound / state_.bound);
        if (guess <= allowed_) {
            ++state_.guesses;
            double_if_calm(guess);
            return false;
        }
    }
    state_.bound = bound;
    seen_ = network.keys();
    return false;
}

/// Takes a share of lasting contacts that is allowed.
void StepControl::rest(double share) {
    state_.share = share;
    state_.guesses = 0;
    state_.over = 0;
    seen_.clear();
    double_if_calm(share);
}

void StepControl::double_if_calm(double share) {
    if (state_.halvings == 0 || 2 * share > well_below * allowed_) {
        state_.calm = 0;
    } else if (++state_.calm == calm_checks) {
        state_.calm = 0;
        state_.wanted = state_.halvings - 1;
    }
}

bool StepControl::judge(const StepShare& found, const Network& lasting) {
    if (!(found.share > allowed_)) {
        rest(found.share);
        return false;
    }
    const int needed = follows_ || found.share > far_beyond ? looks_to_halve : looks_to_report;
    if (++state_.over < needed) {
        seen_ = lasting.keys();
        return false;
    }
    state_.over = 0;
    seen_.clear();
    if (!follows_) return true;
    double share = found.share;
    for (; share > allowed_ && state_.wanted < most_halvings; share /= 2) ++state_.wanted;
    return !(share <= 1);
}

bool StepControl::restore(const State& state, std::vector<std::uint64_t> lasting) {
    const auto sound = [](std::int32_t x, std::int32_t most) { return x >= 0 && x <= most; };
    state_ = state;
    seen_ = std::move(lasting);
    return std::ranges::is_sorted(seen_) && sound(state.halvings, most_halvings) &&
           sound(state.wanted, most_halvings) && sound(state.most, most_halvings) && sound(state.calm, calm_checks) &&
           sound(state.guesses, most_guesses) && sound(state.over, looks_to_report) && std::isfinite(state.overlap) &&
           std::isfinite(state.bound) && std::isfinite(state.share) &&
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
