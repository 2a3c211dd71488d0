#include "solver/coupling/spring_contacts.hpp"

#include "solver/bytes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace grainsweep::coupling {

using namespace geometry;

namespace {

double norm_of(const Vec3& a) {
    return std::sqrt(dot(a, a));
}

Vec3 cross_product(const Vec3& a, const Vec3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace

SpringContacts::SpringContacts(const Sphere& sphere, const Walls& walls, const HystereticSpring& spring,
                               std::size_t particles, double steps_per_contact)
    : sphere_(sphere),
      walls_(walls),
      spring_(spring),
      near_(walls),
      steps_per_contact_(steps_per_contact),
      mass_((sphere.density_ratio + 0.5) * sphere.volume()),
      inertia_(0.4 * sphere.density_ratio * sphere.volume() * sphere.radius() * sphere.radius()),
      rotation_drag_(8 * std::numbers::pi * sphere.prandtl * std::pow(sphere.radius(), 3)),
      spin_(particles, Vec3{}),
      idle_(particles, 0),
      surroundings_(particles),
      slot_(particles, 0) {}

double SpringContacts::stiffness(const Sphere& sphere, double overlap, double time_step) {
    const double depth = overlap * 2 * sphere.radius();
    const double drive = std::abs(sphere.density_ratio - 1) * sphere.acceleration;
    const double slip = drive * sphere.stokes / sphere.prandtl;
    const double force = drive * sphere.volume();
    const double reduced_mass = 0.5 * (sphere.density_ratio + 0.5) * sphere.volume();
    const double least = reduced_mass * std::pow(std::numbers::pi / time_step, 2);
    return std::max({force / depth, reduced_mass * slip * slip / (depth * depth), least});
}

std::int64_t SpringContacts::substeps(double time_step) const {
    const double shortest = std::numbers::pi * std::sqrt(0.5 * mass_ / spring_.unloading());
    return std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(steps_per_contact_ * time_step / shortest)));
}

void SpringContacts::begin(const Cloud& cloud) {
    position_ = cloud.position;
    velocity_ = cloud.velocity;
}

void SpringContacts::find_active(const Cloud& freely_moved) {
    active_.clear();
    std::fill(slot_.begin(), slot_.end(), 0U);
    std::vector<Vec3> path(position_.size());
    double longest = 0;
    for (std::size_t p = 0; p < path.size(); ++p) {
        path[p] = freely_moved.position[p] - position_[p];
        const double length = norm_of(path[p]);
        if (!std::isfinite(length) || length > 0.25) {  // no state to look for contacts in; the run reports it
            contacts_.clear();
            return;
        }
        longest = std::max(longest, length);
    }
    const double diameter = 2 * sphere_.radius();
    const double margin = 0.05 * diameter;
    const auto activate = [&](std::uint32_t p) {
        if (slot_[p] != 0) return false;
        active_.push_back({});
        active_.back().particle = p;
        slot_[p] = static_cast<std::uint32_t>(active_.size());
        return true;
    };
    for (std::uint32_t p = 0; p < path.size(); ++p)
        for (std::size_t d = 0; d < 3; ++d) {
            if (walls_.periodic[d]) continue;
            const double low = std::min(position_[p][d], position_[p][d] + path[p][d]) - margin;
            const double high = std::max(position_[p][d], position_[p][d] + path[p][d]) + margin;
            if (low < walls_.low[d] + walls_.contact || high > walls_.high[d] - walls_.contact) activate(p);
        }
    const auto& pairs = near_.find(position_, diameter + 2 * longest + margin);
    for (const auto& [i, j] : pairs) {
        const double gap = norm_of(near_.separation(position_[i], position_[j])) - diameter;
        if (gap < norm_of(path[i] - path[j]) + margin) {
            activate(i);
            activate(j);
        }
    }
    for (bool grown = !active_.empty(); grown;) {
        grown = false;
        for (const auto& [i, j] : pairs) {
            if ((slot_[i] == 0) == (slot_[j] == 0)) continue;
            const double gap = norm_of(near_.separation(position_[i], position_[j])) - diameter;
            if (gap < norm_of(path[i]) + norm_of(path[j]) + margin) grown |= activate(slot_[i] == 0 ? i : j);
        }
    }
    // In the order of the particles, so that sums do not depend on how the active ones were found.
    std::sort(active_.begin(), active_.end(), [](const Active& a, const Active& b) { return a.particle < b.particle; });
    for (std::size_t a = 0; a < active_.size(); ++a) slot_[active_[a].particle] = static_cast<std::uint32_t>(a + 1);
    list_contacts(pairs, 2 * longest + diameter);
}

