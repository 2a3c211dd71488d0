#include "solver/machine/probe.hpp"

#include "solver/particles/size_distribution.hpp"

namespace grainsweep::machine {

double Frame::volume(std::size_t i) const {
    return particles::sphere_volume(2 * state.radius[i]);
}

double Frame::mass_of(std::size_t id) const {
    return density[id] * particles::sphere_volume(2 * radius[id]);
}

}  // namespace grainsweep::machine
