#include "solver/dem/fast/resting.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "solver/dem/fast/residual.hpp"
#include "solver/geometry/vector.hpp"

namespace grainsweep::dem::fast {

namespace {

/// Steps for which a particle must have been slow. A net force of half its weight would have made it faster than the
/// rest speed meanwhile, and so would its weight on the way up and down again.
constexpr double least_quiet_time = 256, most_quiet_time = 0x1p31;
std::int64_t quiet_time_of(double speed, double gravity) {
    const double turned = gravity > 0 ? std::ceil(2 * speed / gravity) + 1 : 0;
    return static_cast<std::int64_t>(std::clamp(turned, least_quiet_time, most_quiet_time));
}

/// Net force, of the weight, above which a particle is advanced again.
constexpr double imbalance = 0.5;
/// Impacts of particles that are faster than the rest speed by this factor reach so many layers behind the particles in
/// reach.
constexpr double impact_factor = 30;
constexpr int layers = 2;

double square(const float* v) {
    double sum = 0;
    for (int a = 0; a < 3; ++a) sum += static_cast<double>(v[a]) * static_cast<double>(v[a]);
    return sum;
}

bool is_mobile(const Field& f, std::size_t i) {
    return f.records[i].inverse_mass > 0;
}

void stop(Field& f, std::int32_t i) {
    Residual residual = residual_of(f, i);
    for (int a = 0; a < 3; ++a) {
        f.records[i].velocity[a] = residual.velocity[a] = 0;
        set_spin(f, i, a, 0);
    }
    leave_over(f, i, residual);
}

/// Exchanges the particles of a contact.
void exchange(ParkedContact& p, const float* factors) {
    for (int a = 0; a < histories_at_most; ++a) p.history[a] *= factors[a];
    for (float& force : p.force) force = -force;
    for (int a = 0; a < 3; ++a) std::swap(p.torque[0][a], p.torque[1][a]);
}

std::pair<std::size_t, std::size_t> pair_at(const Columns& c, std::size_t o) {
    return {c.outer_first[o] / places_per_index, c.outer_second[o] / places_per_index};
}

}  // namespace

Resting::Resting(const Setup& setup, const PairContacts& laws, const Scale& scale, double rest_speed) : laws_(&laws) {
    use_scale(scale, rest_speed, geometry::norm(setup.gravity));
    if (!wanted()) return;
    for (const Sphere& sphere : setup.spheres) held_.push_back(sphere.mobile ? 0 : 1);
    quiet_.resize(held_.size());
}

void Resting::use_scale(const Scale& scale, double rest_speed, double gravity) {
    speed_ = rest_speed / scale.speed();
    gravity_ = gravity * scale.time * scale.time / scale.length;
    quiet_time_ = quiet_time_of(speed_, gravity_);
}

void Resting::convert_parked(float force, std::span<const float> memory) {
    for (ParkedContact& p : parked_) {
        for (float& f : p.force) f *= force;
        for (auto& torque : p.torque)
            for (float& t : torque) t *= force;
        for (std::size_t m = 0; m < memory.size(); ++m) p.history[m] *= memory[m];
    }
}

bool Resting::fits(std::int32_t particles) const {
    const auto n = static_cast<std::size_t>(particles);
    return held_.size() == n && quiet_.size() == n && count_ >= 0 && count_ <= particles &&
           std::ranges::all_of(parked_, [&](const ParkedContact& p) {
               return p.first >= 0 && p.first < particles && p.second >= 0 && p.second < particles;
           });
}

void Resting::advance_all(const Field& f) {
    for (std::size_t i = 0; i < held_.size(); ++i) held_[i] = is_mobile(f, i) ? 0 : 1;
    std::ranges::fill(quiet_, 0U);
}

void Resting::advance_also(std::size_t count) {
    if (!wanted()) return;
    held_.resize(held_.size() + count, 0);
    quiet_.resize(held_.size(), 0);
}

void Resting::compare_forces(const Field& f, std::int64_t steps) {
    steps_ = steps;
    const auto n = static_cast<std::size_t>(f.count);
    pushed_.assign(n, 0);
    if (steps == 0 || count_ == 0) return;
    std::vector<std::array<double, 6>> sum(n);  // force and torque
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t a = 0; a < 3; ++a) {
            sum[i][a] = static_cast<double>(f.forces[i].force[a]) / static_cast<double>(steps);
            sum[i][3 + a] = static_cast<double>(f.forces[i].torque[a]) / static_cast<double>(steps);
        }
    for (const ParkedContact& p : parked_)
        for (std::size_t a = 0; a < 3; ++a) {
            auto &first = sum[static_cast<std::size_t>(p.first)], &second = sum[static_cast<std::size_t>(p.second)];
            first[a] += static_cast<double>(p.force[a]);
            second[a] -= static_cast<double>(p.force[a]);
            first[3 + a] += static_cast<double>(p.torque[0][a]);
            second[3 + a] += static_cast<double>(p.torque[1][a]);
        }
    const double most = imbalance * imbalance * gravity_ * gravity_;
    for (std::size_t i = 0; i < n; ++i) {
        if (held_[i] == 0 || !is_mobile(f, i)) continue;
        const auto inverse_mass = static_cast<double>(f.records[i].inverse_mass);
        const double arm = static_cast<double>(f.records[i].radius);
        double push = 0, turn = 0;
        for (std::size_t a = 0; a < 3; ++a) {
            push += std::pow(sum[i][a] * inverse_mass + static_cast<double>(f.constants.gravity[a]), 2);
            turn += std::pow(sum[i][3 + a] * inverse_mass / arm, 2);
        }
        pushed_[i] = push > most || turn > most ? 1 : 0;
    }
}

