#include "solver/dem/fast/scale.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

namespace grainsweep::dem::fast {

namespace {

using std::numbers::pi;

[[noreturn]] void refuse(const std::string& sentence) {
    throw std::invalid_argument(sentence);
}

void require_positive(double value, const char* what) {
    if (!(value > 0) || !std::isfinite(value))
        refuse(std::string(what) + " must be positive, not " + std::to_string(value));
}

/// Of a setup without spheres: small beside its domain, so that nothing is refused that would have no effect.
double largest_radius(const Setup& setup) {
    double radius = 0;
    for (const Sphere& s : setup.spheres) radius = std::max(radius, s.radius);
    if (radius > 0) return radius;
    double span = std::numeric_limits<double>::infinity();
    for (std::size_t a = 0; a < 3; ++a) span = std::min(span, setup.domain.high[a] - setup.domain.low[a]);
    return span > 0 && std::isfinite(span) ? 0.01 * span : 1;
}

void check(const Setup& setup) {
    const Material& m = setup.material;
    require_positive(setup.time_step, "time_step");
    require_positive(m.youngs_modulus, "youngs_modulus");
    require_positive(m.density, "density");
    if (!(m.poisson_ratio > -1 && m.poisson_ratio <= 0.5)) refuse("poisson_ratio must lie in (-1, 0.5]");
    if (!(m.restitution > 0 && m.restitution <= 1)) refuse("restitution must lie in (0, 1]");
    if (!(m.friction >= 0) || !(m.cohesion >= 0)) refuse("friction and cohesion must not be negative");
    if (!(m.rolling_friction >= 0 && m.rolling_friction <= 1)) refuse("rolling_friction must lie in [0, 1]");
    if (!(m.rolling_damping >= 0 && m.rolling_damping <= 1)) refuse("rolling_damping must lie in [0, 1]");
    for (std::size_t i = 0; i < setup.spheres.size(); ++i) {
        const Sphere& s = setup.spheres[i];
        bool finite = std::isfinite(s.radius) && s.radius > 0;
        for (std::size_t a = 0; a < 3; ++a)
            finite = finite && std::isfinite(s.position[a]) && std::isfinite(s.velocity[a]) &&
                     std::isfinite(s.angular_velocity[a]);
        if (!finite)
            refuse("sphere " + std::to_string(i) + " has a radius that is not positive or a state that is not finite");
    }
    const double diameter = 2 * largest_radius(setup);
    for (std::size_t a = 0; a < 3; ++a) {
        const double span = setup.domain.high[a] - setup.domain.low[a];
        if (!(span > 0) || !std::isfinite(span)) refuse("the domain's high must exceed its low on every axis");
        if (setup.domain.periodic[a] && span < 2.02 * diameter)
            refuse("a periodic domain must be at least 2.02 largest diameters long, axis " + std::to_string(a) +
                   " is not");
    }
}

}  // namespace

Scale make_scale(const Setup& setup) {
    check(setup);
    const double radius = largest_radius(setup);
    Scale s;
    s.length = 2 * radius;
    s.time = setup.time_step;
    s.mass = 4.0 / 3 * pi * radius * radius * radius * setup.material.density;
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

Constants make_constants(const Setup& setup, const Scale& scale) {
    const Material& m = setup.material;
    const double nu = m.poisson_ratio;
    const double stress = scale.mass / (scale.length * scale.time * scale.time);
    const double young = m.youngs_modulus / (2 * (1 - nu * nu)) / stress;
    const double shear = m.youngs_modulus / (4 * (2 - nu) * (1 + nu)) / stress;
    const double log_e = std::log(m.restitution);
    const double beta = log_e / std::sqrt(log_e * log_e + pi * pi);
    const auto f = [](double x) { return static_cast<float>(x); };

    Constants c{};
    for (int a = 0; a < 3; ++a) {
        const auto axis = static_cast<std::size_t>(a);
        c.unit[a] = scale.unit[axis] / scale.length;
        c.unit_single[a] = f(c.unit[a]);
        c.inverse_unit[a] = f(1 / c.unit[a]);
        c.gravity[a] = gravity_in_steps(setup.gravity[axis], scale);
    }
    c.radius = 0.5F;
    c.reach_squared = 1;
    c.candidate_squared = 1 + 4e-6F;
    c.normal = f(4.0 / 3 * young);
    c.tangential = f(8 * shear);
    const double damping = -2 * std::sqrt(5.0 / 6) * beta * std::sqrt(2 * young);
    c.damping = f(damping);
    // Without friction a spring that is not displaced yet would count as sticking, with a dashpot.
    c.damping_ratio = m.friction > 0 ? f(std::sqrt(8 * shear / (2 * young))) : 0.0F;
    c.friction = f(m.friction);
    c.root_radius = 0.5F;
    c.inverse_mass = 1;
    c.damping_pair = f(damping * std::sqrt(0.5));
    c.damping_frozen = f(damping);
    c.rotation = make_needs(setup).unequal ? 2.5F : 10.0F;
    const double neck = m.cohesion / stress;
    switch (m.cohesion_area) {
        case CohesionArea::sjkr:
            c.neck_lens = f(neck * pi / 4);
            c.wall_linear = f(neck * 2 * pi);
            c.wall_square = f(-neck * pi);
            break;
        case CohesionArea::sjkr2:
            c.neck_linear = f(neck * 4 * pi);
            c.wall_linear = f(neck * 2 * pi);
            break;
        case CohesionArea::paper:
            c.neck_linear = c.wall_linear = f(neck * pi / 2);
            c.neck_square = c.wall_square = f(-neck * pi / 4);
            break;
    }
    c.rolling = f(2.25 * m.rolling_friction * m.rolling_friction * 4.0 / 3 * young);
    c.rolling_friction = f(m.rolling_friction);
    c.rolling_damping = f(2 * m.rolling_damping * std::sqrt(1.4));
    c.net_limit = m.friction_limit == FrictionLimit::net ? 1.0F : 0.0F;
    return c;
}

Needs make_needs(const Setup& setup, bool resting) {
    Needs n{};
    n.resting = resting;
    for (const Sphere& s : setup.spheres) {
        n.unequal = n.unequal || s.radius != setup.spheres.front().radius;
        n.frozen = n.frozen || !s.mobile;
    }
    const Material& m = setup.material;
    n.friction = m.friction > 0;
    n.cohesion = m.cohesion == 0 ? Needs::Cohesion::none
                 : m.cohesion_area == CohesionArea::sjkr && m.friction_limit == FrictionLimit::contact
                     ? Needs::Cohesion::lens
                     : Needs::Cohesion::general;
    n.rolling = m.rolling_friction > 0;
    // the general kernel computes with each particle's own radius
    if (n.rolling || n.cohesion == Needs::Cohesion::general || (!n.friction && n.cohesion != Needs::Cohesion::none))
        n.unequal = true;
    return n;
}

}  // namespace grainsweep::dem::fast
