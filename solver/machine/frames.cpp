#include "solver/machine/frames.hpp"

#include "solver/dem/walls/moving_wall.hpp"
#include "solver/machine/setup.hpp"
#include "solver/scenes/kit/sentence.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace grainsweep::machine {
namespace {

constexpr std::int64_t few = 4;  // phases of a motion; a mean over more of them has small errors

/// Returns the periods of a wall's motions, s. A rotation counts if it moves the surface; a vibration also along it,
/// because it drags the powder.
std::vector<double> periods_of(const MachineWall& wall, std::size_t phase) {
    std::vector<double> periods;
    for (const WallMotion& moved : wall.motions) {
        if (moved.phases && (phase < moved.phases->first || phase > moved.phases->last)) continue;
        if (const auto* vibration = std::get_if<geometry::Vibration>(&moved.motion);
            vibration != nullptr && vibration->frequency > 0)
            periods.push_back(1 / vibration->frequency);
        if (const auto* rotation = std::get_if<geometry::Rotation>(&moved.motion);
            rotation != nullptr && rotation->speed != 0 &&
            !dem::displacing(wall.shape, std::vector{moved.motion}).empty())
            periods.push_back(2 * std::numbers::pi / std::abs(rotation->speed));
    }
    return periods;
}

}  // namespace

std::optional<InStep> in_step(const Spec& spec, std::size_t phase) {
    const auto frames = static_cast<double>(spec.phases[phase].frames);
    const double interval = spec.phases[phase].duration / frames;
    for (const MachineWall& wall : spec.walls) {
        if (!holds(wall.during, phase)) continue;
        for (const double period : periods_of(wall, phase))
            for (std::int64_t q = 1; q <= few; ++q) {
                const auto parts = static_cast<double>(q);
                const double turns = std::nearbyint(parts * interval / period);
                // In all frames the phases seen move on by less than one of the q; by a whole one they meet all.
                if (turns > 0 && std::abs(interval / period - turns / parts) * frames * parts < 1 - 1e-6)
                    return InStep{wall.name, period, q};
            }
    }
    return std::nullopt;
}

std::string flaw_of_frames(const Spec& spec) {
    // Fewer frames see few phases of any motion, and their mean has no error.
    constexpr std::int64_t fewest = 10;
    for (std::size_t p = 0; p < spec.phases.size(); ++p) {
        const Phase& phase = spec.phases[p];
        const bool averaged = std::ranges::any_of(spec.measures, [&](const Measure& measure) {
            return holds(measure.during, p) && !is_integrated(measure) &&
                   (measure.reduction == "mean" || measure.reduction == "sd" || measure.reduction == "profile");
        });
        if (!averaged || !phase.frames_given || phase.frames < fewest) continue;
        if (const auto step = in_step(spec, p))
            return phase.name +
                   kit::sentence(": its %.0f frames see the motion of ", static_cast<double>(phase.frames)) +
                   step->wall +
                   kit::sentence(
                       ", whose period is %.4g s, at %.0f of its phases, and means over them are wrong: "
                       "leave \"frames\" out, or give a number without a common divisor",
                       step->period, static_cast<double>(step->phases));
    }
    return {};
}

double share_of_frame(std::int64_t frame, std::int64_t frames, bool scattered) {
    double place = static_cast<double>(frame);
    if (scattered && frame > 0 && frame < frames) {
        const double step = place * (std::numbers::phi - 1);
        place += step - std::floor(step) - 0.5;
    }
    return place / static_cast<double>(frames);
}

}  // namespace grainsweep::machine
