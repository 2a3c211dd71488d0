// What a calculation must know of each particle. Laws and cases declare it; columns follow from it.
#pragma once

namespace grainsweep::particles {

struct Needs {
    bool spin = false;                ///< angular velocity and torque
    bool tangential_history = false;  ///< a tangential displacement per contact
    bool sizes = false;               ///< a radius and an inverse mass per particle; otherwise one for all
    bool frozen = false;              ///< some particles never move
    bool rolling_history = false;     ///< a rolling moment per contact, beside the tangential displacement
};

[[nodiscard]] constexpr Needs operator|(const Needs& a, const Needs& b) {
    return {a.spin || b.spin, a.tangential_history || b.tangential_history, a.sizes || b.sizes, a.frozen || b.frozen,
            a.rolling_history || b.rolling_history};
}

}  // namespace grainsweep::particles