// Lists all possible contacts of the active particles, with the memory of existing contacts.
void SpringContacts::list_contacts(const std::vector<Pair>& pairs, double reach) {
    remembered_.swap(contacts_);
    contacts_.clear();
    const auto less = [](const Contact& a, const Contact& b) { return std::pair(a.i, a.j) < std::pair(b.i, b.j); };
    const auto add = [&](std::uint32_t i, std::uint32_t j, std::uint32_t slot_j) {
        Contact contact;
        contact.i = i;
        contact.j = j;
        contact.slot_i = slot_[i] - 1;
        contact.slot_j = slot_j;
        const auto found = std::lower_bound(remembered_.begin(), remembered_.end(), contact, less);
        if (found != remembered_.end() && found->i == i && found->j == j) contact.memory = found->memory;
        contacts_.push_back(contact);
    };
    for (const auto& [i, j] : pairs)
        if (slot_[i] != 0 && slot_[j] != 0) add(i, j, slot_[j] - 1);
    for (const Active& one : active_)
        for (std::uint32_t d = 0; d < 3; ++d) {
            if (walls_.periodic[d]) continue;
            const double x = position_[one.particle][d];
            const bool high = x > 0.5 * (walls_.low[d] + walls_.high[d]);
            const double distance = high ? walls_.high[d] - x : x - walls_.low[d];
            if (distance < walls_.contact + reach) add(one.particle, wall_base + 2 * d + (high ? 1U : 0U), 0);
        }
    std::sort(contacts_.begin(), contacts_.end(), less);
}

void SpringContacts::touch(Contact& contact, const Vec3& n, double overlap, const Vec3& relative, double h) {
    Active& a = active_[contact.slot_i];
    const bool wall = contact.j >= wall_base;
    const double radius = sphere_.radius();
    Vec3 turning = spin_[contact.i];
    if (!wall) turning += spin_[contact.j];
    const Vec3 at_contact = relative - radius * cross_product(turning, n);
    const Vec3 slip = h * (at_contact - dot(at_contact, n) * n);
    const Vec3 force = spring_.push(overlap, contact.memory) * n;
    const Vec3 friction = spring_.drag(n, slip, contact.memory);
    const Vec3 torque = -radius * cross_product(n, friction);
    a.force += force + friction;
    a.torque += torque;
    if (wall) return;
    Active& b = active_[contact.slot_j];
    b.force -= force + friction;
    b.torque += torque;
}

void SpringContacts::push(Contact& contact, const Cloud& cloud, double h) {
    const Active& a = active_[contact.slot_i];
    Vec3 n{};
    double overlap = 0;
    Vec3 relative = cloud.velocity[contact.i];
    if (contact.j >= wall_base) {
        const auto d = static_cast<std::size_t>((contact.j - wall_base) / 2);
        const bool high = (contact.j - wall_base) % 2 == 1;
        n[d] = high ? -1 : 1;
        overlap = walls_.contact - (high ? walls_.high[d] - a.middle[d] : a.middle[d] - walls_.low[d]);
    } else {
        const Vec3 branch = near_.separation(a.middle, active_[contact.slot_j].middle);
        const double distance = norm_of(branch);
        overlap = 2 * sphere_.radius() - distance;
        if (overlap > 0) n = distance > 0 ? (1 / distance) * branch : Vec3{0, 0, 1};
        relative -= cloud.velocity[contact.j];
    }
    if (overlap > 0)
        touch(contact, n, overlap, relative, h);
    else
        contact.memory = {};
}

