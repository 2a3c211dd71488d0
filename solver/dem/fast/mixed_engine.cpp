#include "solver/dem/fast/mixed_engine.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "solver/dem/fast/checkpoint.hpp"
#include "solver/dem/fast/columns.hpp"
#include "solver/dem/fast/contact_reader.hpp"
#include "solver/dem/fast/faults.hpp"
#include "solver/dem/fast/rebuild.hpp"
#include "solver/dem/fast/scale.hpp"
#include "solver/dem/fast/watch.hpp"
#include "solver/dem/shaking.hpp"

namespace grainsweep::dem::fast {

namespace {

/// Relative displacements since the lists were made, and how often; in largest diameters.
struct Drift {
    double outer = std::numeric_limits<double>::infinity();
    double inner = std::numeric_limits<double>::infinity();
    double last_step = 0;
    std::int64_t steps = 0;  ///< since the outer list was made
};

// The skins that make lists cheapest. A pair listed in vain costs about 1.5 ns a step and there are about ten per
// diameter of inner skin and particle; a refresh costs about 10 ns per particle, plus 1.5 ns per pair of the outer
// list; a rebuild about 100 ns. With drift d per step the sums of cost per step, 15 s + 10 d/s and (refreshing every
// five steps or so) 3 s + 100 d/s, are least at s = sqrt(0.67 d) and s = sqrt(33 d).
constexpr double inner_balance = 0.45;
constexpr double outer_balance = 40;
constexpr double inner_skin_least = 0.004;
constexpr double outer_skin_least = 0.2, outer_skin_most = 0.7;

/// Beyond these records no longer fit the nearer caches and are fetched ahead of their use; below, asking costs more
/// than it gains.
constexpr std::size_t many_particles = 40000;

const Kernels& kernels_of(Method::Path path, const Needs& needs) {
    switch (path) {
        case Method::Path::avx512:
            return avx512_kernels(needs);
        case Method::Path::avx2:
            return avx2_kernels(needs);
        default:
            return baseline_kernels(needs);
    }
}

class MixedEngine final : public Engine {
public:
    MixedEngine(const Setup& setup, Method::Path path, double skin);

    void run(std::int64_t steps) override;
    void set_walls(std::vector<Wall> walls) override;
    void remove(std::span<const std::int32_t> ids) override;
    [[nodiscard]] std::size_t size() const override { return static_cast<std::size_t>(field_.count); }
    [[nodiscard]] double wall_time() const override { return static_cast<double>(wall_steps_) * room_.scale.time; }
    void state(State& into) const override;
    [[nodiscard]] double largest_overlap() const override { return static_cast<double>(tally_.overlap); }
    [[nodiscard]] double peak_overlap() const override { return static_cast<double>(peak_overlap_); }
    void forget_peak_overlap() override { peak_overlap_ = 0; }
    void contacts(std::vector<ContactForce>& into) const override;
    [[nodiscard]] const std::string& fault() const override { return fault_; }
    [[nodiscard]] Work work() const override { return work_; }
    void save(std::vector<std::byte>& into) const override;
    void restore(std::span<const std::byte> from) override;

private:
    void load(const Setup& setup);
    void check_walls(const std::vector<Wall>& walls) const;
    void begin_tally();
    [[nodiscard]] std::vector<Motion> motions() const;
    [[nodiscard]] Moment moment(std::span<const Motion> motions) const;
    void learn_limits();
    void check_energy();
    void account_travel();
    void make_lists(std::span<const std::int32_t> removed = {});
    void full_step_velocities();
    void restart_forces(std::span<const std::int32_t> removed = {});
    void shake();
    [[nodiscard]] Seal seal() const;
    [[nodiscard]] double half_change(std::int32_t particle, int axis) const;
    [[nodiscard]] double half_spin_change(std::int32_t particle, int axis) const;
    [[nodiscard]] Sight sight() const {
        return {field_, columns_.id.data(), room_.scale, smallest_diameter_, sound_, work_.steps};
    }
    [[nodiscard]] bool too_deep() const { return tally_.overlap > sound_.pair || tally_.wall_overlap > sound_.wall; }
    template <class Self, class Archive>
    static void pass(Self& self, Archive& archive);

