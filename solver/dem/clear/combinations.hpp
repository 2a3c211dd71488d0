// The combinations of laws and columns worth compiling, and one general fallback.
#pragma once

#include "solver/dem/clear/checkpoint.hpp"
#include "solver/dem/clear/stepping.hpp"
#include "solver/dem/laws/cohesion.hpp"
#include "solver/dem/laws/hertz.hpp"
#include "solver/dem/laws/mindlin.hpp"
#include "solver/dem/laws/rolling.hpp"

namespace grainsweep::dem::clear {

inline constexpr Needs equal_spheres{};
inline constexpr Needs some_frozen{
    .spin = false, .tangential_history = false, .sizes = false, .frozen = true, .rolling_history = false};
inline constexpr Needs many_sizes{
    .spin = false, .tangential_history = false, .sizes = true, .frozen = true, .rolling_history = false};

using Frictionless = Contact<Hertz>;
using Frictional = Contact<Hertz, Mindlin>;
using FrictionalSjkr = Contact<Hertz, Mindlin, Cohesion<SjkrArea>>;
/// Any material: cohesion of any area, seen by friction or not, either of them possibly zero.
using AnyLaws = Contact<Hertz, Cohesion<ChosenArea>, Mindlin, Cohesion<ChosenArea>>;
/// The same with rolling resistance.
using AnyRollingLaws = Contact<Hertz, Cohesion<ChosenArea>, Mindlin, RollingResistance, Cohesion<ChosenArea>>;

extern template class ClearEngine<Frictionless, equal_spheres>;
extern template class ClearEngine<Frictional, equal_spheres>;
extern template class ClearEngine<FrictionalSjkr, equal_spheres>;
extern template class ClearEngine<Frictional, some_frozen>;
extern template class ClearEngine<FrictionalSjkr, some_frozen>;
extern template class ClearEngine<Frictional, many_sizes>;
extern template class ClearEngine<AnyLaws, many_sizes>;
extern template class ClearEngine<AnyRollingLaws, many_sizes>;

}  // namespace grainsweep::dem::clear
