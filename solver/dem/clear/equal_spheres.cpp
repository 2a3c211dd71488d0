#include "solver/dem/clear/combinations.hpp"

namespace grainsweep::dem::clear {

template class ClearEngine<Frictionless, equal_spheres>;
template class ClearEngine<Frictional, equal_spheres>;
template class ClearEngine<FrictionalSjkr, equal_spheres>;

}  // namespace grainsweep::dem::clear
