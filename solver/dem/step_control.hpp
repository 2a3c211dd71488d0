// Control of the time step by the network of contacts (network.hpp).
//
// A time step of the case is computed in 1, 2, 4 ... equal parts. At a check the engine compares the length of a part
// with the longest stable step. Either the engine halves the parts as long as they exceed a share of it, and doubles
// them again once they are well below; or the step is fixed, and a step beyond the limit is a fault. All times of the
// case stay multiples of its time step. The number of parts is state: it depends on the steps made, not on threads,
// slices or checkpoints.
//
// Checks are made every check_interval steps, and early_interval steps after the largest overlap has grown: the
// frequency of contacts grows with the sixth root of the load (Hertz). Where the bound of the network exceeds the
// share, further looks follow, early_interval steps apart, at the contacts that last: an impact is over by then, and is
// too short for an oscillation to grow. Only a share that is exceeded at several looks in a row counts.
#pragma once

#include "solver/dem/engine.hpp"
#include "solver/dem/network.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace grainsweep::dem {

/// Largest number of halvings of a time step: 64 parts.
inline constexpr int most_halvings = 6;

class StepControl {
public:
    /// `share`: largest share of the longest stable step, in (0, 1]; empty: the step is fixed.
    explicit StepControl(std::optional<double> share) : follows_(share.has_value()), allowed_(share.value_or(1)) {}

    [[nodiscard]] std::int64_t parts() const { return std::int64_t{1} << state_.halvings; }
    /// Returns the largest number of parts so far.
    [[nodiscard]] std::int64_t most_parts() const { return std::int64_t{1} << state_.most; }
    /// Returns whether the next step has another number of parts, and sets it.
    [[nodiscard]] bool take_parts();
    /// Returns whether a check is due after `steps` steps, the last of which had this largest overlap, divided by the
    /// diameter. `spheres`: few are checked more often.
    [[nodiscard]] bool due(std::int64_t steps, double overlap, std::size_t spheres) const;
    /// Returns whether the next look is at contacts that have lasted since the one before; it needs their slides.
    [[nodiscard]] bool looks_again() const { return !seen_.empty(); }
    /// Looks at the network, for parts of `part` s; at a second look it has only lasting() contacts. Returns whether
    /// their share must be computed.
    [[nodiscard]] bool look(const Network& network, double part, double overlap);
    /// Returns the keys of the contacts of the last look that have lasted since the first one; empty: no second look is
    /// due.
    [[nodiscard]] const std::vector<std::uint64_t>& lasting() const { return seen_; }
    /// Decides on the parts of the next steps by the share of the present parts. Returns whether these are beyond the
    /// limit and may not be halved.
    [[nodiscard]] bool judge(const StepShare& found, const Network& lasting);

    /// State of a checkpoint.
    struct State {
        std::int32_t halvings = 0, wanted = 0, most = 0;
        std::int32_t calm = 0;     ///< checks in a row at which fewer parts would do
        std::int32_t over = 0;     ///< looks in a row at which the share of lasting contacts was exceeded
        std::int32_t guesses = 0;  ///< checks since the share was last computed
        double overlap = 0;        ///< at the last check
        double bound = 0;          ///< of all contacts at the first look before share
        double share = 0;          ///< last one of lasting contacts
    };
    [[nodiscard]] const State& state() const { return state_; }
    /// Sets the state of a checkpoint, with lasting(); returns whether it is possible.
    [[nodiscard]] bool restore(const State& state, std::vector<std::uint64_t> lasting);

private:
    void rest(double share);
    void double_if_calm(double share);

    bool follows_;
    double allowed_;  ///< largest share
    State state_;
    std::vector<std::uint64_t> seen_;  ///< keys of the contacts of the last look that lasted since the first one
};

/// Returns the fault of a part of `part` s that is beyond the limit, for the sphere with this id and the present
/// contacts.
[[nodiscard]] std::string flaw_of_step(const StepShare& found, double part, std::span<const ContactForce> contacts,
                                       std::int32_t id);

}  // namespace grainsweep::dem
