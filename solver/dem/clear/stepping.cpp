// Time stepping of the clear engine and its lists.
#include "solver/dem/clear/engine.hpp"
#include "solver/dem/material.hpp"
#include "solver/dem/shaking.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_set>

namespace grainsweep::dem::clear {

using namespace geometry;

namespace {

/// Skin over the smallest diameter where the method leaves it open. A settling bed is fastest at 0.2 (76 ns per
/// particle and step, 83 at 0.5), a sweep at 0.5 (105 ns, 118 at 0.2); 0.3 is within 6 % of both.
constexpr double default_skin = 0.3;

/// Steps between two checks of the energy: often enough to name the time, rare enough to cost nothing.
constexpr std::int64_t energy_interval = 128;

/// Of a memory's components when its particles change places.
std::vector<double> factors_of_exchange(const AnyContact& laws) {
    std::vector<double> factors;
    for (const MemoryKind& kind : laws.traits().memory) factors.push_back(kind.exchanged);
    return factors;
}

}  // namespace

ClearEngine::ClearEngine(const Setup& setup, const Method& method, const AnyContact& laws, bool equal)
    : table_(setup),
      spins_(laws.traits().spin),
      rolls_(laws.traits().rolls),
      reaches_(laws.traits().reaches),
      remembers_separation_(laws.traits().remembers_separation),
      domain_(setup.domain),
      image_shifts_(domain_.image_shifts()),
      gravity_(setup.gravity),
      shaking_(setup.shaking),
      shaken_(!is_still(setup.shaking)),
      body_(setup.gravity),
      time_step_(setup.time_step),
      control_(setup.step_share),
      part_(setup.time_step),
      equal_(equal),
      radii_(radii_of(setup)),
      linear_(table_.pairs().front().normal_law == NormalLaw::linear),
      deepest_in_walls_(setup.deepest_in_walls),
      swing_factor_(normal_slope(table_.pairs().front()) * setup.time_step * setup.time_step),
      skin_(method.skin),
      densities_(setup.kinds.densities),
      to_come_(setup.to_come),
      spheres_at_start_(setup.spheres.size()),
      bodies_(setup.shapes),
      pairs_(factors_of_exchange(laws)),
      crossings_(setup.counting, domain_) {
    if (densities_.empty()) densities_ = {setup.material.density};
    announced_.domain = setup.domain;
    announced_.shapes = setup.shapes;
    append(setup.spheres, setup.bodies, 0);
    inverse_masses_.first = std::numeric_limits<double>::infinity();
    for_each_extreme_sphere(setup, [this](const Sphere& s) {
        inverse_masses_.first = std::min(inverse_masses_.first, inverse_mass_of(s));
        inverse_masses_.second = std::max(inverse_masses_.second, inverse_mass_of(s));
    });
    const auto [smallest, largest] = radii_;
    for (const Material& m : materials_of(setup)) {
        const auto contact = laws.of(m);
        beyond_pair_ = std::max(beyond_pair_, contact->beyond(largest / 2));
        beyond_wall_ = std::max(beyond_wall_, contact->beyond(largest));
    }
    for (const Material& m : table_.pairs()) {
        laws_.push_back(laws.of(m));
        stiffness_.push_back(normal_slope(m) / normal_slope(table_.pairs().front()));
    }
    mass_ = sphere_mass(largest, densities_.front());
    if (skin_ <= 0 && largest > 0) {
        skin_ = default_skin * 2 * smallest;
        // Two images of one particle must never reach the same partner.
        for (std::size_t k = 0; k < 3; ++k)
            if (domain_.periodic[k])
                skin_ = std::min(skin_, 0.999 * (domain_.length(k) / 2 - 2 * largest) - beyond_pair_);
    }
    walls_ = make_walls(setup.walls);
    rebuild();
    evaluate(false);
    set_speed_limit();
}

double ClearEngine::inverse_mass_of(const Sphere& s) const {
    return s.mobile ? 1 / sphere_mass(s.radius, densities_[s.kind]) : 0;
}

/// Behind the particles there are; `id`: of the first.
void ClearEngine::append(std::span<const Sphere> spheres, std::span<const Body> bodies, std::size_t id) {
    bodies_.append(bodies, id);
    std::size_t i = p_.size();
    p_.resize(i + spheres.size());
    for (const Sphere& s : spheres) {
        p_.id[i] = static_cast<std::int32_t>(id++);
        p_.position[i] = s.position;
        p_.velocity[i] = s.velocity;
        p_.angular_velocity[i] = s.angular_velocity;
        p_.radius[i] = s.radius;
        p_.inverse_mass[i] = inverse_mass_of(s);
        p_.kind[i] = table_.kind_of(s);
        ++i;
    }
    map_bodies();
}

/// Finds the members of all bodies among the spheres.
void ClearEngine::map_bodies() {
    if (!bodies_.map(p_.id, ids())) throw std::logic_error("a clump lacks a member");
    for (std::size_t b = 0; b < bodies_.size(); ++b)
        for (const std::uint32_t i : bodies_.members(b)) p_.inverse_mass[i] = 1 / bodies_.mass[b];
}

void ClearEngine::run(std::int64_t steps) {
    const std::int64_t end = work_.steps + steps;
    while (work_.steps < end && fault_.empty()) step();
}

/// Sets the length of a part by the number of parts.
void ClearEngine::use_parts() {
    part_ = time_step_ / static_cast<double>(control_.parts());
    swing_factor_ = normal_slope(table_.pairs().front()) * part_ * part_;
}

/// Advances by a part of a time step.
void ClearEngine::step() {
    if (parts_done_ == 0 && control_.take_parts()) use_parts();
    if (shaken_) work_of_shaking_ += part_ / 2 * dot(body_ - gravity_, momentum());
    kick_and_drift();
    const bool whole = ++parts_done_ == control_.parts();
    if (whole) {
        parts_done_ = 0;
        ++wall_steps_;
        ++work_.steps;
    }
    for (auto& contacts : walls_) {
        if (!contacts.wall.present()) continue;
        contacts.wall.drift(part_);
        contacts.wall.place(wall_time());
    }
    if (shaken_) shake();
    if (crossings_.wanted()) {
        const double parts = static_cast<double>(control_.parts());
        crossings_.follow(
            static_cast<double>(work_.steps) + static_cast<double>(parts_done_) / parts, 1 / parts,
            [this](std::size_t i) { return i < p_.size() ? p_.id[i] : bodies_.first[i - p_.size()]; },
            [this](std::size_t i) { return i < p_.size() ? p_.position[i] : bodies_.position[i - p_.size()]; });
    }
    if (list_is_stale()) {
        if (!sound()) return;
        rebuild();
    }
    evaluate(true);
    if (!fault_.empty()) return;  // before a force beyond its law moves anything
    kick();
    if (shaken_) work_of_shaking_ += part_ / 2 * dot(body_ - gravity_, momentum());
    work_.particle_steps += static_cast<double>(std::ranges::count_if(p_.inverse_mass, [](double m) { return m > 0; }));
    if (!whole) return;
    if (work_.steps % energy_interval == 0) check_energy();
    const double deepest = std::max(largest_overlap_, largest_wall_overlap_);
    if (control_.due(work_.steps, deepest, p_.size())) check_network();
}

/// Half a step of the free ones.
void ClearEngine::kick_walls() {
    for (auto& contacts : walls_)
        if (contacts.wall.free() && contacts.wall.present())
            contacts.wall.kick(contacts.load.force, contacts.load.torque, contacts.load_about, wall_time(), part_ / 2);
}

void ClearEngine::kick_and_drift() {
    kick_walls();
    const double half = part_ / 2;
    const double far2 = skin_ * skin_ / 4;
    bool displaced = displaced_;
    bodies_.kick_and_drift(part_, body_, p_);
    for (std::size_t b = 0; b < bodies_.size(); ++b)
        for (const std::uint32_t i : bodies_.members(b)) {
            const Vec3 moved = p_.position[i] - position_at_build_[i];
            displaced |= !(dot(moved, moved) <= far2);
        }
    for (std::size_t i = 0; i < p_.size(); ++i) {
        if (!mobile(i) || bodies_.is_member(i)) continue;
        const double inverse = inverse_mass(i);
        p_.velocity[i] += half * (inverse * p_.force[i] + body_);
        p_.position[i] += part_ * p_.velocity[i];
        p_.angular_velocity[i] += (half * inverse / (0.4 * radius(i) * radius(i))) * p_.torque[i];
        const Vec3 moved = p_.position[i] - position_at_build_[i];
        displaced |= !(dot(moved, moved) <= far2);
    }
    displaced_ = displaced;
}

void ClearEngine::kick() {
    kick_walls();
    const double half = part_ / 2;
    bodies_.kick(part_, body_, p_);
    for (std::size_t i = 0; i < p_.size(); ++i) {
        if (!mobile(i) || bodies_.is_member(i)) continue;
        const double inverse = inverse_mass(i);
        p_.velocity[i] += half * (inverse * p_.force[i] + body_);
        p_.angular_velocity[i] += (half * inverse / (0.4 * radius(i) * radius(i))) * p_.torque[i];
    }
}

void ClearEngine::shake() {
    body_ = gravity_ + shaking_acceleration(shaking_, part_, work_.steps * control_.parts() + parts_done_);
}

/// Of all mobile particles.
Vec3 ClearEngine::momentum() const {
    Vec3 total{};
    for (std::size_t i = 0; i < p_.size(); ++i)
        if (mobile(i) && !bodies_.is_member(i)) total += (1 / inverse_mass(i)) * p_.velocity[i];
    for (std::size_t b = 0; b < bodies_.size(); ++b) total += bodies_.mass[b] * bodies_.velocity[b];
    return total;
}

bool ClearEngine::list_is_stale() const {
    if (displaced_) return true;
    for (const auto& contacts : walls_) {
        if (!contacts.wall.present()) continue;
        const Vec3 moved = contacts.wall.moved_since(contacts.pose_when_built);
        if (!(dot(moved, moved) <= skin_ * skin_ / 4)) return true;
    }
    if (std::ranges::any_of(bodies_.position, [&](const Vec3& x) { return domain_.outside(x); })) return true;
    return std::ranges::any_of(near_open_face_, [&](std::uint32_t i) { return domain_.outside(p_.position[i]); });
}

/// Moves bodies and their members into the domain. Returns which bodies leave: with the removed spheres, or through an
/// open face.
std::vector<bool> ClearEngine::wrap_bodies(const std::unordered_set<std::int32_t>& removed) {
    std::vector<bool> leaving(bodies_.size());
    bodies_.wrap(domain_, p_, [this](std::size_t b, const Vec3& shift) {
        work_of_wrapping_ += bodies_.mass[b] * dot(gravity_, shift);
    });
    for (std::size_t b = 0; b < bodies_.size(); ++b)
        leaving[b] =
            domain_.outside(bodies_.position[b]) ||
            std::ranges::any_of(bodies_.members(b), [&](std::uint32_t i) { return removed.contains(p_.id[i]); });
    return leaving;
}

void ClearEngine::rebuild(std::span<const std::int32_t> removed) {
    const std::unordered_set<std::int32_t> leaving(removed.begin(), removed.end());
    std::vector<std::uint32_t> staying;
    staying.reserve(p_.size());
    const std::vector<bool> bodies_leaving = wrap_bodies(leaving);
    for (std::uint32_t i = 0; i < p_.size(); ++i) {
        if (bodies_.is_member(i)) {
            if (!bodies_leaving[bodies_.body_of(i)]) staying.push_back(i);
            continue;
        }
        Vec3& x = p_.position[i];
        const Vec3 shift = domain_.wrapping(x);
        if (shift != Vec3{}) {
            x += shift;
            if (mobile(i)) work_of_wrapping_ += dot(gravity_, shift) / inverse_mass(i);
        }
        if ((mobile(i) && domain_.outside(x)) || leaving.contains(p_.id[i])) continue;
        staying.push_back(i);
    }
    cells_.sort(p_.position, staying, radii(), skin_ + beyond_pair_, domain_);
    std::vector<std::uint32_t> fresh_index(p_.size(), particles::gone);
    const auto order = cells_.order();
    for (std::uint32_t k = 0; k < order.size(); ++k) fresh_index[order[k]] = k;
    const bool some_left = order.size() < p_.size();
    p_.reorder(order);
    if (!bodies_leaving.empty()) {
        particles::reorder(bodies_.offset, order);
        bodies_.remove(bodies_leaving);
        map_bodies();
        bodies_.position_at_build = bodies_.position;
    }

    const auto matters = [this](std::size_t i, std::size_t j) {
        return (mobile(i) || mobile(j)) && !bodies_.same_body(i, j);
    };
    particles::NeighbourList fresh;
    fresh.build(cells_, p_.position, radii(), skin_ + beyond_pair_, domain_, matters);
    pairs_.carry(list_, fresh, fresh_index);
    list_ = std::move(fresh);
    if (remembers_separation_) forget_separated();
    list_walls(fresh_index);
    judge_frozen();
    position_at_build_ = p_.position;
    displaced_ = false;
    near_open_face_.clear();
    const Vec3 margin = {skin_, skin_, skin_};
    const geometry::Domain inner{domain_.low + margin, domain_.high - margin, domain_.periodic};
    for (std::uint32_t i = 0; i < p_.size(); ++i)
        if (mobile(i) && !bodies_.is_member(i) && inner.outside(p_.position[i])) near_open_face_.push_back(i);
    if (some_left) balance_.restart();
    if (crossings_.wanted()) list_crossings();
    ++work_.rebuilds;
}

/// No particle moves by more than the skin before the next rebuild: the step after which it is made included.
void ClearEngine::list_crossings() {
    const std::size_t spheres = p_.size();  // bodies follow them
    crossings_.list(
        spheres + bodies_.size(), 2 * skin_,
        [this, spheres](std::size_t i) { return i >= spheres || (mobile(i) && !bodies_.is_member(i)); },
        [this, spheres](std::size_t i) { return i < spheres ? p_.position[i] : bodies_.position[i - spheres]; });
}

/// Ends the memories of pairs that do not touch at the rebuild, for laws whose memories outlive a separation.
void ClearEngine::forget_separated() {
    for (std::size_t i = 0; i < p_.size(); ++i)
        for (std::uint32_t k = list_.begin(i); k < list_.end(i); ++k) {
            const std::size_t j = list_[k].j();
            const Vec3 branch = p_.position[i] - (p_.position[j] + image_shifts_[list_[k].image()]);
            const double reach = radius(i) + radius(j);
            if (dot(branch, branch) < reach * reach) continue;
            std::fill_n(pairs_.value.data() + k * memories(), memories(), 0.0);
            pairs_.live[k] = 0;
        }
}

/// Of all pairs of kinds.
std::vector<double> ClearEngine::constants() const {
    std::vector<double> all;
    for (const auto& laws : laws_) {
        const std::vector<double> some = laws->constants();
        all.insert(all.end(), some.begin(), some.end());
    }
    return all;
}

std::vector<WallContacts> ClearEngine::make_walls(const std::vector<Wall>& walls) const {
    std::vector<Contacts> made;
    for (const Wall& wall : walls) {
        Contacts contacts{MovingWall(wall, domain_, radii_.largest), {}, {}, {}, 0, {}, {}, {}, {}, {}};
        for (std::size_t kind = 0; kind < table_.kinds(); ++kind) {
            const Material m = table_.at_wall(wall, kind);
            if (!laws_.front()->covers(m))
                throw std::invalid_argument(
                    "the surface of a wall has friction or cohesion that nothing at the start had");
            contacts.laws.push_back(laws_.front()->of(m));
            contacts.stiffness.push_back(normal_slope(m) / normal_slope(table_.pairs().front()));
            if (contacts.laws.back()->beyond(radii_.largest) > beyond_wall_)
                throw std::invalid_argument(
                    "the surface of a wall attracts from further than anything at the start did");
        }
        made.push_back(std::move(contacts));
    }
    return made;
}

/// Lists who is near; contacts go with their particles.
void ClearEngine::list_walls(std::span<const std::uint32_t> fresh_index) {
    std::vector<std::uint32_t> all;
    for (std::uint32_t i = 0; i < p_.size(); ++i)
        if (mobile(i)) all.push_back(i);
    std::vector<WallTouch> within;
    for (auto& contacts : walls_) {
        const auto before = std::move(contacts.near);
        contacts.near.clear();
        if (!contacts.wall.present()) continue;
        contacts.wall.find(all, p_.position, radii(), skin_ + beyond_wall_, within);
        for (const WallTouch& touch : within) {
            const std::uint32_t i = all[touch.entry];
            const bool again = !contacts.near.empty() && contacts.near.back() == i;
            if (!again && contacts.wall.wall().touches(p_.kind[i])) contacts.near.push_back(i);
        }
        contacts.built = wall_time();
        contacts.pose_when_built = contacts.wall.pose();
        carry_touches(contacts, before, fresh_index);
    }
}

void ClearEngine::carry_touches(Contacts& contacts, std::span<const std::uint32_t> before,
                                std::span<const std::uint32_t> fresh_index) const {
    std::vector<std::size_t> order;
    for (std::size_t k = 0; k < contacts.touches.size(); ++k) {
        WallTouch& touch = contacts.touches[k];
        const std::uint32_t i = fresh_index[before[touch.entry]];
        const auto at = std::ranges::lower_bound(contacts.near, i);
        if (i == particles::gone || at == contacts.near.end() || *at != i) continue;
        touch.entry = static_cast<std::uint32_t>(at - contacts.near.begin());
        order.push_back(k);
    }
    std::ranges::stable_sort(order, {}, [&](std::size_t k) { return contacts.touches[k].entry; });
    const auto touches = contacts.touches;
    const auto memory = contacts.memory;
    contacts.touches.clear();
    contacts.memory.clear();
    for (const std::size_t k : order) {
        contacts.touches.push_back(touches[k]);
        const double* const first = memory.data() + k * memories();
        contacts.memory.insert(contacts.memory.end(), first, first + memories());
    }
}

void ClearEngine::set_walls(std::vector<Wall> walls) {
    walls_ = make_walls(walls);
    wall_steps_ = 0;
    work_of_walls_ = 0;
    restart_forces();
}

void ClearEngine::change_walls(std::vector<Wall> walls) {
    if (walls.size() != walls_.size()) throw std::invalid_argument("walls that change keep their number");
    std::vector<MovingWall> made;
    for (std::size_t w = 0; w < walls.size(); ++w) made.push_back(walls_[w].wall.moving_as(walls[w], domain_));
    for (std::size_t w = 0; w < walls.size(); ++w) {
        Contacts& contacts = walls_[w];
        contacts.wall = std::move(made[w]);
        contacts.wall.place(wall_time());
        if (contacts.wall.present()) continue;
        contacts.touches.clear();
        contacts.memory.clear();
        contacts.load.force = contacts.load.torque = Vec3{};
    }
    restart_forces();
}

/// After a change of walls or particles.
void ClearEngine::restart_forces() {
    balance_.restart();
    if (!fault_.empty()) return;
    rebuild();
    evaluate(false);
    set_speed_limit();
}

void ClearEngine::add(std::span<const Sphere> spheres, std::span<const Body> bodies) {
    require_announced(to_come_, spheres, ids());
    dem::require_possible(bodies, announced_, spheres);
    if (spheres.empty() || !fault_.empty()) return;
    const std::size_t before = ids();
    for (const Sphere& s : spheres) added_.push_back(table_.kind_of(s));
    append(spheres, bodies, before);
    restart_forces();
}

void ClearEngine::remove(std::span<const std::int32_t> ids) {
    if (!ids.empty()) rebuild(ids);
}

}  // namespace grainsweep::dem::clear
