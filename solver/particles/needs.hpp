// What a calculation must know of each particle. Laws and cases declare it; columns follow from it.
#pragma once

namespace grainsweep::particles {

struct Needs {
    bool spin = false;    ///< angular velocity and torque
    bool sizes = false;   ///< a radius and an inverse mass per particle; otherwise one for all
    bool frozen = false;  ///< some particles never move
};

}  // namespace grainsweep::particles
