#include "solver/dem/fast/mixed_stepping.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/dem/fast/listed_pairs.hpp"
#include "solver/dem/fast/mixed_engine.hpp"
#include "solver/dem/fast/residual.hpp"
#include "solver/dem/fast/wall_lists.hpp"
#include "solver/dem/shaking.hpp"

namespace grainsweep::dem::fast {

namespace {

// Skins with the lowest cost of lists. A listed pair without contact costs about 1.5 ns per step, and there are about
// ten per particle and diameter of inner skin. A refresh costs about 10 ns per particle, plus 1.5 ns per pair of the
// outer list. A rebuild costs about 100 ns per particle. For a skin s and a drift d per step, the costs per step are 15
// s + 10 d/s (inner) and 3 s + 100 d/s (outer, with a refresh about every five steps). They are smallest at s =
// sqrt(0.67 d) and s = sqrt(33 d).
constexpr double inner_balance = 0.45;
constexpr double outer_balance = 40;
constexpr double inner_skin_least = 0.004;
constexpr double outer_skin_least = 0.2, outer_skin_most = 0.7;

}  // namespace

/// Advances by whole steps, or by one part of a step.
void MixedEngine::advance(std::int64_t steps, bool one_part) {
    use_wanted_subdomains();
    bool advanced = false;  // the sweep before has moved the particles on
    for (std::int64_t s = 0; s < steps && fault_.empty();) {
        if (part_ == 0 && control_.take_parts()) take_parts();
        if (!advanced) {
            begin_tally();
            walls_.bound_velocities(wall_time(), true, tally_);
            advance_particles();
            advance_clumps();
        }
        const bool whole = ++part_ == control_.parts();
        if (whole) {
            part_ = 0;
            ++s;
            ++work_.steps;
            ++wall_steps_;
        }
        if (shaken_) shake();
        work_.particle_steps += static_cast<double>(mobile_);
        work_.resting_steps += static_cast<double>(resting_.count());
        account_travel();
        if (!fault_.empty()) return;
        if (crossings_.wanted()) follow_crossings();
        walls_.drift();
        stand_walls();
        make_lists();
        // Checks are made at the full step: no particle is advanced before.
        const bool energy = whole && watch_.due(work_.steps);
        const bool network = whole && control_.due(work_.steps, recent_overlap_, size());
        const bool ends = one_part || s == steps;
        const bool goes_on = std::exchange(advanced, !ends && !energy && !network);
        begin_tally();
        walls_.sum_up(ends);
        press_walls(true);
        sweep_pairs(goes_on && clumps_.empty(), advanced, false);
        if (advanced) advance_clumps();
        note_overlaps();
        recent_overlap_ = static_cast<double>(std::max(overlap(), tally_.wall_overlap));
        work_.pair_visits += field_.inner_count;
        if (beyond(sound_) && fault_.empty()) fault_ = describe_overlap(view(), tally_);
        if (suspicious() && fault_.empty()) fault_ = unsound_contact(view(), advanced);
        if (energy && fault_.empty()) check_energy();
        if (network && fault_.empty()) check_network();
        if (one_part) return;
    }
}

/// Compares the length of a part with the longest stable step of the present contacts.
void MixedEngine::check_network() {
    join_lists();
    const auto& lasting = control_.lasting();
    const std::vector<Velocities> before = lasting.empty() ? std::vector<Velocities>{} : motions(0);
    const ContactReader reader(laws_, space_, field_, columns_.id.data(), before, kernels_->width, resting_.parked(),
                               before, &clumps_);
    reader.network(walls_, wall_time(), lasting, network_);
    if (!control_.look(network_, space_.scale.time, recent_overlap_)) return;
    const StepShare found = network_.share(space_.scale.time);
    if (!control_.judge(found, network_)) return;
    std::vector<ContactForce> all;
    contacts(all);
    fault_ = describe(view(),
                      flaw_of_step(found, space_.scale.time, all, columns_.id[static_cast<std::size_t>(found.sphere)]),
                      found.sphere);
}

/// Continues with another number of parts: the state in units of the new part, forces computed anew.
void MixedEngine::take_parts() {
    join_lists();
    full_step_velocities();
    const double before = space_.scale.time;
    const Scale old = space_.scale;
    use_parts();
    const auto factor = static_cast<float>(space_.scale.time / before);  // a power of two: exact
    for (std::int32_t i = 0; i < field_.count; ++i) {
        Record& r = field_.records[i];
        Residual residual = residual_of(field_, i);
        for (int a = 0; a < 3; ++a) {
            r.velocity[a] *= factor;
            residual.velocity[a] *= factor;
            set_spin(field_, i, a, factor * r.spin[a]);
        }
        leave_over(field_, i, residual);
    }
    const auto& memory = laws_.front()->traits().memory;
    std::vector<float> converted(memory.size(), 1);
    for (std::size_t m = 0; m < memory.size(); ++m) {
        const auto of_unit =
            static_cast<float>(unit_of(memory[m].dimension, old) / unit_of(memory[m].dimension, space_.scale));
        converted[m] = of_unit;
        if (of_unit == 1) continue;
        for (auto* column : {&columns_.history[m], &columns_.wall_history[m], &columns_.touch_memory[m]})
            for (std::size_t k = 0; k < column->capacity(); ++k) (*column)[k] *= of_unit;
    }
    resting_.convert_parked(factor * factor, converted);
    restart_forces();
    watch_.restart_balance();
}

/// Sets all units to the length of a part.
void MixedEngine::use_parts() {
    space_.scale.time = time_step_ / static_cast<double>(control_.parts());
    for (int a = 0; a < 3; ++a)
        field_.constants.gravity[a] = gravity_in_steps(gravity_[static_cast<std::size_t>(a)], space_.scale);
    write_law_constants(needs_.combination, table_.pairs().front(), space_.scale, field_.constants.laws);
    write_pair_laws();
    walls_.use_scale(space_.scale, table_);
    watch_.use_scale(space_.scale);
    resting_.use_scale(space_.scale, rest_speed_, geometry::norm(gravity_));
    resolved_ = resolved_in_parts_[static_cast<std::size_t>(control_.state().halvings)];
    if (!contacts_differ_) sound_ = resolved_;
}

/// Rebuilds or refreshes the lists where displacements since demand it. A pair outside the outer list had a gap
/// above its skin and has lost at most the drift since; likewise the inner list.
void MixedEngine::make_lists(std::span<const std::int32_t> removed) {
    const bool rebuilt =
        !(drift_.outer < static_cast<double>(space_.skin)) || (needs_.resting && drift_.steps >= rest_interval);
    if (!rebuilt && drift_.inner < static_cast<double>(inner_skin_)) return;
    const bool cut_anew = !rebuilt && subdomains_.uneven();
    if (cut_anew) {
        join_lists();
        subdomains_.mark_touching(field_, columns_);
        subdomains_.cut_up(field_, columns_, false);
    }
    if (rebuilt) {
        const double per_step = drift_.steps > 0 ? drift_.outer / static_cast<double>(drift_.steps) : 0.003;
        if (adapts_skin_)
            space_.skin = std::min(
                static_cast<float>(std::clamp(std::sqrt(outer_balance * per_step), outer_skin_least, outer_skin_most)),
                largest_skin_);
        const bool may_meet = needs_.frozen && walls_.any_free();
        if (adapts_skin_ && may_meet) space_.skin = std::min(space_.skin, smallest_diameter_ / 2);
        const std::int32_t before = field_.count;
        join_lists();
        const Parts parts = subdomains_.parts();
        rebuild(field_, columns_, *kernels_, space_, walls_, removed, needs_.resting ? &resting_ : nullptr,
                drift_.steps, parts, clumps_.shapes() > 0 ? &clumps_ : nullptr, static_cast<std::size_t>(ids()));
        touches_.reorder(field_, columns_);
        touches_.list(field_, walls_, space_.scale, static_cast<double>(space_.skin), parts);
        parts.run_shares(field_.count, [this](Range range) {  // carried data belong to the old order
            for (std::int32_t i = range.begin; i < range.end; ++i) field_.forces[i] = cleared(field_.forces[i]);
        });
        if (field_.count < before) watch_.restart_balance();
        list_advanced();
        mobile_ = parts
                      .counted(field_.count,
                               [this](Range range) {
                                   return static_cast<std::int32_t>(
                                       std::count_if(field_.records + range.begin, field_.records + range.end,
                                                     [](const Record& r) { return r.inverse_mass > 0; }));
                               })
                      .back();
        subdomains_.cut_up(field_, columns_, false);
        drift_.outer = 0;
        drift_.steps = 0;
        if (crossings_.wanted()) list_crossings();
        if (may_meet && fault_.empty()) fault_ = describe_frozen(view());
        ++work_.rebuilds;
    }
    inner_skin_ = static_cast<float>(
        std::clamp(std::sqrt(inner_balance * drift_.last_step), inner_skin_least, static_cast<double>(space_.skin)));
    if (subdomains_.cut()) {
        refresh_ = Refresh{inner_skin_, rebuilt || cut_anew};
    } else {
        refresh(field_, columns_, *kernels_, inner_skin_, rebuilt);
        field_.fetch_ahead = distance_to_fetch(field_);
    }
    drift_.inner = 0;
}

int MixedEngine::set_threads(int count) {
    threads_.most = count;
    subdomains_.use(threads_);
    return subdomains_.wanted(field_.count);
}

/// After a change of the number of threads, or a restored state; all other changes come with new lists.
void MixedEngine::use_wanted_subdomains() {
    if (subdomains_.wanted(field_.count) == subdomains_.count()) return;
    join_lists();
    field_.fetch_ahead = distance_to_fetch(field_);
    subdomains_.cut_up(field_, columns_, true);
}

void MixedEngine::advance_particles() {
    if (subdomains_.cut())
        subdomains_.advance(field_, tally_);
    else
        kernels_->advance(field_, tally_);
}

/// Forces of all pairs, and where `advance` the next positions. `goes_on`: see Subdomains. `keep_histories`: those of
/// contacts stay as they were.
void MixedEngine::sweep_pairs(bool goes_on, bool advance, bool keep_histories) {
    if (subdomains_.cut()) {
        subdomains_.sweep(field_, std::exchange(refresh_, std::nullopt), goes_on, advance, keep_histories, tally_);
        return;
    }
    kernels_->sweep(field_, advance, tally_);
    if (!keep_histories) columns_.swap_histories(field_);
}

/// Sets the walls to their present places.
void MixedEngine::stand_walls() {
    walls_.place(wall_time());
    field_.walls = walls_.placed();
    field_.wall_count = static_cast<std::int32_t>(walls_.count());
}

/// Forces of the walls. `moves`: as part of a step.
void MixedEngine::press_walls(bool moves) {
    touches_.find(field_, columns_, walls_, *kernels_, space_.scale, drift_.outer, subdomains_.parts());
    shared_walls_.press(field_, *kernels_, walls_, subdomains_, tally_);
    watch_.add_wall_work(walls_.book(field_.wall_sums, moves));
    if (!moves) return;
    walls_.kick(wall_time(), 1);
    walls_.bound_velocities(wall_time(), true, tally_);
    const double smallest_radius = 0.5 * static_cast<double>(smallest_diameter_);
    if (const auto passage =
            touches_.passage(field_, walls_, space_.scale, wall_time(), drift_.last_step, smallest_radius))
        fault_ = describe(view(), "the centre of a particle passed through wall " + std::to_string(passage->wall),
                          passage->particle);
}

void MixedEngine::list_advanced() {
    if (needs_.skips)
        columns_.list_advanced(field_,
                               [this](std::int32_t i) { return is_frozen(i) || is_resting(i) || is_member(i); });
}

/// Finds the members of all clumps among the records.
void MixedEngine::map_clumps() {
    if (!clumps_.map(field_, columns_, *kernels_, static_cast<std::size_t>(ids()), space_.scale))
        throw std::logic_error("a clump lacks a member");
}

/// Steps all clumps by the forces on their members.
void MixedEngine::advance_clumps() {
    clumps_.advance(field_, *kernels_, space_.scale, gravity_, acceleration_, subdomains_.parts(), tally_);
}

/// Before the next rebuild no particle moves by more than the skin, and one step more (travel_limit).
void MixedEngine::list_crossings() {
    crossings_.list(
        size() + clumps_.size(), (static_cast<double>(space_.skin) + travel_limit) * space_.scale.length,
        [this](std::size_t i) {
            return i >= size() || (field_.records[i].inverse_mass > 0 && !is_member(static_cast<std::int32_t>(i)));
        },
        [this](std::size_t i) { return place_to_follow(i); });
}

/// Of a record, or of a clump, which follow them.
Vec3 MixedEngine::place_to_follow(std::size_t i) const {
    return i < size() ? position_of(field_.records[i], space_.scale) : clumps_.position[i - size()];
}

void MixedEngine::follow_crossings() {
    const double parts = static_cast<double>(control_.parts());
    crossings_.follow(
        static_cast<double>(work_.steps) + static_cast<double>(part_) / parts, 1 / parts,
        [this](std::size_t i) { return i < size() ? columns_.id[i] : clumps_.first[i - size()]; },
        [this](std::size_t i) { return place_to_follow(i); });
}

/// Adds the displacement of the step just made.
void MixedEngine::account_travel() {
    double square = 0;
    float fastest = 0;
    bool finite = true;
    for (int a = 0; a < 3; ++a) {
        const float high = tally_.velocity_high[a], low = tally_.velocity_low[a];
        const double spread = field_.count > 0 ? static_cast<double>(high) - static_cast<double>(low) : 0;
        square += spread * spread;
        fastest = std::max({fastest, std::abs(high), std::abs(low)});
        finite = finite && std::isfinite(spread);
    }
    drift_.last_step = std::sqrt(square) * (1 + 1e-6);
    ++drift_.steps;
    drift_.outer += drift_.last_step;
    drift_.inner += drift_.last_step;
    if (field_.count > 0 && (!finite || !(fastest < static_cast<float>(travel_limit) * smallest_diameter_)))
        fault_ = describe_fast_body(view());
    else if (watch_.too_fast(static_cast<double>(fastest)))
        fault_ = describe_faster_than(view(), watch_.speed_limit());
    watch_.add_travel(static_cast<double>(fastest));
}

/// The velocities whose spread bounds relative displacements: particles', walls', and rest where something rests. Those
/// of free walls come once their speeds of the next step are known.
void MixedEngine::begin_tally() {
    const bool rest = box_includes_rest_ || walls_.count() > 0;
    for (int a = 0; a < 8; ++a) {
        tally_.velocity_high[a] = rest ? 0 : -std::numeric_limits<float>::infinity();
        tally_.velocity_low[a] = rest ? 0 : std::numeric_limits<float>::infinity();
    }
    walls_.bound_velocities(wall_time(), false, tally_);
    tally_.overlap = tally_.wall_overlap = 0;
    for (auto& unused : tally_.unused) unused = 0;
}

/// Gives the constants the acceleration of the present step: gravity and the body force of shaking.
void MixedEngine::shake() {
    const Vec3 b = shaking_acceleration(shaking_, space_.scale.time, work_.steps * control_.parts() + part_);
    for (std::size_t a = 0; a < 3; ++a)
        field_.constants.gravity[a] = gravity_in_steps(gravity_[a] + b[a], space_.scale);
    for (std::size_t a = 0; a < 3; ++a) acceleration_[a] = gravity_[a] + b[a];
}

/// Change of velocity over half a step by the forces at hand, engine's units.
double MixedEngine::half_change(std::int32_t i, int a) const {
    const Record& r = field_.records[i];
    if (!(r.inverse_mass > 0) || is_resting(i) || is_member(i)) return 0;
    return 0.5 * (static_cast<double>(field_.forces[i].force[a]) * static_cast<double>(r.inverse_mass) +
                  static_cast<double>(field_.constants.gravity[a]));
}

double MixedEngine::half_spin_change(std::int32_t i, int a) const {
    if (is_resting(i) || is_member(i)) return 0;
    const Record& r = field_.records[i];
    const double inertia = 0.4 * static_cast<double>(r.radius) * static_cast<double>(r.radius);
    return 0.5 * static_cast<double>(field_.forces[i].torque[a]) * static_cast<double>(r.inverse_mass) / inertia;
}

/// Moves velocities and spins of particles by half a step, forwards (1) or back (-1).
void MixedEngine::shift_velocities(double way) {
    for (std::int32_t i = 0; i < field_.count; ++i) {
        Record& r = field_.records[i];
        Residual residual = residual_of(field_, i);
        for (int a = 0; a < 3; ++a) {
            const double v = static_cast<double>(r.velocity[a]) + static_cast<double>(residual.velocity[a]) +
                             way * half_change(i, a);
            r.velocity[a] = static_cast<float>(v);
            residual.velocity[a] = static_cast<float>(v - static_cast<double>(r.velocity[a]));
            set_spin(field_, i, a, static_cast<float>(static_cast<double>(r.spin[a]) + way * half_spin_change(i, a)));
        }
        leave_over(field_, i, residual);
    }
}

/// Moves the stored half-step velocities to the full step, and clears the forces.
void MixedEngine::full_step_velocities() {
    clumps_.gather(field_, space_.scale);
    clumps_.shift(0.5, space_.scale.time, acceleration_);
    shift_velocities(1);
    for (std::int32_t i = 0; i < field_.count; ++i) {
        const Residual residual = residual_of(field_, i);
        field_.forces[i] = Force{};
        leave_over(field_, i, residual);
    }
    clumps_.write_motions(field_, space_.scale);
    walls_.kick(wall_time(), -0.5);  // they are half a step ahead of the forces
}

/// Restarts the leapfrog: makes the lists anew, computes forces at the present full-step velocities without changing
/// histories, and sets velocities back by half a step.
void MixedEngine::restart_forces(std::span<const std::int32_t> removed) {
    stand_walls();
    drift_ = Drift{};
    make_lists(removed);
    begin_tally();
    field_.history_step = 0;
    walls_.sum_up(true);
    press_walls(false);
    sweep_pairs(false, false, true);
    field_.history_step = 1;
    note_overlaps();
    shift_velocities(-1);
    clumps_.gather(field_, space_.scale);
    clumps_.shift(-0.5, space_.scale.time, acceleration_);
    clumps_.write_motions(field_, space_.scale);
    walls_.kick(wall_time(), 0.5);
    if (beyond(sound_)) fault_ = describe_overlap(view(), tally_);
    if (suspicious() && fault_.empty()) fault_ = unsound_contact(view(), false);
}

void MixedEngine::set_walls(std::vector<Wall> walls) {
    Walls fresh(walls, space_.domain, space_.scale, needs_.combination, table_, materials_);
    full_step_velocities();
    if (needs_.resting) resting_.advance_all(field_);
    walls_ = std::move(fresh);
    wall_steps_ = 0;
    columns_.hold_particles(size(), walls_.count());
    columns_.bind(field_);
    for (std::size_t w = 0; w < walls_.count(); ++w) columns_.segments[w] = {0, 0};
    touches_.begin(field_, columns_, walls_, space_.scale);
    watch_.forget_wall_work();
    restart_forces();
    set_limits();
}

void MixedEngine::change_walls(std::vector<Wall> walls) {
    std::vector<MovingWall> changed = walls_.moving_as(walls, space_.domain);
    full_step_velocities();
    if (needs_.resting) resting_.advance_all(field_);
    walls_.take(std::move(changed), wall_time());
    restart_forces();
    set_limits();
}

void MixedEngine::add(std::span<const Sphere> spheres, std::span<const Body> bodies) {
    require_announced(to_come_, spheres, static_cast<std::size_t>(ids()));
    dem::require_possible(bodies, announced_, spheres);
    if (spheres.empty() || !fault_.empty()) return;
    join_lists();
    full_step_velocities();
    // What fills wall contacts up lies behind the particles; it must not become one of those added.
    const std::int32_t before = field_.count;
    const auto added = static_cast<std::int32_t>(spheres.size());
    for (std::int32_t k = 0; k < wall_contacts(field_); ++k)
        if (Place& place = field_.wall_particle[k]; index_at(place) >= before)
            place = place_at(index_at(place) + added);
    append(spheres, bodies, ids());
    for (std::int32_t i = before; i < field_.count; ++i) {
        watch_.begin(field_.records[i]);
        added_.push_back(columns_.kind[static_cast<std::size_t>(i)]);
    }
    map_clumps();
    resting_.advance_also(spheres.size());
    restart_forces();
    set_limits();
}

void MixedEngine::remove(std::span<const std::int32_t> ids) {
    full_step_velocities();
    restart_forces(ids);
}

}  // namespace grainsweep::dem::fast
