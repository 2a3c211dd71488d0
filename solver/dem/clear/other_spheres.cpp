#include "solver/dem/clear/combinations.hpp"

namespace grainsweep::dem::clear {

template class ClearEngine<Frictional, some_frozen>;
template class ClearEngine<FrictionalSjkr, some_frozen>;
template class ClearEngine<Frictional, many_sizes>;
template class ClearEngine<AnyLaws, many_sizes>;
template class ClearEngine<AnyRollingLaws, many_sizes>;

}  // namespace grainsweep::dem::clear
