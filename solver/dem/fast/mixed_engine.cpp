#include "solver/dem/fast/mixed_engine.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "solver/dem/fast/mixed_stepping.hpp"
#include "solver/dem/fast/residual.hpp"
#include "solver/dem/shaking.hpp"

namespace grainsweep::dem::fast {

namespace {

/// Beyond these records no longer fit the nearer caches and are fetched ahead of their use; below, asking costs more
/// than it gains.
constexpr std::size_t many_particles = 40000;
/// Likewise, where there are clumps: their members are not fetched one after the other as spheres that are advanced.
constexpr std::size_t many_members = 6000;
/// Beyond these a step's histories have left the last cache before the next step reads them.
constexpr std::size_t very_many_particles = 120000;

std::array<SoundOverlaps, most_halvings + 1> resolved_in_parts(Setup setup) {
    std::array<SoundOverlaps, most_halvings + 1> all;
    for (SoundOverlaps& resolved : all) {
        resolved = resolved_overlaps(setup);
        setup.time_step /= 2;
    }
    return all;
}

}  // namespace

MixedEngine::MixedEngine(const Setup& setup, Method::Path path, double skin, double rest_speed, Threads threads)
    : space_{setup.domain, make_scale(setup), 0.3F},
      gravity_(setup.gravity),
      shaking_(setup.shaking),
      shaken_(!is_still(setup.shaking)),
      needs_(make_needs(setup, rest_speed > 0)),
      rest_speed_(rest_speed),
      kernels_(&kernels_of(path, needs_)),
      densities_(setup.kinds.densities),
      to_come_(setup.to_come),
      table_(setup),
      materials_(materials_of(setup)),
      walls_(setup.walls, setup.domain, space_.scale, needs_.combination, table_, materials_),
      contacts_differ_(contacts_differ(setup)),
      resolved_in_parts_(resolved_in_parts(setup)),
      resolved_(resolved_in_parts_.front()),
      sound_(contacts_differ_ ? deepest_overlaps(setup) : resolved_),
      watch_(setup, space_.scale),
      clumps_(setup.shapes),
      acceleration_(setup.gravity),
      resting_(setup, laws_, space_.scale, rest_speed),
      subdomains_(*kernels_, threads),
      threads_(threads),
      adapts_skin_(!(skin > 0)),
      control_(setup.step_share),
      time_step_(setup.time_step),
      spheres_at_start_(static_cast<std::int32_t>(setup.spheres.size())),
      crossings_(setup.counting, setup.domain) {
    if (densities_.empty()) densities_ = {setup.material.density};
    field_.constants = make_constants(setup, space_.scale, needs_);
    for (const Material& m : table_.pairs()) laws_.push_back(make_contact(needs_.combination, m));
    // A pair must not meet across both ends of a period. The reach of adhesion is within the shortest period allowed.
    const double apart = laws_.front()->traits().acts_apart ? static_cast<double>(field_.constants.beyond) : 0;
    for (std::size_t a = 0; a < 3; ++a)
        if (setup.domain.periodic[a]) {
            const double period = setup.domain.length(a) / space_.scale.length;
            largest_skin_ = std::min(largest_skin_, static_cast<float>(0.5 * period - 1 - apart));
        }
    if (skin > 0) space_.skin = static_cast<float>(skin / space_.scale.length);
    space_.skin = std::min(space_.skin, largest_skin_);
    write_pair_laws();
    start_constants_ = field_.constants;
    start_laws_ = constants_;
    columns_.histories = static_cast<std::int32_t>(laws_.front()->traits().memory.size());
    std::ranges::transform(laws_.front()->traits().memory, columns_.exchanged,
                           [](const MemoryKind& kind) { return static_cast<float>(kind.exchanged); });
    load(setup);
    touches_.begin(field_, columns_, walls_, space_.scale);
    restart_forces();
    set_limits();
}

void MixedEngine::write_pair_laws() {
    const std::size_t count = table_.kinds();
    constants_.resize(count * count * constants_at_most);
    for (std::size_t a = 0; a < count; ++a)
        for (std::size_t b = 0; b < count; ++b)
            write_law_constants(needs_.combination, table_.pairs()[place_of_pair(a, b)], space_.scale,
                                constants_.data() + (a * count + b) * constants_at_most);
    field_.kinds = static_cast<std::int32_t>(count);
    field_.laws_of_pairs = constants_.data();
}

float MixedEngine::single_radius(const Sphere& sphere) const {
    return static_cast<float>(needs_.unequal ? sphere.radius / space_.scale.length : 0.5);
}

/// Returns the density relative to the density of Scale::mass.
double MixedEngine::relative_density(const Sphere& sphere) const {
    return densities_[sphere.kind] / densities_.front();
}

void MixedEngine::load(const Setup& setup) {
    columns_.residuals_apart = needs_.unequal;
    field_.skips = needs_.skips ? 1 : 0;
    const bool all_periodic = setup.domain.periodic[0] && setup.domain.periodic[1] && setup.domain.periodic[2];
    box_includes_rest_ = !all_periodic || needs_.frozen || needs_.resting || crossings_.wanted();
    for_each_extreme_sphere(setup, [this](const Sphere& sphere) {
        smallest_diameter_ = std::min(smallest_diameter_, 2 * single_radius(sphere));
        lightest_ = std::max(lightest_, static_cast<float>(1 / relative_density(sphere)));
    });
    for (const Sphere& sphere : setup.spheres) kinds_.push_back(table_.kind_of(sphere));
    announced_.domain = setup.domain;
    announced_.shapes = setup.shapes;
    append(setup.spheres, setup.bodies, 0);
    map_clumps();
}

/// Changes no bit.
void MixedEngine::suit_caches() {
    field_.read_ahead = size() > (needs_.clumps ? many_members : many_particles) ? 1 : 0;
    field_.streams = size() > very_many_particles ? 1 : 0;
}

/// Behind the particles there are; `id`: of the first.
void MixedEngine::append(std::span<const Sphere> spheres, std::span<const Body> bodies, std::int32_t id) {
    auto i = static_cast<std::size_t>(field_.count);
    const std::size_t n = i + spheres.size();
    columns_.hold_particles(n, walls_.count());
    columns_.hold_lists(8 * n);
    columns_.hold_wall_contacts(n);
    columns_.bind(field_);
    field_.count = static_cast<std::int32_t>(n);
    suit_caches();
    const Scale& s = space_.scale;
    const std::size_t begin = i;
    const std::size_t earlier = clumps_.size();
    clumps_.append(bodies, static_cast<std::size_t>(id));
    for (const Sphere& sphere : spheres) {
        const auto k = static_cast<std::int32_t>(i);
        Record& r = columns_.records[i] = {};
        columns_.forces[i] = {};
        Residual residual{};
        const double radius = sphere.radius / s.length;
        r.radius = single_radius(sphere);
        if (needs_.unequal) {
            r.rest[3] = r.radius;
            residual.position[3] = static_cast<float>(radius - static_cast<double>(r.radius));
        }
        r.inverse_radius = 1 / r.radius;
        r.inverse_mass =
            sphere.mobile ? static_cast<float>(1 / (8 * radius * radius * radius * relative_density(sphere))) : 0.0F;
        columns_.kind[i] = table_.kind_of(sphere);
        columns_.id[i++] = id++;
        for (int a = 0; a < 3; ++a) {
            const auto axis = static_cast<std::size_t>(a);
            double units = s.units(sphere.position[axis], axis);
            if (space_.domain.periodic[axis])
                units -= 4294967296.0 * std::nearbyint(units / 4294967296.0);
            else
                units = std::clamp(units, -2147483000.0, 2147483000.0);  // outside: taken out by the first rebuild
            const double whole = std::nearbyint(units);
            r.position[a] = static_cast<std::int32_t>(static_cast<std::uint32_t>(static_cast<std::int64_t>(whole)));
            residual.position[a] = static_cast<float>(units - whole);
            if (!sphere.mobile) continue;
            const double velocity = sphere.velocity[axis] / s.speed();
            r.velocity[a] = static_cast<float>(velocity);
            residual.velocity[a] = static_cast<float>(velocity - static_cast<double>(r.velocity[a]));
            set_spin(field_, k, a, static_cast<float>(sphere.angular_velocity[axis] * s.time));
        }
        leave_over(field_, k, residual);
    }
    for (std::size_t b = 0; b < bodies.size(); ++b)
        for (std::size_t k = 0; k < clumps_.shape_of(earlier + b).members.size(); ++k) {
            const std::size_t member = begin + bodies[b].first + k;
            columns_.records[member].inverse_mass = static_cast<float>(s.mass / clumps_.mass[earlier + b]);
            if (needs_.unequal) columns_.residuals[member].position[3] = 0;
        }
    place_fillers(field_);
}

std::unique_ptr<Engine> make_mixed_engine(const Setup& setup, Method::Path path, double skin, double rest_speed,
                                          Threads threads) {
    require_possible(setup);
    const double diameter = 2 * radii_of(setup).largest;
    for (std::size_t a = 0; a < 3; ++a)
        if (setup.domain.periodic[a] && setup.domain.length(a) < 2.02 * diameter)
            throw std::invalid_argument("a period must be at least 2.02 of the largest diameters long");
    if (path == Method::Path::best) path = best_path();
    if (!supports(path)) throw std::invalid_argument("this processor lacks the instructions of the path asked for");
    return std::make_unique<MixedEngine>(setup, path, skin, rest_speed, threads);
}

}  // namespace grainsweep::dem::fast
