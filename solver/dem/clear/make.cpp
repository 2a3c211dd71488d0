#include "solver/dem/clear/make.hpp"

#include "solver/dem/clear/combinations.hpp"

#include <algorithm>

namespace grainsweep::dem::clear {
namespace {

template <Needs case_needs, class Laws>
std::unique_ptr<Engine> make(const Setup& setup, const Method& method, Laws (*make_laws)(const Material&, double)) {
    return std::make_unique<ClearEngine<Laws, case_needs>>(setup, method, make_laws);
}

Frictionless frictionless(const Material& m, double) {
    return {{hertz(m)}};
}

Frictional frictional(const Material& m, double time_step) {
    return {{hertz(m), mindlin(m, time_step)}};
}

FrictionalSjkr frictional_sjkr(const Material& m, double time_step) {
    return {{hertz(m), mindlin(m, time_step), {m.cohesion, {}}}};
}

/// Cohesion stands before friction where friction sees it, behind it otherwise; the other one is zero.
struct Necks {
    Cohesion<ChosenArea> before, after;
};
Necks necks(const Material& m) {
    const bool friction_sees_it = m.friction_limit == FrictionLimit::net;
    return {{friction_sees_it ? m.cohesion : 0.0, {m.cohesion_area}},
            {friction_sees_it ? 0.0 : m.cohesion, {m.cohesion_area}}};
}

AnyLaws any_laws(const Material& m, double time_step) {
    const auto [before, after] = necks(m);
    return {{hertz(m), before, mindlin(m, time_step), after}};
}

AnyRollingLaws any_rolling_laws(const Material& m, double time_step) {
    const auto [before, after] = necks(m);
    return {{hertz(m), before, mindlin(m, time_step), rolling_resistance(m, time_step), after}};
}

}  // namespace

std::unique_ptr<Engine> make_clear_engine(const Setup& setup, const Method& method) {
    const Material& m = setup.material;
    const auto& spheres = setup.spheres;
    const bool frozen = std::ranges::any_of(spheres, [](const Sphere& s) { return !s.mobile; });
    const bool sizes = std::ranges::any_of(spheres, [&](const Sphere& s) { return s.radius != spheres[0].radius; });
    const auto somewhere = [&](auto part) {  // in the powder or at a wall
        return part(m) > 0 ||
               std::ranges::any_of(setup.walls, [&](const Wall& w) { return part(at_surface(m, w.surface)) > 0; });
    };
    const bool friction = somewhere([](const Material& of) { return of.friction; });
    const bool rolling = somewhere([](const Material& of) { return of.rolling_friction; });
    const bool cohesion = m.cohesion > 0;
    const bool plain_sjkr =
        cohesion && m.cohesion_area == CohesionArea::sjkr && m.friction_limit == FrictionLimit::contact;

    if (rolling) return make<many_sizes>(setup, method, any_rolling_laws);
    if (!sizes && !frozen) {
        if (!friction && !cohesion) return make<equal_spheres>(setup, method, frictionless);
        if (friction && !cohesion) return make<equal_spheres>(setup, method, frictional);
        if (friction && plain_sjkr) return make<equal_spheres>(setup, method, frictional_sjkr);
    }
    if (!sizes && friction && !cohesion) return make<some_frozen>(setup, method, frictional);
    if (!sizes && friction && plain_sjkr) return make<some_frozen>(setup, method, frictional_sjkr);
    if (friction && !cohesion) return make<many_sizes>(setup, method, frictional);
    return make<many_sizes>(setup, method, any_laws);
}

}  // namespace grainsweep::dem::clear
