#include "solver/dem/fast/scale.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "solver/dem/laws/any_contact.hpp"

namespace grainsweep::dem::fast {

namespace {

using std::numbers::pi;

/// Of a setup without spheres: small beside its domain, so that nothing is refused that would have no effect.
double largest_radius(const Setup& setup) {
    if (const double radius = radii_of(setup).largest; radius > 0) return radius;
    double span = std::numeric_limits<double>::infinity();
    for (std::size_t a = 0; a < 3; ++a) span = std::min(span, setup.domain.length(a));
    return span > 0 && std::isfinite(span) ? 0.01 * span : 1;
}

}  // namespace

double reference_density(const Setup& setup) {
    return setup.kinds.densities.empty() ? setup.material.density : setup.kinds.densities.front();
}

Scale make_scale(const Setup& setup) {
    const double radius = largest_radius(setup);
    Scale s;
    s.length = 2 * radius;
    s.time = setup.time_step;
    s.mass = 4.0 / 3 * pi * radius * radius * radius * reference_density(setup);
    for (std::size_t a = 0; a < 3; ++a) {
        const double low = setup.domain.low[a], high = setup.domain.high[a];
        s.centre[a] = 0.5 * (low + high);
        // an open axis fills less than half the range: nothing outside it can seem near, and offsets never overflow
        const double range = setup.domain.periodic[a] ? high - low : 2.05 * (high - low) + 16 * s.length;
        s.unit[a] = range / 4294967296.0;
    }
    return s;
}

float gravity_in_steps(double acceleration, const Scale& scale) {
    return static_cast<float>(acceleration * scale.time * scale.time / scale.length);
}

double unit_of(const Dimension& d, const Scale& scale) {
    return std::pow(scale.length, d.length) * std::pow(scale.mass, d.mass) * std::pow(scale.time, d.time) *
           std::pow(inertia_about_contact, d.inertia);
}

void write_law_constants(std::int32_t combination, const Material& material, const Scale& scale, double* into) {
    std::ranges::transform(constants_of(combination, material), into,
                           [&](const Quantity& q) { return q.value / unit_of(q.dimension, scale); });
}

Constants make_constants(const Setup& setup, const Scale& scale, const Needs& needs) {
    Constants c{};
    for (int a = 0; a < 3; ++a) {
        const auto axis = static_cast<std::size_t>(a);
        c.unit[a] = scale.unit[axis] / scale.length;
        c.unit_single[a] = static_cast<float>(c.unit[a]);
        c.inverse_unit[a] = static_cast<float>(1 / c.unit[a]);
        c.gravity[a] = gravity_in_steps(setup.gravity[axis], scale);
    }
    c.radius = 0.5F;
    c.reach_squared = 1;
    c.candidate_squared = 1 + 4e-6F;
    for (const Material& m : materials_of(setup)) {
        const auto contact = make_contact(needs.combination, m);
        c.beyond = std::max(c.beyond, static_cast<float>(contact->beyond(0.25 * scale.length) / scale.length));
        c.beyond_wall = std::max(c.beyond_wall, static_cast<float>(contact->beyond(0.5 * scale.length) / scale.length));
    }
    c.root_radius = 0.5F;
    c.rotation = needs.unequal ? 2.5F : 10.0F;
    write_law_constants(needs.combination, ContactTable(setup).pairs().front(), scale, c.laws);
    return c;
}

Needs make_needs(const Setup& setup, bool resting) {
    Needs n{};
    n.resting = resting;
    n.unequal = !equally_dense(setup) || radii_of(setup).differ();
    n.clumps = !setup.shapes.empty();
    for (const Sphere& s : setup.spheres) n.frozen = n.frozen || !s.mobile;
    n.combination = choose_combination(materials_of(setup), [&](const CombinationFacts& facts) {
        return !n.unequal || facts.columns != dem::Columns::equal;
    });
    n.several = ContactTable(setup).kinds() > 1;
    // kernels for any spheres compute with each particle's own radius
    n.unequal = n.unequal || facts_of(n.combination).columns == dem::Columns::any;
    n.skips = n.resting || n.clumps || (n.frozen && !n.unequal && facts_of(n.combination).spin);
    return n;
}

}  // namespace grainsweep::dem::fast
