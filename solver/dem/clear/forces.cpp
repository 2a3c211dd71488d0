// Forces of the clear engine: touching pairs and walls, and the laws applied to them.
//
// Torque on both partners: -(R - d/2) n x F_t, for the contact point lies in the middle of the overlap.
#include "solver/dem/clear/engine.hpp"
#include "solver/dem/limits.hpp"

#include <algorithm>
#include <cmath>

namespace grainsweep::dem::clear {

using namespace geometry;

[[gnu::always_inline]] inline Touch<Partner::particle> ClearEngine::touch(std::size_t i, std::size_t j,
                                                                          const Vec3& branch, double r2) const {
    Touch<Partner::particle> t;
    t.radius_i = radius(i);
    t.radius_j = radius(j);
    t.distance = std::sqrt(r2);
    t.overlap = t.radius_i + t.radius_j - t.distance;
    t.normal = (1 / t.distance) * branch;
    t.effective_radius = effective_radius(i, j);
    t.reduced_mass = reduced_mass(i, j, t.normal);
    t.root = std::sqrt(t.effective_radius * std::max(t.overlap, 0.0));
    t.damping_root = std::sqrt(t.root * t.reduced_mass);
    const Vec3 v = p_.velocity[i] - p_.velocity[j];
    t.normal_velocity = dot(v, t.normal);
    if (spins_) {
        const Vec3 turn = (t.radius_i - t.overlap / 2) * p_.angular_velocity[i] +
                          (t.radius_j - t.overlap / 2) * p_.angular_velocity[j];
        t.slip = v - t.normal_velocity * t.normal - cross(turn, t.normal);
    }
    if (rolls_) {
        t.turning = p_.angular_velocity[i] - p_.angular_velocity[j];
        t.rolling_inertia = rolling_inertia(i, j);
    }
    t.time_step = part_;
    return t;
}

[[gnu::always_inline]] inline Touch<Partner::wall> ClearEngine::touch(std::size_t i, const Closest& closest,
                                                                      const Vec3& wall_velocity) const {
    Touch<Partner::wall> t;
    t.radius_i = radius(i);
    t.distance = closest.distance;
    t.overlap = t.radius_i - t.distance;
    t.normal = closest.normal;
    t.effective_radius = t.radius_i;
    t.reduced_mass = 1 / inverse_mass_at(i, t.normal);
    t.root = std::sqrt(t.effective_radius * std::max(t.overlap, 0.0));
    t.damping_root = std::sqrt(t.root * t.reduced_mass);
    const Vec3 v = p_.velocity[i] - wall_velocity;
    t.normal_velocity = dot(v, t.normal);
    if (spins_)
        t.slip =
            v - t.normal_velocity * t.normal - cross((t.radius_i - t.overlap / 2) * p_.angular_velocity[i], t.normal);
    if (rolls_) {
        t.turning = p_.angular_velocity[i];
        t.rolling_inertia = inertia_about_contact * t.reduced_mass * t.radius_i * t.radius_i;
    }
    t.time_step = part_;
    return t;
}

/// For laws that reach beyond touch: completes a near pair if it is a contact, else ends its memory.
template <class T>
bool ClearEngine::begins(const AnyContact& laws, T& t, double* memory) const {
    if (!laws.begin(t, memory)) std::fill_n(memory, memories(), 0.0);
    return t.touching;
}

void ClearEngine::evaluate(bool advance) {
    std::ranges::fill(p_.force, Vec3{});
    std::ranges::fill(p_.torque, Vec3{});
    largest_wall_overlap_ = 0;
    stiffest_ = 0;
    pair_contacts(advance);
    peak_overlap_ = std::max(peak_overlap_, largest_overlap_);
    for (auto& contacts : walls_)
        if (contacts.wall.present()) wall_contacts(contacts, advance);
    peak_wall_overlap_ = std::max(peak_wall_overlap_, largest_wall_overlap_);
    bodies_.gather(p_);
    work_.pair_visits += static_cast<double>(list_.size());
    // Negated, so that a value that is not a number is reported too.
    const double swing2 = swing_factor_ * stiffest_;
    if (!(largest_overlap_ <= largest_sound_overlap) || !(largest_wall_overlap_ <= deepest_in_walls_) ||
        !(swing2 <= largest_sound_swing * largest_sound_swing))
        report_contacts();
}

/// List entries of some particles that touch, in list order; histories of contacts that ended are dropped.
///
/// A branch for touching pairs would be hard to predict. So every entry is written, and the end of the list advances
/// only for touching ones.
std::size_t ClearEngine::find_touching(std::size_t first, std::size_t last) {
    touching_.resize(std::max<std::size_t>(touching_.size(), list_.end(last - 1) - list_.begin(first)));
    std::size_t found = 0;
    for (std::size_t i = first; i < last; ++i) {
        const Vec3 x = p_.position[i];
        const double radius_i = radius(i);
        const std::uint32_t end = list_.end(i);
        for (std::uint32_t k = list_.begin(i); k < end; ++k) {
            const auto entry = list_[k];
            const std::size_t j = entry.j();
            const Vec3 branch = x - (p_.position[j] + image_shifts_[entry.image()]);
            const double reach = radius_i + radius(j) + beyond_pair_;
            const double r2 = dot(branch, branch);
            const bool inside = r2 < reach * reach;
            touching_[found] = {branch, r2, static_cast<std::uint32_t>(i), k};
            found += inside ? 1 : 0;
            if (remembers_separation_) {
                pairs_.live[k] |= inside ? 1 : 0;
            } else if (pairs_.live[k] != static_cast<std::uint8_t>(inside)) [[unlikely]] {
                pairs_.live[k] = inside ? 1 : 0;
                std::fill_n(pairs_.value.data() + k * memories(), memories(), 0.0);
            }
        }
    }
    return found;
}

void ClearEngine::pair_contacts(bool advance) {
    constexpr std::size_t tile = 64;  // particles whose contacts stay in the first cache between the two passes
    double largest = 0;
    for (std::size_t first = 0; first < p_.size(); first += tile) {
        const std::size_t found = find_touching(first, std::min(first + tile, p_.size()));
        for (std::size_t c = 0; c < found; ++c) {
            const auto& [branch, r2, i, k] = touching_[c];
            const std::size_t j = list_[k].j();
            auto t = touch(i, j, branch, r2);
            double* const memory = pairs_.value.data() + k * memories();
            const AnyContact& laws = laws_of(i, j);
            if (reaches_ && !begins(laws, t, memory)) continue;
            largest = std::max(largest, t.overlap / (2 * std::min(t.radius_i, t.radius_j)));
            stiffest_ = std::max(stiffest_, slope_over(t.root) / t.reduced_mass * stiffness_[pair(i, j)]);
            const auto r = advance ? laws.advance(t, memory) : laws.respond(t, memory);
            const Vec3 f = r.normal * t.normal - r.resistance;
            p_.force[i] += f;
            p_.force[j] -= f;
            if (spins_) {
                const Vec3 moment = cross(t.normal, r.resistance);
                p_.torque[i] += (t.radius_i - t.overlap / 2) * moment;
                p_.torque[j] += (t.radius_j - t.overlap / 2) * moment;
            }
            if (rolls_) {
                p_.torque[i] -= r.rolling;
                p_.torque[j] += r.rolling;
            }
        }
    }
    largest_overlap_ = largest;
}

/// Finds the places where a wall is touched now. A contact keeps its memory if its place moves.
void ClearEngine::find_touches(Contacts& contacts) {
    touched_before_.swap(contacts.touches);
    contacts.wall.find(contacts.near, p_.position, radii(), beyond_wall_, contacts.touches);
    if (memories() == 0) return;
    memory_before_.swap(contacts.memory);
    const auto& before = touched_before_;
    const auto& now = contacts.touches;
    contacts.memory.assign(now.size() * memories(), 0);
    std::vector<std::int32_t> from;
    std::size_t b = 0;
    for (std::size_t n = 0; n < now.size();) {  // particle by particle
        const std::uint32_t entry = now[n].entry;
        while (b < before.size() && before[b].entry < entry) ++b;
        std::size_t b_end = b, n_end = n;
        while (b_end < before.size() && before[b_end].entry == entry) ++b_end;
        while (n_end < now.size() && now[n_end].entry == entry) ++n_end;
        contacts.wall.inherit({before.data() + b, b_end - b}, {now.data() + n, n_end - n}, from);
        for (std::size_t k = 0; k < from.size(); ++k)
            if (from[k] >= 0)
                std::copy_n(memory_before_.data() + (b + static_cast<std::size_t>(from[k])) * memories(), memories(),
                            contacts.memory.data() + (n + k) * memories());
        n = n_end;
    }
}

void ClearEngine::wall_contacts(Contacts& contacts, bool advance) {
    find_touches(contacts);
    if (advance && contacts.wall.thin()) judge_passages(contacts);
    const Twist& twist = contacts.wall.twist();
    Vec3 total{}, turn{};
    double largest = 0, power = 0;
    for (std::size_t k = 0; k < contacts.touches.size(); ++k) {
        const auto& [entry, place] = contacts.touches[k];
        const std::size_t i = contacts.near[entry];
        const Vec3 x = contacts.wall.image().of(p_.position[i]);  // where the wall is
        const Vec3 wall_velocity = twist.at(x - place.distance * place.normal, place.normal);
        auto t = touch(i, place, wall_velocity);
        double* const memory = contacts.memory.data() + k * memories();
        const AnyContact& laws = *contacts.laws[p_.kind[i]];
        if (reaches_ && !begins(laws, t, memory)) continue;
        largest = std::max(largest, t.overlap / (2 * t.radius_i));
        stiffest_ = std::max(stiffest_, slope_over(t.root) * inverse_mass(i) * contacts.stiffness[p_.kind[i]]);
        const auto r = advance ? laws.advance(t, memory) : laws.respond(t, memory);
        const Vec3 f = r.normal * t.normal - r.resistance;
        const double arm = t.radius_i - t.overlap / 2;
        p_.force[i] += f;
        total += f;
        power += dot(f, wall_velocity);
        turn += cross(x - arm * t.normal - twist.pivot, f);
        if (spins_) p_.torque[i] += arm * cross(t.normal, r.resistance);
        if (rolls_) {
            p_.torque[i] -= r.rolling;
            turn -= r.rolling;
        }
    }
    largest_wall_overlap_ = std::max(largest_wall_overlap_, largest);
    contacts.load.force = -total;
    contacts.load.torque = -turn;
    contacts.load_about = twist.pivot;
    if (advance) {
        contacts.load.work += power * part_;
        work_of_walls_ += power * part_;
        if (contacts.wall.wall().integrated) contacts.wall.integrate(-total, -turn, twist.pivot, part_);
    }
}

WallLoad ClearEngine::wall_load(std::size_t wall, const Vec3& about) const {
    WallLoad load = walls_.at(wall).load;
    load.torque += cross(walls_[wall].load_about - about, load.force);
    load.impulse = walls_[wall].wall.impulse();
    load.angular_impulse = walls_[wall].wall.angular_impulse(about);
    return load;
}

/// Calls visit(i, j, touch, memory) for the pairs that touch, in list order.
template <class Visit>
void ClearEngine::for_each_touching_pair(Visit&& visit) const {
    for (std::size_t i = 0; i < p_.size(); ++i)
        for (std::uint32_t k = list_.begin(i); k < list_.end(i); ++k) {
            const std::size_t j = list_[k].j();
            const Vec3 branch = p_.position[i] - (p_.position[j] + image_shifts_[list_[k].image()]);
            const double reach = radius(i) + radius(j) + beyond_pair_, r2 = dot(branch, branch);
            if (!(r2 < reach * reach)) continue;
            const double* const memory = pairs_.value.data() + k * memories();
            auto t = touch(i, j, branch, r2);
            if (!reaches_ || laws_of(i, j).begin(t, memory)) visit(i, j, t, memory);
        }
}

/// Calls visit(i, w, touch, memory, velocity of the wall) for the walls that are touched.
template <class Visit>
void ClearEngine::for_each_touched_wall(Visit&& visit) const {
    for (std::size_t w = 0; w < walls_.size(); ++w) {
        const auto& contacts = walls_[w];
        for (std::size_t k = 0; k < contacts.touches.size(); ++k) {
            const auto& [entry, place] = contacts.touches[k];
            const std::size_t i = contacts.near[entry];
            const double* const memory = contacts.memory.data() + k * memories();
            const Vec3 x = contacts.wall.image().of(p_.position[i]);
            const Vec3 velocity = contacts.wall.twist().at(x - place.distance * place.normal, place.normal);
            auto t = touch(i, place, velocity);
            if (!reaches_ || contacts.laws[p_.kind[i]]->begin(t, memory)) visit(i, w, t, memory, velocity);
        }
    }
}

/// Velocities that the laws saw in the last step.
Velocities ClearEngine::half_a_step_before(std::size_t i) const {
    if (!mobile(i)) return {};
    if (bodies_.is_member(i)) {
        const std::size_t b = bodies_.body_of(i);
        const Vec3 velocity = bodies_.velocity[b] - part_ / 2 * ((1 / bodies_.mass[b]) * bodies_.force[b] + body_);
        return {velocity + cross(bodies_.spin_in_step[b], bodies_.lever(i)), bodies_.spin_in_step[b]};
    }
    const double half = part_ / 2, inverse = inverse_mass(i);
    return {p_.velocity[i] - half * (inverse * p_.force[i] + body_),
            p_.angular_velocity[i] - (half * inverse / (0.4 * radius(i) * radius(i))) * p_.torque[i]};
}

void ClearEngine::read_contacts(bool of_step, std::vector<ContactForce>& into) const {
    constexpr double rounding = 1e-12;
    into.clear();
    const auto add = [&](const AnyContact& laws, std::size_t i, std::int32_t second, const auto& t,
                         const double* memory, auto&& relative_motion) {
        const auto now = of_step ? moving(t, relative_motion([this](std::size_t k) {
                                              return Velocities{p_.velocity[k], p_.angular_velocity[k]};
                                          }))
                                 : t;
        const auto before = [this](std::size_t k) { return half_a_step_before(k); };
        into.push_back(read_contact(laws, of_step ? as_in_step(t, relative_motion(before), rounding) : t, now, memory,
                                    p_.id[i], second));
    };
    for_each_touching_pair([&](std::size_t i, std::size_t j, const auto& t, const double* memory) {
        add(laws_of(i, j), i, p_.id[j], t, memory, [&](auto&& of) { return relative(t, of(i), of(j)); });
    });
    for_each_touched_wall([&](std::size_t i, std::size_t w, const auto& t, const double* memory, const Vec3& velocity) {
        add(*walls_[w].laws[p_.kind[i]], i, -1 - static_cast<std::int32_t>(w), t, memory,
            [&](auto&& of) { return relative(t, of(i), velocity); });
    });
}

/// Writes the network of all contacts; at a second look of those that last, and those that the last step has cut have
/// no tangential spring.
void ClearEngine::gather_network() {
    constexpr double rounding = 1e-12;
    const auto& lasting = control_.lasting();
    network_.clear(lasting);
    for (std::size_t i = 0; i < p_.size(); ++i) network_.add_sphere(p_.inverse_mass[i], radius(i));
    for (std::size_t b = 0; b < bodies_.size(); ++b)
        network_.add_body(bodies_.mass[b], bodies_.inertia[b], bodies_.axes(b), bodies_.members(b),
                          [this](std::size_t i) { return bodies_.lever(i); });
    const auto bond = [&](const AnyContact& laws, std::size_t i, std::int32_t j, std::uint64_t key, const auto& t,
                          const double* memory) {
        return bond_of(laws, t, memory, key, static_cast<std::int32_t>(i), j, !lasting.empty(), rounding);
    };
    for_each_touching_pair([&](std::size_t i, std::size_t j, const auto& t, const double* memory) {
        const std::uint64_t key = key_of(p_.id[i], p_.id[j]);
        if (network_.takes(key)) network_.add(bond(laws_of(i, j), i, static_cast<std::int32_t>(j), key, t, memory));
    });
    std::size_t last = walls_.size();
    for_each_touched_wall([&](std::size_t i, std::size_t w, const auto& t, const double* memory, const Vec3&) {
        const auto& wall = walls_[w].wall;
        if (w != last) network_.add_wall(freedoms_of(wall, wall_time()));
        last = w;
        const std::uint64_t key = key_of(p_.id[i], -1 - static_cast<std::int32_t>(w));
        if (!network_.takes(key)) return;
        const Vec3 x = wall.image().of(p_.position[i]);
        network_.add_at_wall(bond(*walls_[w].laws[p_.kind[i]], i, -1, key, t, memory), x - t.distance * t.normal);
    });
}

/// Kinetic, gravitational and stored energy; `active` is the part in motion and in contacts.
double ClearEngine::mechanical_energy(double& active) const {
    double motion = 0;
    double height = 0;
    double stored = 0;
    double squeezed = 0;  // sum of absolute values
    const auto add = [&](double energy) {
        stored += energy;
        squeezed += std::abs(energy);
    };
    for_each_touching_pair([&](std::size_t i, std::size_t j, const auto& t, const double* memory) {
        add(laws_of(i, j).energy(t, memory));
    });
    for_each_touched_wall([&](std::size_t i, std::size_t w, const auto& t, const double* memory, const Vec3&) {
        add(walls_[w].laws[p_.kind[i]]->energy(t, memory));
    });
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        motion += bodies_.kinetic_energy(b);
        height -= bodies_.mass[b] * dot(gravity_, bodies_.position[b]);
    }
    for (std::size_t i = 0; i < p_.size(); ++i) {
        if (!mobile(i) || bodies_.is_member(i)) continue;
        const double mass = 1 / inverse_mass(i);
        motion += 0.5 * mass * dot(p_.velocity[i], p_.velocity[i]);
        height -= mass * dot(gravity_, p_.position[i]);
        if (spins_) motion += 0.2 * mass * radius(i) * radius(i) * dot(p_.angular_velocity[i], p_.angular_velocity[i]);
    }
    active = motion + squeezed;
    return motion + height + stored;
}

}  // namespace grainsweep::dem::clear
