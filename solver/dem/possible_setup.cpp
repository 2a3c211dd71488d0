#include "solver/dem/kinds.hpp"
#include "solver/dem/shaking.hpp"
#include "solver/geometry/vector.hpp"
#include "solver/particles/neighbour_list.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace grainsweep::dem {
namespace {

void require(bool holds, const std::string& sentence) {
    if (!holds) throw std::invalid_argument(sentence);
}

constexpr const char* too_many = "there are more particles than can be numbered";

bool positive(double x) {
    return std::isfinite(x) && x > 0;
}
bool not_negative(double x) {
    return std::isfinite(x) && x >= 0;
}

/// Refuses a material whose attraction is impossible beside another material of the case.
void check_attraction(const Material& m, const Material& other) {
    for (const Attraction& one : attractions()) {
        for (const Field& of : one.members)
            require(of.bounds.contains(part(m, of)), std::string(of.name) + " lies outside of its bounds");
        if (const char* flaw = one.flaw == nullptr ? nullptr : one.flaw(m, other)) throw std::invalid_argument(flaw);
    }
    const Attraction& own = attraction_of(m);
    require(m.normal_law == NormalLaw::hertz || !own.needs_hertz || !(own.amount(m) > 0),
            std::string(own.word) + " needs the normal law hertz");
}

void check(const Material& m) {
    require(positive(m.youngs_modulus), "Young's modulus must be positive");
    require(m.poisson_ratio > -1 && m.poisson_ratio <= 0.5, "Poisson's ratio must lie in (-1, 0.5]");
    require(positive(m.density), "the density must be positive");
    require(m.restitution > 0 && m.restitution <= 1, "the restitution must lie in (0, 1]");
    require(not_negative(m.friction), "the friction must not be negative");
    check_attraction(m, m);
    // Beyond 1 the rolling spring would be stiffer than those the time step is judged by.
    if (m.partner) {
        require(positive(m.partner->youngs_modulus), "Young's modulus must be positive");
        require(m.partner->poisson_ratio > -1 && m.partner->poisson_ratio <= 0.5,
                "Poisson's ratio must lie in (-1, 0.5]");
    }
    require(m.rolling_friction >= 0 && m.rolling_friction <= 1, "the rolling friction must lie in [0, 1]");
    require(m.rolling_damping >= 0 && m.rolling_damping <= 1, "the rolling damping must lie in [0, 1]");
    if (m.normal_law == NormalLaw::hertz) return;
    require(positive(m.stiffness), "the stiffness of the linear law must be positive");
    require(m.tangential_ratio > 0 && m.tangential_ratio <= 1,
            "the tangential stiffness of the linear law over the normal one must lie in (0, 1]");
    require(!m.tangential_damping || not_negative(*m.tangential_damping),
            "the tangential damping must not be negative");
}

void check_kinds(const Setup& setup) {
    const auto& [densities, pairs] = setup.kinds;
    const std::size_t count = std::max<std::size_t>(densities.size(), 1);
    for_each_extreme_sphere(
        setup, [&](const Sphere& s) { require(s.kind < count, "a sphere is of a kind that there is not"); });
    if (densities.empty()) return require(pairs.empty(), "kinds of spheres need a density each");
    require(count <= materials_at_most, "there are at most eight kinds of spheres");
    require(pairs.size() == place_of_pair(count - 1, count - 1) + 1, "every pair of kinds needs a material");
    for (const double density : densities) require(positive(density), "the density must be positive");
    for (const Material& m : pairs) check(m);
    for (const Wall& wall : setup.walls)
        for (const Material& m : wall.materials) check(m);
    require(setup.frozen == Surface{}, "among several kinds frozen spheres are of a kind, and have no surface");
}

void check(const Sphere& s) {
    require(positive(s.radius), "every radius must be positive");
    require(geometry::finite(s.position) && geometry::finite(s.velocity) && geometry::finite(s.angular_velocity),
            "every particle must start with finite position and velocities");
    require(s.mobile || (s.velocity == Vec3{} && s.angular_velocity == Vec3{}), "a frozen particle cannot move");
}

void check_spheres(const Setup& setup) {
    require(setup.spheres.size() < particles::Neighbour::most_particles, too_many);
    for (const Sphere& s : setup.spheres) check(s);
    for (const ToCome& range : setup.to_come) {
        require(positive(range.smallest) && positive(range.largest), "every radius must be positive");
        require(range.smallest <= range.largest, "of spheres to come the smallest radius must not exceed the largest");
    }
    const double largest = radii_of(setup).largest;
    for (std::size_t k = 0; k < 3; ++k) {
        const double length = setup.domain.length(k);
        require(positive(length), "the domain must have a finite extent along every axis");
        // A particle must reach a partner through one image only.
        require(!setup.domain.periodic[k] || length > 4 * largest,
                "a period must be longer than two of the largest diameters");
    }
}

/// A particle must reach a partner across a bridge through one image only.
void check_bridges(const Setup& setup, const std::vector<Material>& materials) {
    const double largest = radii_of(setup).largest;
    double longest = 0;
    for (const Attraction& one : attractions())
        for (const Material& m : materials)
            if (one.gap != nullptr) longest = std::max(longest, one.gap(m, largest / 2));
    for (std::size_t k = 0; k < 3; ++k)
        require(!(longest > 0) || !setup.domain.periodic[k] || setup.domain.length(k) > 2.02 * (2 * largest + longest),
                "a period must be longer than two of the largest diameters and of the longest bridges");
}

void check(const BodyShape& shape) {
    require(shape.members.size() >= 2, "a clump has at least two spheres");
    for (const auto& member : shape.members)
        require(positive(member.radius) && geometry::finite(member.place),
                "the spheres of a clump must have positive radii and finite places");
    require(positive(shape.mass), "the mass of a clump must be positive");
    const auto& inertia = shape.inertia;
    const double sum = inertia[0] + inertia[1] + inertia[2];
    for (const double moment : inertia)
        require(positive(moment) && moment <= (1 + 1e-9) * sum / 2,
                "the moments of inertia of a clump must be positive, and none larger than the sum of the others");
}

/// Clumps must not resist rolling: their shapes do.
void check_rolling(const Setup& setup) {
    const ContactTable table(setup);
    std::vector<bool> of_clumps(table.kinds(), false);
    for (const Body& body : setup.bodies) of_clumps[table.kind_of(setup.spheres[body.first])] = true;
    const auto check_contact = [](const Material& m) {
        require(m.rolling_friction == 0,
                "clumps have no rolling friction: their shape resists rolling; set it to 0 in their contacts");
    };
    for (std::size_t a = 0; a < table.kinds(); ++a) {
        if (!of_clumps[a]) continue;
        for (std::size_t b = 0; b < table.kinds(); ++b) check_contact(table.pairs()[place_of_pair(a, b)]);
        for (const Wall& wall : setup.walls)
            if (wall.touches(a)) check_contact(table.at_wall(wall, a));
    }
}

}  // namespace