    Room room_;
    Material material_;
    Vec3 gravity_;
    Shaking shaking_;
    bool shaken_;
    Needs needs_;
    const Kernels* kernels_;
    std::vector<Wall> walls_;
    float smallest_diameter_ = 1;
    SoundOverlaps sound_;
    bool box_includes_rest_ = true;  ///< something at rest, or a face, bounds displacements besides the particles

    Watch watch_;
    Columns columns_;
    Field field_{};
    Tally tally_{};
    float peak_overlap_ = 0;  ///< largest of tally_.overlap so far
    Drift drift_;
    float inner_skin_ = 0;
    float largest_skin_ = std::numeric_limits<float>::infinity();
    bool adapts_skin_;
    std::int64_t wall_steps_ = 0;
    std::int64_t mobile_ = 0;
    Work work_;
    std::string fault_;
};

MixedEngine::MixedEngine(const Setup& setup, Method::Path path, double skin)
    : room_{setup.domain, make_scale(setup), 0.3F},
      material_(setup.material),
      gravity_(setup.gravity),
      shaking_(setup.shaking),
      shaken_(!is_still(setup.shaking)),
      needs_(make_needs(setup)),
      kernels_(&kernels_of(path, needs_)),
      walls_(setup.walls),
      sound_(sound_overlaps(setup)),
      watch_(setup, room_.scale),
      adapts_skin_(!(skin > 0)) {
    check_walls(walls_);
    for (std::size_t a = 0; a < 3; ++a)  // a pair must not meet across both ends of a period
        if (setup.domain.periodic[a]) {
            const double period = (setup.domain.high[a] - setup.domain.low[a]) / room_.scale.length;
            largest_skin_ = std::min(largest_skin_, static_cast<float>(0.5 * period - 1));
        }
    if (skin > 0) room_.skin = static_cast<float>(skin / room_.scale.length);
    room_.skin = std::min(room_.skin, largest_skin_);
    field_.constants = make_constants(setup, room_.scale);
    columns_.histories = needs_.rolling ? histories_at_most : 3;
    load(setup);
    restart_forces();
    learn_limits();
}

void MixedEngine::load(const Setup& setup) {
    const auto n = setup.spheres.size();
    columns_.hold_particles(n, walls_.size());
    columns_.hold_pairs(8 * n);
    columns_.hold_wall_contacts(n);
    columns_.bind(field_);
    field_.count = static_cast<std::int32_t>(n);
    field_.read_ahead = n > many_particles ? 1 : 0;
    const Scale& s = room_.scale;
    const bool all_periodic = setup.domain.periodic[0] && setup.domain.periodic[1] && setup.domain.periodic[2];
    box_includes_rest_ = !all_periodic || needs_.frozen;
    for (std::size_t i = 0; i < n; ++i) {
        const Sphere& sphere = setup.spheres[i];
        Record& r = columns_.records[i];
        Residual& residual = columns_.residuals[i];
        const double radius = sphere.radius / s.length;
        r.radius = r.radius_again = static_cast<float>(needs_.unequal ? radius : 0.5);
        r.inverse_radius = 1 / r.radius;
        r.inverse_mass = sphere.mobile ? static_cast<float>(1 / (8 * radius * radius * radius)) : 0.0F;
        smallest_diameter_ = std::min(smallest_diameter_, 2 * r.radius);
        columns_.id[i] = static_cast<std::int32_t>(i);
        for (int a = 0; a < 3; ++a) {
            const auto axis = static_cast<std::size_t>(a);
            double units = s.units(sphere.position[axis], axis);
            if (setup.domain.periodic[axis])
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
            r.spin[a] = static_cast<float>(sphere.angular_velocity[axis] * s.time);
            r.surface[a] = r.spin[a] * r.radius;
        }
    }
    place_fillers(field_);
}

void MixedEngine::check_walls(const std::vector<Wall>& walls) const {
    for (const Wall& wall : walls) {
        if (const auto* plane = std::get_if<Plane>(&wall)) {
            const double norm = std::hypot(plane->normal[0], plane->normal[1], plane->normal[2]);
            if (!(norm > 0) || !std::isfinite(norm)) throw std::invalid_argument("a plane's normal must not be zero");
            for (std::size_t a = 0; a < 3; ++a)
                if (room_.domain.periodic[a] && std::abs(plane->normal[a]) > 1e-12 * norm)
                    throw std::invalid_argument("a plane must not cut a periodic axis");
        } else {
            const auto& blade = std::get<Blade>(wall);
            if (!(blade.thickness > 0) || !(blade.top > blade.bottom) || room_.domain.periodic[2])
                throw std::invalid_argument(
                    "a blade needs a positive thickness, its top above its bottom and an open z axis");
        }
    }
}

/// Gives the constants the acceleration of the present step: gravity and the body force of shaking.
void MixedEngine::shake() {
    const Vec3 b = shaking_acceleration(shaking_, room_.scale.time, work_.steps);
    for (std::size_t a = 0; a < 3; ++a) field_.constants.gravity[a] = gravity_in_steps(gravity_[a] + b[a], room_.scale);
}

/// Change of velocity over half a step by the forces at hand, engine's units.
double MixedEngine::half_change(std::int32_t i, int a) const {
    const Record& r = field_.records[i];
    if (!(r.inverse_mass > 0)) return 0;
    return 0.5 * (static_cast<double>(field_.forces[i].force[a]) * static_cast<double>(r.inverse_mass) +
                  static_cast<double>(field_.constants.gravity[a]));
}

double MixedEngine::half_spin_change(std::int32_t i, int a) const {
    const Record& r = field_.records[i];
    const double inertia = 0.4 * static_cast<double>(r.radius) * static_cast<double>(r.radius);
    return 0.5 * static_cast<double>(field_.forces[i].torque[a]) * static_cast<double>(r.inverse_mass) / inertia;
}

/// Moves the stored half-step velocities to the full step, and forgets the forces.
void MixedEngine::full_step_velocities() {
    for (std::int32_t i = 0; i < field_.count; ++i) {
        Record& r = field_.records[i];
        Residual& residual = field_.residuals[i];
        for (int a = 0; a < 3; ++a) {
            const double v =
                static_cast<double>(r.velocity[a]) + static_cast<double>(residual.velocity[a]) + half_change(i, a);
            r.velocity[a] = static_cast<float>(v);
            residual.velocity[a] = static_cast<float>(v - static_cast<double>(r.velocity[a]));
            r.spin[a] = static_cast<float>(static_cast<double>(r.spin[a]) + half_spin_change(i, a));
            r.surface[a] = r.spin[a] * r.radius;
        }
        field_.forces[i] = Force{};
    }
}

/// Lists anew, forces at the present full-step velocities without touching histories, velocities then set back by
/// half a step: a leapfrog whose first kick is a half one.
void MixedEngine::restart_forces(std::span<const std::int32_t> removed) {
    place_walls(field_, walls_, room_, wall_time());
    drift_ = Drift{};
    make_lists(removed);
    begin_tally();
    field_.history_step = 0;
    kernels_->walls(field_, tally_);
    kernels_->sweep(field_, false, tally_);
    field_.history_step = 1;
    peak_overlap_ = std::max(peak_overlap_, tally_.overlap);
    for (std::int32_t i = 0; i < field_.count; ++i) {
        Record& r = field_.records[i];
        Residual& residual = field_.residuals[i];
        for (int a = 0; a < 3; ++a) {
            const double v =
                static_cast<double>(r.velocity[a]) + static_cast<double>(residual.velocity[a]) - half_change(i, a);
            r.velocity[a] = static_cast<float>(v);
            residual.velocity[a] = static_cast<float>(v - static_cast<double>(r.velocity[a]));
            r.spin[a] = static_cast<float>(static_cast<double>(r.spin[a]) - half_spin_change(i, a));
            r.surface[a] = r.spin[a] * r.radius;
        }
    }
    if (too_deep()) fault_ = describe_overlap(sight(), tally_);
}

/// The velocities whose spread bounds relative displacements: particles', walls', and rest where something rests.
void MixedEngine::begin_tally() {
    const bool rest = box_includes_rest_ || !walls_.empty();
    for (int a = 0; a < 8; ++a) {
        tally_.velocity_high[a] = rest ? 0 : -std::numeric_limits<float>::infinity();
        tally_.velocity_low[a] = rest ? 0 : std::numeric_limits<float>::infinity();
    }
    for (std::int32_t w = 0; w < field_.wall_count; ++w)
        for (int a = 0; a < 3; ++a) {
            const float v = field_.records[field_.walls[w].record].velocity[a];
            tally_.velocity_high[a] = std::max(tally_.velocity_high[a], v);
            tally_.velocity_low[a] = std::min(tally_.velocity_low[a], v);
        }
    tally_.overlap = tally_.wall_overlap = 0;
    tally_.wall_work = 0;
    tally_.contacts = 0;
}

/// Books the displacement of the step just made.
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
        fault_ = describe_fast_particle(sight());
    else if (watch_.too_fast(static_cast<double>(fastest)))
        fault_ = describe_faster_than(sight(), watch_.speed_limit());
    watch_.book_travel(static_cast<double>(fastest));
}

/// Rebuilds or refreshes the lists where displacements since demand it. A pair outside the outer list had a gap
/// above its skin and has lost at most the drift since; likewise the inner list.
void MixedEngine::make_lists(std::span<const std::int32_t> removed) {
    const bool rebuilt = !(drift_.outer < static_cast<double>(room_.skin));
    if (!rebuilt && drift_.inner < static_cast<double>(inner_skin_)) return;
    if (rebuilt) {
        const double per_step = drift_.steps > 0 ? drift_.outer / static_cast<double>(drift_.steps) : 0.003;
        if (adapts_skin_)
            room_.skin = std::min(
                static_cast<float>(std::clamp(std::sqrt(outer_balance * per_step), outer_skin_least, outer_skin_most)),
                largest_skin_);
        const std::int32_t before = field_.count;
        rebuild(field_, columns_, *kernels_, room_, removed);
        columns_.forces.clear(size());  // what waited there belonged to the old order
        if (field_.count < before) watch_.forget_balance();
        drift_.outer = 0;
        drift_.steps = 0;
        mobile_ = 0;
        for (std::int32_t i = 0; i < field_.count; ++i) mobile_ += field_.records[i].inverse_mass > 0 ? 1 : 0;
        ++work_.rebuilds;
    }
    inner_skin_ = static_cast<float>(
        std::clamp(std::sqrt(inner_balance * drift_.last_step), inner_skin_least, static_cast<double>(room_.skin)));
    refresh(field_, columns_, *kernels_, inner_skin_, rebuilt);
    drift_.inner = 0;
}

Moment MixedEngine::moment(std::span<const Motion> motions) const {
    const ContactReader reader(material_, room_, field_, columns_.id.data(), {}, kernels_->width);
    return {field_, room_, columns_.id.data(), motions, reader.stored(walls_, wall_time())};
}

void MixedEngine::learn_limits() {
    const std::vector<Motion> now = motions();
    watch_.learn(moment(now), walls_);
}

void MixedEngine::check_energy() {
    const std::vector<Motion> now = motions();
    std::int32_t particle = 0;
    const std::string what = watch_.look(moment(now), particle);
    if (!what.empty()) fault_ = describe(sight(), what, particle);
}

void MixedEngine::run(std::int64_t steps) {
    bool advanced = false;  // the sweep before has moved the particles on
    for (std::int64_t s = 0; s < steps && fault_.empty(); ++s) {
        if (!advanced) {
            begin_tally();
            kernels_->advance(field_, tally_);
        }
        ++work_.steps;
        ++wall_steps_;
        if (shaken_) shake();
        work_.particle_steps += static_cast<double>(mobile_);
        account_travel();
        if (!fault_.empty()) return;
        place_walls(field_, walls_, room_, wall_time());
        make_lists();
        const bool look = watch_.due(work_.steps);  // at a state of the full step, so nobody moves on before
        advanced = s + 1 < steps && !look;
        begin_tally();
        kernels_->walls(field_, tally_);
        watch_.book_push(tally_.wall_work);
        kernels_->sweep(field_, advanced, tally_);
        columns_.swap_histories(field_);
        peak_overlap_ = std::max(peak_overlap_, tally_.overlap);
        work_.pair_visits += field_.inner_count;
        if (too_deep()) fault_ = describe_overlap(sight(), tally_);
        if (look && fault_.empty()) check_energy();
    }
}

void MixedEngine::set_walls(std::vector<Wall> walls) {
    check_walls(walls);
    full_step_velocities();
    walls_ = std::move(walls);
    wall_steps_ = 0;
    columns_.hold_particles(size(), walls_.size());
    columns_.bind(field_);
    for (std::size_t w = 0; w < walls_.size(); ++w) columns_.segments[w] = {0, 0};
    restart_forces();
    learn_limits();
}

void MixedEngine::remove(std::span<const std::int32_t> ids) {
    full_step_velocities();
    restart_forces(ids);
}

void MixedEngine::state(State& into) const {
    const auto n = size();
    into.id.resize(n);
    into.position.resize(n), into.velocity.resize(n), into.angular_velocity.resize(n);
    into.radius.resize(n), into.mobile.resize(n);
    std::vector<std::int32_t> order(n);
    for (std::size_t i = 0; i < n; ++i) order[i] = static_cast<std::int32_t>(i);
    std::sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
        return columns_.id[static_cast<std::size_t>(a)] < columns_.id[static_cast<std::size_t>(b)];
    });
    const Scale& s = room_.scale;
    for (std::size_t k = 0; k < n; ++k) {
        const std::int32_t i = order[k];
        const Record& r = field_.records[i];
        const Residual& residual = field_.residuals[i];
        into.id[k] = columns_.id[static_cast<std::size_t>(i)];
        into.radius[k] = static_cast<double>(r.radius) * s.length;
        into.mobile[k] = r.inverse_mass > 0 ? 1 : 0;
        for (int a = 0; a < 3; ++a) {
            const auto axis = static_cast<std::size_t>(a);
            double x = s.centre[axis] + (r.position[a] + static_cast<double>(residual.position[a])) * s.unit[axis];
            if (room_.domain.periodic[axis]) {
                const double low = room_.domain.low[axis], period = room_.domain.high[axis] - low;
                if (x < low) x += period;
                if (x >= room_.domain.high[axis]) x -= period;
            }
            into.position[k][axis] = x;
            into.velocity[k][axis] =
                (static_cast<double>(r.velocity[a]) + static_cast<double>(residual.velocity[a]) + half_change(i, a)) *
                s.speed();
            into.angular_velocity[k][axis] = (static_cast<double>(r.spin[a]) + half_spin_change(i, a)) / s.time;
        }
    }
}

