#include "solver/dem/fast/contact_reader.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "solver/dem/fast/listed_pairs.hpp"
#include "solver/dem/fast/wall_lists.hpp"
#include "solver/dem/material.hpp"

namespace grainsweep::dem::fast {

using namespace geometry;

namespace {

// Of forces in single precision, relative to the sizes of their terms.
constexpr double rounding = 1e-6;
constexpr double rounding_at_rest = 1e-5;
constexpr double most_rounding = 1e-4;  // beyond it springs that hold would count as cut

}  // namespace

ContactReader::ContactReader(const PairContacts& laws, const ListSpace& space, const Field& field,
                             const std::int32_t* id, std::span<const Velocities> motions, std::int32_t width,
                             std::span<const ParkedContact> parked, std::span<const Velocities> before,
                             const Clumps* clumps, double overlap_rounding)
    : laws_(laws),
      space_(space),
      field_(field),
      id_(id),
      motions_(motions),
      width_(width),
      parked_(parked),
      before_(before),
      clumps_(clumps),
      overlap_rounding_(overlap_rounding),
      beyond_pair_(space.scale.length * static_cast<double>(field.constants.beyond)),
      beyond_wall_(space.scale.length * static_cast<double>(field.constants.beyond_wall)) {
    std::ranges::transform(laws.front()->traits().memory, memory_unit_.begin(),
                           [&](const MemoryKind& kind) { return unit_of(kind.dimension, space.scale); });
}

const AnyContact& ContactReader::laws_of(std::int32_t i, std::int32_t j) const {
    return *laws_[place_of_pair(field_.kind[i], field_.kind[j])];
}

double ContactReader::radius(std::int32_t i) const {
    return static_cast<double>(field_.records[i].radius) * space_.scale.length;
}

double ContactReader::mass(std::int32_t i) const {
    const double inverse = static_cast<double>(field_.records[i].inverse_mass);
    return inverse > 0 ? space_.scale.mass / inverse : std::numeric_limits<double>::infinity();
}

double ContactReader::inverse_mass_at(std::int32_t i, const Vec3& normal) const {
    const std::int32_t body = clumps_ == nullptr ? -1 : clumps_->body_of(field_, i);
    if (body < 0) return 1 / mass(i);
    return clumps_->inverse_mass_at(static_cast<std::size_t>(body), clumps_->lever_at(field_, i), normal);
}

ContactReader::Memory ContactReader::memory(const float* const* column, std::int64_t at) const {
    Memory m{};
    for (std::size_t a = 0; a < static_cast<std::size_t>(field_.histories); ++a)
        m[a] = static_cast<double>(column[a][at]) * memory_unit_[a];
    return m;
}

/// Completes a touch whose geometry is known and applies the laws; motion_in(motions) is its relative motion.
template <Partner partner, class MotionIn>
ContactForce ContactReader::read(const AnyContact& laws, Touch<partner> t, std::int32_t i, std::int32_t second,
                                 const Memory& memory, MotionIn&& motion_in) const {
    t.damping_root = std::sqrt(t.root * t.reduced_mass);
    const Touch<partner> now = moving(t, motion_in(motions_));
    const double of_overlap =
        overlap_rounding_ > 0 ? std::min(overlap_rounding_ * t.distance / std::abs(t.overlap), most_rounding) : 0;
    return read_contact(laws, before_.empty() ? now : as_in_step(t, motion_in(before_), rounding + of_overlap), now,
                        memory.data(), id_[i], second);
}

/// Returns whether two particles are within the reach of their laws; sets the geometry of the touch.
inline bool ContactReader::near(std::int32_t i, std::int32_t j, Touch<Partner::particle>& t) const {
    const Record &a = field_.records[i], &b = field_.records[j];
    Vec3 branch{};
    for (std::size_t axis = 0; axis < 3; ++axis)  // the difference is between the nearest images
        branch[axis] = static_cast<std::int32_t>(static_cast<std::uint32_t>(a.position[axis]) -
                                                 static_cast<std::uint32_t>(b.position[axis])) *
                       space_.scale.unit[axis];
    t.radius_i = radius(i);
    t.radius_j = radius(j);
    // A step adds radii in single precision.
    const double sum =
        before_.empty() ? t.radius_i + t.radius_j : static_cast<double>(a.radius + b.radius) * space_.scale.length;
    const double reach = sum + beyond_pair_;
    const double square = dot(branch, branch);
    if (!(square < reach * reach)) return false;
    t.distance = std::sqrt(square);
    t.overlap = sum - t.distance;
    if (!(a.inverse_mass > 0) && !(b.inverse_mass > 0)) return false;
    t.normal = (1 / t.distance) * branch;
    t.effective_radius = t.radius_i * t.radius_j / sum;
    t.root = std::sqrt(t.effective_radius * std::max(t.overlap, 0.0));
    return true;
}

bool ContactReader::touches(std::int32_t i, std::int32_t j, const Memory& memory, Touch<Partner::particle>& t) const {
    return near(i, j, t) && laws_of(i, j).begin(t, memory.data());
}

template <class Visit>
void ContactReader::for_each_parked(Visit&& visit) const {
    for (const ParkedContact& p : parked_) {
        const Memory of_pair = memory(p);
        Touch<Partner::particle> t;
        if (touches(p.first, p.second, of_pair, t)) visit(p.first, p.second, t, of_pair);
    }
}

template <class Visit>
void ContactReader::look_at(std::int32_t k, std::optional<std::int64_t> place, Visit&& visit) const {
    const std::int32_t i = index_at(field_.inner_first[k]), j = index_at(field_.inner_second[k]);
    if (i >= field_.count || j >= field_.count) return;  // they fill the list up
    Touch<Partner::particle> t;
    if (!near(i, j, t)) return;
    const Memory of_pair = place ? memory(field_.history, *place) : Memory{};
    if (laws_of(i, j).begin(t, of_pair.data())) visit(i, j, t, of_pair);
}

template <class Visit>
void ContactReader::for_each_pair(Visit&& visit) const {
    std::int64_t stream = 0;  // memories of the pairs whose bit is set, without gaps
    for (std::int32_t k = 0; k < field_.inner_count; ++k) {
        const bool remembered = (field_.touching[k / width_] >> (k % width_) & 1) != 0;
        look_at(k, remembered ? std::optional(stream++) : std::nullopt, visit);
    }
    for_each_parked(visit);
}

template <class Visit>
void ContactReader::for_each_remembered(Visit&& visit) const {
    std::int64_t stream = 0;
    for (std::int32_t batch = 0; batch * width_ < field_.inner_count; ++batch)
        for (unsigned left = field_.touching[batch]; left != 0; left &= left - 1)
            look_at(batch * width_ + std::countr_zero(left), stream++, visit);
    for_each_parked(visit);
}

ContactReader::Memory ContactReader::memory(const ParkedContact& contact) const {
    const float* column[histories_at_most];
    for (int a = 0; a < histories_at_most; ++a) column[a] = contact.history + a;
    return memory(column, 0);
}

/// Adds the values that depend on the masses.
void ContactReader::complete(std::int32_t i, std::int32_t j, Touch<Partner::particle>& t) const {
    t.reduced_mass = 1 / (inverse_mass_at(i, t.normal) + inverse_mass_at(j, t.normal));
    t.rolling_inertia =
        inertia_about_contact / (1 / (mass(i) * t.radius_i * t.radius_i) + 1 / (mass(j) * t.radius_j * t.radius_j));
}

void ContactReader::complete(std::int32_t i, Touch<Partner::wall>& t) const {
    t.reduced_mass = clumps_ == nullptr || clumps_->empty() ? mass(i) : 1 / inverse_mass_at(i, t.normal);
    t.rolling_inertia = inertia_about_contact * t.reduced_mass * t.radius_i * t.radius_i;
}

void ContactReader::stand_still(ParkedContact& contact) const {
    Touch<Partner::particle> t;
    contact.overlap = 0;
    std::fill_n(contact.force, 3, 0.0F);
    std::fill_n(contact.torque[0], 6, 0.0F);
    const Memory of_pair = memory(contact);
    if (!touches(contact.first, contact.second, of_pair, t)) return;
    complete(contact.first, contact.second, t);
    const ContactForce c = read(laws_of(contact.first, contact.second), t, contact.first, contact.second, of_pair,
                                [](std::span<const Velocities>) { return RelativeMotion{}; });
    const Scale& s = space_.scale;
    const double unit = s.force();
    const Vec3 force = c.normal_force * c.normal + c.tangential_force;
    const Vec3 turn = cross(c.tangential_force, c.normal);  // n x (-F_t)
    for (std::size_t a = 0; a < 3; ++a) {
        contact.force[a] = static_cast<float>(force[a] / unit);
        contact.torque[0][a] =
            static_cast<float>(((t.radius_i - t.overlap / 2) * turn[a] + c.rolling_moment[a]) / (unit * s.length));
        contact.torque[1][a] =
            static_cast<float>(((t.radius_j - t.overlap / 2) * turn[a] - c.rolling_moment[a]) / (unit * s.length));
    }
    contact.overlap = static_cast<float>(t.overlap / (2 * std::min(t.radius_i, t.radius_j)));
}

void ContactReader::pairs(std::vector<ContactForce>& into) const {
    for_each_pair([&](std::int32_t i, std::int32_t j, Touch<Partner::particle>& t, const Memory& memory) {
        complete(i, j, t);
        into.push_back(read(laws_of(i, j), t, i, id_[j], memory, [&](std::span<const Velocities> motions) {
            return relative(t, motions[static_cast<std::size_t>(i)], motions[static_cast<std::size_t>(j)]);
        }));
    });
}

template <class Visit>
void ContactReader::for_each_at_wall(const Walls& walls, std::size_t w, Visit&& visit) const {
    const MovingWall& wall = walls[w];
    std::vector<WallTouch> touched;
    for_each_near(field_, walls, w, [&](std::int32_t i, std::int32_t slot) {
        const Vec3 x = wall.image().of(position_at_walls(field_, i, space_.scale));
        touched.clear();
        wall.find(0, x, radius(i) + beyond_wall_, touched);
        for (const auto& [entry, closest] : touched) {
            Touch<Partner::wall> t;
            t.radius_i = t.effective_radius = radius(i);
            t.distance = closest.distance;
            t.overlap = t.radius_i - closest.distance;
            if (!(t.overlap > -beyond_wall_)) continue;
            const Memory of_contact = memory_at_wall(walls, w, i, slot++);
            t.normal = closest.normal;
            t.root = std::sqrt(t.effective_radius * std::max(t.overlap, 0.0));
            if (!walls.laws(w, field_.kind[i]).begin(t, of_contact.data())) continue;
            const Vec3 place = x - closest.distance * closest.normal;
            visit(i, WallPoint{place, wall.twist().at(place, closest.normal)}, t, of_contact);
        }
    });
}

/// Of a particle's contact; of one that the last step did not have, none.
ContactReader::Memory ContactReader::memory_at_wall(const Walls& walls, std::size_t w, std::int32_t i,
                                                    std::int32_t slot) const {
    if (walls.is_single(w)) return memory(field_.wall_history, slot);
    const bool had =
        slot < field_.touched[w].end && field_.touch_particle[slot] == static_cast<Place>(i * places_per_index);
    return had ? memory(field_.touch_memory, slot) : Memory{};
}

void ContactReader::wall(const Walls& walls, std::size_t w, std::vector<ContactForce>& into) const {
    for_each_at_wall(walls, w, [&](std::int32_t i, const WallPoint& at, Touch<Partner::wall>& t, const Memory& memory) {
        complete(i, t);
        const auto second = -1 - static_cast<std::int32_t>(w);
        into.push_back(
            read(walls.laws(w, field_.kind[i]), t, i, second, memory, [&](std::span<const Velocities> motions) {
                return relative(t, motions[static_cast<std::size_t>(i)], at.velocity);
            }));
    });
}

void ContactReader::network(const Walls& walls, double time, const std::vector<std::uint64_t>& lasting,
                            Network& into) const {
    into.clear(lasting);
    const bool slides = !lasting.empty();
    for (std::int32_t i = 0; i < field_.count; ++i) {
        const double inverse = static_cast<double>(field_.records[i].inverse_mass) / space_.scale.mass;
        into.add_sphere(inverse, radius(i));
    }
    for (std::size_t b = 0; clumps_ != nullptr && b < clumps_->size(); ++b) {
        const auto members = clumps_->members(b);
        const std::vector<std::uint32_t> places(members.begin(), members.end());
        into.add_body(clumps_->mass[b], clumps_->inertia[b], clumps_->axes(b), places,
                      [&](std::uint32_t i) { return clumps_->lever_at(field_, static_cast<std::int32_t>(i)); });
    }
    const auto bond = [&](const AnyContact& laws, auto& t, std::int32_t i, std::int32_t j, std::uint64_t key,
                          const Memory& memory) {
        t.damping_root = std::sqrt(t.root * t.reduced_mass);
        return bond_of(laws, t, memory.data(), key, i, j, slides, rounding_at_rest);
    };
    const auto add = [&](std::int32_t i, std::int32_t j, Touch<Partner::particle>& t, const Memory& memory) {
        const std::uint64_t key = key_of(id_[i], id_[j]);
        if (!into.takes(key)) return;
        complete(i, j, t);
        into.add(bond(laws_of(i, j), t, i, j, key, memory));
    };
    if (field_.histories > 0)
        for_each_remembered(add);
    else
        for_each_pair(add);
    for (std::size_t w = 0; w < walls.count(); ++w) {
        if (!walls[w].present()) continue;
        const std::vector<Freedom> freedoms = freedoms_of(walls[w], time);
        into.add_wall(freedoms);
        for_each_at_wall(walls, w,
                         [&](std::int32_t i, const WallPoint& at, Touch<Partner::wall>& t, const Memory& memory) {
                             const std::uint64_t key = key_of(id_[i], -1 - static_cast<std::int32_t>(w));
                             if (!into.takes(key)) return;
                             complete(i, t);
                             into.add_at_wall(bond(walls.laws(w, field_.kind[i]), t, i, -1, key, memory), at.place);
                         });
    }
}

StoredEnergy ContactReader::stored(const Walls& walls) const {
    StoredEnergy e;
    const auto add_energy = [&](const AnyContact& laws, const auto& t, const Memory& memory) {
        const double energy = laws.energy(t, memory.data());
        e.sum += energy;
        e.squeezed += std::abs(energy);
    };
    for_each_pair([&](std::int32_t i, std::int32_t j, const auto& t, const Memory& memory) {
        add_energy(laws_of(i, j), t, memory);
    });
    for (std::size_t w = 0; w < walls.count(); ++w)
        for_each_at_wall(walls, w, [&](std::int32_t i, const WallPoint&, const auto& t, const Memory& memory) {
            add_energy(walls.laws(w, field_.kind[i]), t, memory);
        });
    return e;
}

}  // namespace grainsweep::dem::fast
