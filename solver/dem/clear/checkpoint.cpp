// State of the clear engine: reported in order of id, and written so that it continues bit for bit.
//
// The order of particles and of the neighbour list decides the order of sums, so both are part of a checkpoint.
#include "solver/dem/clear/engine.hpp"
#include "solver/dem/walls/wall_bytes.hpp"

#include <algorithm>

namespace grainsweep::dem::clear {

inline constexpr std::uint64_t checkpoint_format = 0x6772'6e73'636c'000fULL;  // "grnscl", version 15

void ClearEngine::state(State& into) const {
    std::vector<std::uint32_t> place(ids(), particles::gone);
    for (std::uint32_t i = 0; i < p_.size(); ++i) place[static_cast<std::size_t>(p_.id[i])] = i;
    const std::size_t n = p_.size();
    into.id.resize(n);
    into.position.resize(n);
    into.velocity.resize(n);
    into.angular_velocity.resize(n);
    into.radius.resize(n);
    into.mobile.resize(n);
    into.bodies.clear();
    for (std::size_t b = 0; b < bodies_.size(); ++b) into.bodies.push_back(bodies_.state(b));
    std::ranges::sort(into.bodies, {}, &BodyState::first);
    std::size_t k = 0;
    for (std::size_t id = 0; id < place.size(); ++id) {
        const std::uint32_t i = place[id];
        if (i == particles::gone) continue;
        into.id[k] = static_cast<std::int32_t>(id);
        into.position[k] = p_.position[i];
        into.velocity[k] = p_.velocity[i];
        into.angular_velocity[k] = p_.angular_velocity[i];
        into.radius[k] = radius(i);
        into.mobile[k] = mobile(i) ? 1 : 0;
        ++k;
    }
}

template <class Self, class Visit>
void ClearEngine::visit_state(Self& self, Visit&& visit) {
    particles::Particles::for_each_column(self.p_, visit);
    Bodies::for_each_column(self.bodies_, visit);
    visit(self.bodies_.offset);
    visit(self.added_);
    visit(self.position_at_build_);
    visit(self.near_open_face_);
    visit(self.pairs_.value);
    visit(self.pairs_.live);
    visit(self.wall_steps_);
    visit(self.parts_done_);
    visit(self.displaced_);
    visit(self.largest_overlap_);
    visit(self.peak_overlap_);
    visit(self.largest_wall_overlap_);
    visit(self.peak_wall_overlap_);
    visit(self.speed_limit_);
    visit(self.work_of_walls_);
    visit(self.work_of_wrapping_);
    visit(self.work_of_shaking_);
    visit(self.balance_);
    visit(self.fault_);
    visit(self.work_.steps);
    visit(self.work_.particle_steps);
    visit(self.work_.pair_visits);
    visit(self.work_.rebuilds);
}

void ClearEngine::save(std::vector<std::byte>& into) const {
    into.clear();
    ByteWriter out(into);
    out.put(checkpoint_format);
    out.put(constants());
    out.put(static_cast<std::uint64_t>(spheres_at_start_));
    out.put(time_step_);
    out.put(shaking_);
    out.put(control_.state());
    out.put(control_.lasting());
    visit_state(*this, [&out](const auto& value) { out.put(value); });
    list_.save(out);
    out.put(static_cast<std::uint64_t>(walls_.size()));
    for (const auto& contacts : walls_) {
        write_wall(contacts.wall.wall(), [&out](const auto& value) { out.put(value); });
        out.put(contacts.near);
        out.put(contacts.built);
        if (contacts.wall.free()) out.put(contacts.pose_when_built);
        MovingWall::for_each_sum(contacts.wall, [&out](const auto& value) { out.put(value); });
        std::vector<std::uint32_t> entries;
        std::vector<double> distances;
        std::vector<Vec3> normals;
        for (const WallTouch& touch : contacts.touches) {
            entries.push_back(touch.entry);
            distances.push_back(touch.place.distance);
            normals.push_back(touch.place.normal);
        }
        out.put(entries);
        out.put(distances);
        out.put(normals);
        out.put(contacts.memory);
        out.put(contacts.load);
        out.put(contacts.load_about);
    }
}

/// Refuses impossible states, for any bytes: every index must be valid, every column must have its length, and
/// positions must be within the cells. Too fast particles and too large overlaps are found later, by the steps.
void ClearEngine::require_possible() const {
    constexpr auto require = ByteReader::require;
    constexpr std::int64_t most_steps = std::int64_t{1} << 53U;
    const std::size_t n = p_.size();
    require(n <= ids());
    for (const std::uint8_t kind : added_) require(std::ranges::count(to_come_, kind, &ToCome::kind) > 0);
    particles::Particles::for_each_column(p_, [&](const auto& column) { require(column.size() == n); });
    require(position_at_build_.size() == n);
    std::vector<bool> known(ids(), false);
    for (std::size_t i = 0; i < n; ++i) {
        const auto id = static_cast<std::size_t>(p_.id[i]);
        require(p_.id[i] >= 0 && id < ids() && !known[id]);
        known[id] = true;
        require(id < spheres_at_start_ || p_.kind[i] == added_[id - spheres_at_start_]);
        require(geometry::finite(p_.position[i]) && geometry::finite(p_.velocity[i]) &&
                geometry::finite(position_at_build_[i]));
        for (std::size_t k = 0; k < 3; ++k)
            require(std::abs(p_.position[i][k] - domain_.low[k]) <= 4 * domain_.length(k));
    }
    for (const auto i : near_open_face_) require(i < n);
    require(pairs_.value.size() == list_.size() * memories() && pairs_.live.size() == list_.size());
    for (const auto& contacts : walls_) {
        std::uint32_t least = 0;  // listed in ascending order
        for (const auto i : contacts.near) {
            require(i < n && i >= least && mobile(i));
            least = i + 1;
        }
        least = 0;
        for (const auto& touch : contacts.touches) {
            require(touch.entry < contacts.near.size() && touch.entry >= least);
            least = touch.entry;
        }
        require(contacts.memory.size() == contacts.touches.size() * memories());
    }
    require(wall_steps_ >= 0 && wall_steps_ < most_steps && work_.steps >= 0 && work_.steps < most_steps &&
            parts_done_ >= 0 && parts_done_ < control_.parts());
}

/// Finds members, and refuses bodies that no step makes.
void ClearEngine::map_restored_bodies() {
    constexpr auto require = ByteReader::require;
    require(bodies_.possible());
    require(bodies_.empty() || bodies_.offset.size() == p_.size());
    bodies_.derive();
    require(bodies_.map(p_.id, ids()));
    for (std::size_t i = 0; i < p_.size(); ++i) {
        const double inverse = p_.inverse_mass[i];
        require(bodies_.is_member(i) ? inverse == 1 / bodies_.mass[bodies_.body_of(i)]
                                     : inverse >= inverse_masses_.first && inverse <= inverse_masses_.second);
    }
}

void ClearEngine::restore_walls(ByteReader& in) {
    std::uint64_t walls = 0;
    in.get(walls);
    walls_.clear();
    for (std::uint64_t w = 0; w < walls; ++w) {
        auto made = make_walls({read_wall([&in](auto& value) { in.get(value); })});
        Contacts& contacts = made.front();
        in.get(contacts.near);
        in.get(contacts.built);
        in.require(std::isfinite(contacts.built));
        contacts.pose_when_built = contacts.wall.pose_at(contacts.built);
        if (contacts.wall.free()) in.get(contacts.pose_when_built);
        MovingWall::for_each_sum(contacts.wall, [&in](auto& value) { in.get(value); });
        std::vector<std::uint32_t> entries;
        std::vector<double> distances;
        std::vector<Vec3> normals;
        in.get(entries);
        in.get(distances);
        in.get(normals);
        in.require(entries.size() == distances.size() && entries.size() == normals.size());
        for (std::size_t k = 0; k < entries.size(); ++k)
            contacts.touches.push_back({entries[k], {distances[k], normals[k]}});
        in.get(contacts.memory);
        in.get(contacts.load);
        in.get(contacts.load_about);
        contacts.wall.place(wall_time());
        walls_.push_back(std::move(contacts));
    }
}

void ClearEngine::restore(std::span<const std::byte> from) {
    ByteReader in(from);
    const auto expect = [&in](const auto& mine) {
        auto theirs = mine;
        in.get(theirs);
        if (std::memcmp(&theirs, &mine, sizeof mine) != 0)
            throw std::invalid_argument("checkpoint of another engine or another setup");
    };
    expect(checkpoint_format);
    std::vector<double> of_laws;
    in.get(of_laws);
    if (of_laws != constants()) throw std::invalid_argument("checkpoint of other laws or another material");
    expect(static_cast<std::uint64_t>(spheres_at_start_));
    expect(time_step_);
    expect(shaking_);
    StepControl::State control;
    in.get(control);
    std::vector<std::uint64_t> lasting;
    in.get(lasting);
    in.require(control_.restore(control, std::move(lasting)));
    use_parts();
    visit_state(*this, [&in](auto& value) { in.get(value); });
    const auto within = [&in](const std::vector<double>& column, double least, double most) {
        for (const double x : column) in.require(x >= least && x <= most);
    };
    within(p_.radius, radii_.smallest, radii_.largest);
    for (const std::uint8_t kind : p_.kind) in.require(kind < table_.kinds());
    list_.restore(in, p_.size());
    restore_walls(in);
    in.finish();
    require_possible();
    map_restored_bodies();
    crossings_.forget();
    if (crossings_.wanted()) list_crossings();
    if (shaken_) shake();
}

}  // namespace grainsweep::dem::clear