/// Velocities of the full step, in the order of the records.
std::vector<Motion> MixedEngine::motions() const {
    std::vector<Motion> all(size());
    for (std::int32_t i = 0; i < field_.count; ++i) {
        const Record& r = field_.records[i];
        const Residual& residual = field_.residuals[i];
        Motion& m = all[static_cast<std::size_t>(i)];
        for (int a = 0; a < 3; ++a) {
            const auto axis = static_cast<std::size_t>(a);
            m.velocity[axis] =
                (static_cast<double>(r.velocity[a]) + static_cast<double>(residual.velocity[a]) + half_change(i, a)) *
                room_.scale.speed();
            m.spin[axis] = (static_cast<double>(r.spin[a]) + half_spin_change(i, a)) / room_.scale.time;
        }
    }
    return all;
}

void MixedEngine::contacts(std::vector<ContactForce>& into) const {
    const std::vector<Motion> now = motions();
    const ContactReader reader(material_, room_, field_, columns_.id.data(), now, kernels_->width);
    into.clear();
    reader.pairs(into);
    for (std::size_t w = 0; w < walls_.size(); ++w) reader.wall(walls_[w], w, wall_time(), into);
}

/// Everything that changes, in one order for writing and reading.
template <class Self, class Archive>
void MixedEngine::pass(Self& self, Archive& archive) {
    archive.value(self.field_.count);
    archive.value(self.field_.inner_count);
    archive.value(self.field_.outer_count);
    archive.value(self.drift_);
    archive.value(self.inner_skin_);
    archive.value(self.room_.skin);
    archive.value(self.tally_);
    archive.value(self.peak_overlap_);
    Watch::pass(self.watch_, archive);
    archive.value(self.wall_steps_);
    archive.value(self.mobile_);
    archive.value(self.work_.steps);
    archive.value(self.work_.particle_steps);
    archive.value(self.work_.pair_visits);
    archive.value(self.work_.rebuilds);
    archive.text(self.fault_);
    archive.list(self.walls_);
    auto& c = self.columns_;
    const auto particles = static_cast<std::size_t>(self.field_.count) + 3 + self.walls_.size();
    archive.column(c.records, particles);
    archive.column(c.residuals, particles);
    archive.column(c.forces, particles);
    archive.column(c.id, particles);
    const auto outer = static_cast<std::size_t>(self.field_.outer_count) + spare;
    archive.column(c.outer_first, outer);
    archive.column(c.outer_second, outer);
    archive.column(c.outer_reach, outer);
    const auto inner = static_cast<std::size_t>(self.field_.inner_count) + spare;
    archive.column(c.inner_first, inner);
    archive.column(c.inner_second, inner);
    archive.column(c.inner_source, inner);
    archive.column(c.inner_reach, inner);
    archive.column(c.touching, inner / 4);
    for (int a = 0; a < c.histories; ++a) archive.column(c.history[a], inner);
    archive.column(c.segments, self.walls_.size());
    const auto near_walls = self.walls_.empty() ? 0 : static_cast<std::size_t>(c.segments[self.walls_.size() - 1].end);
    archive.column(c.wall_particle, near_walls);
    for (int a = 0; a < c.histories; ++a) archive.column(c.wall_history[a], near_walls);
}