void SpringContacts::advance_active(Cloud& cloud, double time_step, std::vector<Vec3>& transmitted) {
    for (std::size_t p = 0; p < cloud.size(); ++p) {
        if (slot_[p] != 0) continue;
        transmitted[p] = (-sphere_.density_ratio / time_step) * (cloud.velocity[p] - velocity_[p]);
        walls_.apply(cloud.position[p], cloud.velocity[p]);
        ++idle_[p];
    }
    if (active_.empty()) return;
    const std::int64_t count = substeps(time_step);
    const double h = time_step / static_cast<double>(count);
    const double effective = sphere_.density_ratio + 0.5;
    const auto axis = static_cast<std::size_t>(sphere_.direction);
    const double rotation_rate = rotation_drag_ / inertia_;
    const double spin_decay = -std::expm1(-h * rotation_rate);
    std::vector<double> decay;
    for (Active& one : active_) {
        const std::uint32_t p = one.particle;
        cloud.position[p] = position_[p];
        cloud.velocity[p] = velocity_[p];
        const Surroundings& around = surroundings_[p];
        Vec3 pull = (1.5 / effective) * around.acceleration;
        pull[axis] += (sphere_.density_ratio - 1) * sphere_.acceleration * around.vibration / effective;
        one.limit = around.velocity + one.tau * pull;
        decay.push_back(-std::expm1(-h / one.tau));
        if (idle_[p] > 0) {
            const double idle = static_cast<double>(idle_[p]) * time_step * rotation_rate;
            spin_[p] += -std::expm1(-idle) * (one.rotation - spin_[p]);
        }
        idle_[p] = 0;
    }
    for (std::int64_t s = 0; s < count; ++s) {
        for (Active& one : active_) {
            one.middle = cloud.position[one.particle] + (0.5 * h) * cloud.velocity[one.particle];
            one.force = {};
            one.torque = {};
        }
        for (Contact& contact : contacts_) push(contact, cloud, h);
        for (std::size_t a = 0; a < active_.size(); ++a) {
            Active& one = active_[a];
            Vec3& x = cloud.position[one.particle];
            Vec3& v = cloud.velocity[one.particle];
            const Vec3 limit = one.limit + (one.tau / mass_) * one.force;
            const Vec3 excess = v - limit;
            x += h * limit + (one.tau * decay[a]) * excess;
            v -= decay[a] * excess;
            one.total += one.force;
            Vec3& spin = spin_[one.particle];
            spin += spin_decay * (one.rotation + (1 / rotation_drag_) * one.torque - spin);
        }
    }
    const double share = 1 / (sphere_.volume() * static_cast<double>(count));
    for (const Active& one : active_) {
        const std::uint32_t p = one.particle;
        transmitted[p] = share * one.total - (sphere_.density_ratio / time_step) * (cloud.velocity[p] - velocity_[p]);
        cloud.position[p] = walls_.clipped(cloud.position[p]);
    }
}

void SpringContacts::save(std::vector<std::byte>& into) const {
    append_bytes<Vec3>(into, spin_);
    append_bytes<std::int64_t>(into, idle_);
    ByteWriter(into).put(contacts_);
}

void SpringContacts::restore(std::span<const std::byte>& from) {
    take_bytes<Vec3>(from, spin_);
    take_bytes<std::int64_t>(from, idle_);
    contacts_.resize(take_count(from, sizeof(Contact)));
    take_bytes<Contact>(from, contacts_);
    const auto particles = spin_.size();
    for (const Contact& contact : contacts_) {
        const bool wall = contact.j >= wall_base && contact.j < wall_base + 6;
        require_possible(contact.i < particles && (wall || contact.j < particles));
    }
}

}  // namespace grainsweep::coupling