void require_possible(std::span<const Body> bodies, const Setup& setup, std::span<const Sphere> spheres) {
    std::vector<bool> taken(spheres.size(), false);
    for (const Body& body : bodies) {
        require(body.shape < setup.shapes.size(), "a clump is of a shape that there is not");
        const BodyShape& shape = setup.shapes[body.shape];
        require(positive(body.scale), "the scale of a clump must be positive");
        require(geometry::finite(body.position) && geometry::finite(body.velocity) &&
                    geometry::finite(body.angular_velocity),
                "every clump must start with finite position and velocities");
        const double length = geometry::magnitude(body.orientation);
        require(std::abs(length - 1) < 1e-6, "the orientation of a clump must be a quaternion of unit length");
        require(body.first + shape.members.size() <= spheres.size(), "a clump has fewer spheres than its shape");
        const double reach = body.scale * reach_of(shape);
        for (std::size_t k = 0; k < shape.members.size(); ++k) {
            const std::size_t i = body.first + k;
            require(!taken[i], "a sphere belongs to one clump only");
            taken[i] = true;
            require(spheres[i].mobile && spheres[i].kind == spheres[body.first].kind &&
                        std::abs(spheres[i].radius - body.scale * shape.members[k].radius) <= 1e-9 * spheres[i].radius,
                    "the spheres of a clump are mobile, of one kind, and have the radii of its shape");
        }
        for (std::size_t k = 0; k < 3; ++k)
            require(!setup.domain.periodic[k] || setup.domain.length(k) > 4 * reach,
                    "a period must be longer than two of the largest clumps");
    }
}

void require_possible(const Setup& setup) {
    check(setup.material);
    check_kinds(setup);
    check_spheres(setup);
    for (const BodyShape& shape : setup.shapes) check(shape);
    require_possible(setup.bodies, setup, setup.spheres);
    check_rolling(setup);
    const std::string of_frozen = flaw(setup.frozen, "frozen spheres");
    require(of_frozen.empty(), of_frozen);
    const std::vector<Material> all = materials_of(setup);
    for (const Material& m : all) {
        require(m.normal_law == all.front().normal_law, "all contacts of a case must have the same normal law");
        check_attraction(m, all.front());
    }
    check_bridges(setup, all);
    require(positive(setup.time_step), "the time step must be positive");
    require(geometry::finite(setup.gravity), "gravity must be finite");
    require(geometry::finite(setup.shaking.amplitude) && not_negative(setup.shaking.frequency),
            "the amplitude and frequency of shaking must be finite");
    require(setup.shaking.frequency * setup.time_step <= 0.05, "a period of shaking must last at least twenty steps");
}

void require_announced(const std::vector<ToCome>& to_come, std::span<const Sphere> spheres, std::size_t given) {
    require(given + spheres.size() < particles::Neighbour::most_particles, too_many);
    for (const Sphere& s : spheres) {
        check(s);
        require(s.mobile, "a sphere that is added while a case runs must be mobile");
        require(std::ranges::any_of(to_come,
                                    [&](const ToCome& range) {
                                        return range.kind == s.kind && range.smallest <= s.radius &&
                                               s.radius <= range.largest;
                                    }),
                "a sphere that is added must be of a kind and radius that the setup announced");
    }
}

void require_possible(const Setup& setup, const Method& method) {
    require(not_negative(method.skin), "the skin must not be negative");
    require(not_negative(method.rest_speed), "the rest speed must not be negative");
    if (method.rest_speed > 0) {
        require(setup.shapes.empty(), "clumps are always advanced: no rest speed");
        require(is_still(setup.shaking), "powder in a vessel that is shaken never rests: no rest speed");
        require(geometry::norm(setup.gravity) > 0,
                "a rest speed needs gravity: net forces are compared with the weight");
        for (const Wall& wall : setup.walls)
            require(std::ranges::all_of(wall.motions, geometry::is_still),
                    "powder among moving walls has no rest speed");
    }
    if (method.skin > 0) {
        const double largest = radii_of(setup).largest;
        for (std::size_t k = 0; k < 3; ++k)
            require(!setup.domain.periodic[k] || setup.domain.length(k) > 2 * (2 * largest + method.skin),
                    "a period must be longer than twice the largest diameter plus the skin");
    }
}

}  // namespace grainsweep::dem