/// Of the case, the same at every step.
Seal MixedEngine::seal() const {
    Constants constants = field_.constants;
    for (std::size_t a = 0; a < 3; ++a) constants.gravity[a] = gravity_in_steps(gravity_[a], room_.scale);
    return make_seal(constants, *kernels_, needs_, shaking_);
}

void MixedEngine::save(std::vector<std::byte>& into) const {
    Writer writer(into);
    writer.value(seal());
    pass(*this, writer);
}

void MixedEngine::restore(std::span<const std::byte> from) {
    Reader reader(from);
    Seal theirs;
    reader.value(theirs);
    const Seal own = seal();
    if (std::memcmp(&theirs, &own, sizeof own) != 0)
        throw std::invalid_argument("the checkpoint belongs to another setup, instruction path or version");
    pass(*this, reader);
    if (!reader.finished()) throw std::invalid_argument("the checkpoint is longer than its state");
    columns_.hold_particles(size(), walls_.size());
    columns_.hold_pairs(static_cast<std::size_t>(std::max(field_.outer_count, field_.inner_count)) + spare);
    columns_.hold_wall_contacts(size());
    columns_.bind(field_);
    place_walls(field_, walls_, room_, wall_time());
    if (shaken_) shake();
}

}  // namespace

bool supports(Method::Path path) {
    switch (path) {
        case Method::Path::avx512:
            return __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512bw") != 0 &&
                   __builtin_cpu_supports("avx512dq") != 0 && __builtin_cpu_supports("avx512vl") != 0 &&
                   supports(Method::Path::avx2);
        case Method::Path::avx2:
            return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
        default:
            return true;
    }
}

namespace {

Method::Path widest_path() {
    if (supports(Method::Path::avx512)) return Method::Path::avx512;
    if (supports(Method::Path::avx2)) return Method::Path::avx2;
    return Method::Path::baseline;
}

/// A fact of the process like its processor: chosen at its start, before any engine is made.
Method::Path& preferred() {
    static Method::Path path = widest_path();
    return path;
}

}  // namespace

Method::Path best_path() {
    return preferred();
}

void prefer(Method::Path path) {
    if (!supports(path)) throw std::invalid_argument("this processor lacks the instructions of the path asked for");
    preferred() = path == Method::Path::best ? widest_path() : path;
}

std::unique_ptr<Engine> make_mixed_engine(const Setup& setup, Method::Path path, double skin) {
    if (path == Method::Path::best) path = best_path();
    if (!supports(path)) throw std::invalid_argument("this processor lacks the instructions of the path asked for");
    return std::make_unique<MixedEngine>(setup, path, skin);
}

}  // namespace grainsweep::dem::fast