void Resting::reorder(const Field& f, const Columns& c) {
    const auto held = held_, pushed = pushed_;
    const auto quiet = quiet_;
    const auto n = static_cast<std::size_t>(f.count);
    held_.resize(n), pushed_.resize(n), quiet_.resize(n);
    for (std::size_t i = 0; i < held.size(); ++i) {
        if (c.place[i] < 0) continue;
        const auto to = static_cast<std::size_t>(c.place[i]);
        held_[to] = held[i], pushed_[to] = pushed[i], quiet_[to] = quiet[i];
    }
}

/// Which particles move, and for how long the others have not.
void Resting::measure_motion(const Field& f) {
    const double slow = speed_ * speed_, fast = impact_factor * impact_factor * slow;
    disturbs_.assign(held_.size(), 0);
    for (std::size_t i = 0; i < held_.size(); ++i) {
        if (held_[i] != 0) continue;
        const Record& r = f.records[i];
        const auto radius = static_cast<double>(r.radius);
        const double speed = std::max(square(r.velocity), radius * radius * square(r.spin));
        if (speed > slow) disturbs_[i] = speed > fast ? 1 + layers : 1;
        const std::int64_t quiet = speed > slow ? 0 : std::min(quiet_[i] + steps_, quiet_time_);
        quiet_[i] = static_cast<std::uint32_t>(quiet);
    }
}

/// What that keeps advanced: all in reach, and layer by layer what touches them.
void Resting::spread_disturbance(const Field& f, const Columns& c) {
    const auto pairs = static_cast<std::size_t>(f.outer_count);
    disturbed_.assign(held_.size(), 0);
    for (std::size_t o = 0; o < pairs; ++o) {
        const auto [i, j] = pair_at(c, o);
        disturbed_[i] = std::max(disturbed_[i], disturbs_[j]);
        disturbed_[j] = std::max(disturbed_[j], disturbs_[i]);
    }
    for (int layer = layers; layer > 0; --layer)
        for (std::size_t o = 0; o < pairs; ++o) {
            if (c.owner[o] == 0) continue;
            const auto [i, j] = pair_at(c, o);
            if (disturbed_[i] == layer + 1 && disturbed_[j] < layer && is_mobile(f, i))
                disturbed_[j] = static_cast<std::uint8_t>(layer);
            if (disturbed_[j] == layer + 1 && disturbed_[i] < layer && is_mobile(f, j))
                disturbed_[i] = static_cast<std::uint8_t>(layer);
        }
}

void Resting::decide(Field& f) {
    count_ = 0;
    for (std::size_t i = 0; i < held_.size(); ++i) {
        if (!is_mobile(f, i)) continue;
        if (held_[i] != 0 && (pushed_[i] != 0 || disturbed_[i] != 0)) {
            held_[i] = 0;
            quiet_[i] = 0;
        } else if (held_[i] == 0 && quiet_[i] >= quiet_time_ && disturbed_[i] == 0) {
            held_[i] = 1;
            stop(f, static_cast<std::int32_t>(i));
        }
        count_ += held_[i];
    }
}

/// The contact that owns an outer pair.
ParkedContact Resting::parked_from(const Columns& c, const ContactReader& reader, std::size_t pair,
                                   std::int32_t live) const {
    const std::int32_t owner = c.owner[pair], from = std::abs(owner) - 1;
    ParkedContact p{};
    if (from >= live)
        p = before_[static_cast<std::size_t>(from - live)];
    else
        for (int a = 0; a < c.histories; ++a) p.history[a] = c.history[a][static_cast<std::size_t>(from)];
    if (owner < 0) exchange(p, c.exchanged);
    const auto [i, j] = pair_at(c, pair);
    p.first = static_cast<std::int32_t>(i);
    p.second = static_cast<std::int32_t>(j);
    if (from < live) reader.stand_still(p);
    return p;
}

void Resting::update(Field& f, Columns& c, const ListSpace& space, std::int32_t live) {
    measure_motion(f);
    spread_disturbance(f, c);
    decide(f);
    const ContactReader reader(*laws_, space, f, c.id.data(), {}, 1);
    before_.swap(parked_);
    parked_.clear();
    overlap_ = 0;
    std::size_t to = 0;
    for (std::size_t o = 0; o < static_cast<std::size_t>(f.outer_count); ++o) {
        const auto [i, j] = pair_at(c, o);
        if (held_[i] != 0 && held_[j] != 0) {
            if (c.owner[o] == 0) continue;
            parked_.push_back(parked_from(c, reader, o, live));
            overlap_ = std::max(overlap_, parked_.back().overlap);
            continue;
        }
        c.outer_first[to] = c.outer_first[o];
        c.outer_second[to] = c.outer_second[o];
        c.outer_reach[to] = c.outer_reach[o];
        c.owner[to] = c.owner[o];
        ++to;
    }
    f.outer_count = static_cast<std::int32_t>(to);
}

}  // namespace grainsweep::dem::fast
