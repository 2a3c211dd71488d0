#include "solver/observables/flow_state.hpp"
#include "solver/scenes/kit/sentence.hpp"
#include "solver/scenes/thermovibration/picture.hpp"
#include "solver/scenes/thermovibration/runs.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace grainsweep::thermovibration {
namespace {

constexpr std::int64_t judged_every = 20;  // periods
constexpr double give_up = 1.0;            // L^2/alpha: ten thermal times

// Root of the mean square over the volume.
double size_of(const flow::Grid& grid, const flow::FaceVectors& field) {
    return std::sqrt(2 * observables::kinetic_energy(grid, field));
}

}  // namespace

SpinUp::SpinUp(const Question& question)
    : question_(question),
      fluid_(question.fluid()),
      velocity_(flow::face_vectors(fluid_.grid())),
      acceleration_(velocity_),
      mean_(velocity_),
      previous_mean_(velocity_),
      stored_(fluid_.grid()) {}

void SpinUp::step() {
    const std::int64_t per_period = question_.steps_per_period;
    const std::int64_t in_period = fluid_.steps() % per_period;
    const bool judged = (fluid_.steps() / per_period) % judged_every == judged_every - 1;
    fluid_.step();
    if (fluid_.steps() % watch_interval(per_period) == 0) {
        fault_ = thermovibration::fault(fluid_, time());
        if (!fault_.empty()) return;
    }
    if (stage_ == Stage::storing) {
        fluid_.midpoint(velocity_, acceleration_);
        const double phase = question_.frequency * (static_cast<double>(in_period) + 0.5) * fluid_.time_step();
        stored_.add(phase, static_cast<int>(per_period), velocity_, acceleration_);
        means_.add(fluid_, per_period);
        if (in_period == per_period - 1) stage_ = Stage::stored;
    } else if (judged) {
        const double share = 1 / static_cast<double>(per_period);
        for (std::size_t d = 0; d < 3; ++d)
            for (std::size_t m = 0; m < mean_[d].size(); ++m)
                mean_[d].values()[m] += share * fluid_.velocity()[d].values()[m];
        mean_square_ += share * 2 * observables::kinetic_energy(fluid_.grid(), fluid_.velocity());
        if (in_period == per_period - 1) compare();
    }
}

void SpinUp::compare() {
    for (std::size_t d = 0; d < 3; ++d)
        for (std::size_t m = 0; m < mean_[d].size(); ++m) previous_mean_[d].values()[m] -= mean_[d].values()[m];
    const double change = size_of(fluid_.grid(), previous_mean_);
    const double size = size_of(fluid_.grid(), mean_);
    const double relaxation_over_interval =
        1 / (std::numbers::pi * std::numbers::pi * question_.period() * static_cast<double>(judged_every));
    const double to_come = change * std::max(1.0, relaxation_over_interval);
    const bool settled = to_come <= 0.02 * size || to_come <= 1e-5 * std::sqrt(mean_square_);
    passes_ = settled ? passes_ + 1 : 0;
    std::swap(mean_, previous_mean_);
    for (auto& component : mean_) std::fill(component.values().begin(), component.values().end(), 0.0);
    mean_square_ = 0;
    if (passes_ >= 2)
        stage_ = Stage::storing;
    else if (time() > give_up)
        fault_ = kit::sentence(
            "the flow had not become periodic by t = %.4g L^2/alpha (mean velocity still to change by %.2g of "
            "its size); release the particles with the flow instead (particle_start)",
            time(), to_come / size);
}

void SpinUp::save(std::vector<std::byte>& into) const {
    fluid_.save(into);
    for (std::size_t d = 0; d < 3; ++d) {
        append_bytes<double>(into, mean_[d].values());
        append_bytes<double>(into, previous_mean_[d].values());
    }
    append_bytes(into, mean_square_);
    append_bytes(into, passes_);
    append_bytes(into, stage_);
    append_bytes(into, means_);
    if (stage_ != Stage::settling) stored_.save(into);
}

void SpinUp::restore(std::span<const std::byte>& from) {
    fluid_.restore(from);
    for (std::size_t d = 0; d < 3; ++d) {
        take_bytes<double>(from, mean_[d].values());
        take_bytes<double>(from, previous_mean_[d].values());
    }
    take_bytes(from, mean_square_);
    take_bytes(from, passes_);
    take_bytes(from, stage_);
    take_bytes(from, means_);
    require_possible(stage_ == Stage::settling || stage_ == Stage::storing || stage_ == Stage::stored);
    require_possible(passes_ >= 0 && passes_ <= 2 && thermovibration::fault(fluid_, time()).empty());
    if (stage_ != Stage::settling) stored_.restore(from);
}

Carried::Carried(const Question& question, std::uint64_t seed, Artefacts& artefacts, CarriedStep* carry_step)
    : question_(question), artefacts_(artefacts), cloud_(question, seed), carry_(carry_step), record_(question) {
    if (const auto found = artefacts_.get(question_.flow_key()); !found || !received(*found))
        spin_up_.emplace(question_);
    record_.sample(0, cloud_.particles);
}

void Carried::advance(double until) {
    while (time() < until && !finished() && fault_.empty()) {
        if (spin_up_)
            settle();
        else
            step();
    }
}

int Carried::use_threads(int count) {
    const int wanted = threads_for(cloud_.grid, count);
    if (wanted != cloud_.slabs.count()) cloud_.slabs = Slabs(wanted);
    if (spin_up_) spin_up_->use(cloud_.slabs);
    return wanted;
}

double Carried::progress() const {
    constexpr double usual_spin_up = 0.25;
    if (spin_up_) return 0.5 * std::min(1.0, spin_up_->time() / usual_spin_up);
    const double share = static_cast<double>(steps_) / static_cast<double>(question_.total_steps());
    return spun_ > 0 ? 0.5 + 0.5 * share : share;
}

void Carried::save(Bytes& into) const {
    into.clear();
    append_bytes(into, static_cast<std::int64_t>(spin_up_.has_value()));
    append_bytes(into, steps_);
    append_bytes(into, spun_);
    append_bytes<coupling::Vec3>(into, cloud_.particles.position);
    append_bytes<coupling::Vec3>(into, cloud_.particles.velocity);
    record_.save(into);
    if (spin_up_)
        spin_up_->save(into);
    else
        cloud_.flow.save(into);
}

void Carried::restore(std::span<const std::byte> from) {
    std::int64_t spinning = 0;
    take_bytes(from, spinning);
    take_bytes(from, steps_);
    take_bytes(from, spun_);
    take_bytes<coupling::Vec3>(from, cloud_.particles.position);
    take_bytes<coupling::Vec3>(from, cloud_.particles.velocity);
    record_.restore(from);
    if (spinning != 0) {
        spin_up_.emplace(question_);
        spin_up_->restore(from);
    } else {
        spin_up_.reset();
        cloud_.flow.restore(from);
    }
    require_possible(from.empty() && steps_ >= 0 && steps_ <= question_.total_steps());
    require_possible(
        thermovibration::fault(cloud_.particles, question_.step(), 1.0 / static_cast<double>(question_.cells), time())
            .empty());
}

Snapshot Carried::snapshot() const {
    Snapshot now = picture(question_, cloud_.particles);
    if (spin_up_) {
        now.fields.push_back(drawn_flow(question_, spin_up_->velocity(), nullptr));
    } else {
        auto velocity = flow::face_vectors(cloud_.grid);
        const auto in_period = static_cast<double>(steps_ % question_.steps_per_period);
        cloud_.flow.velocity(question_.frequency * in_period * question_.step(), velocity);
        now.fields.push_back(drawn_flow(question_, velocity, nullptr));
    }
    return now;
}

void Carried::settle() {
    spin_up_->step();
    fault_ = spin_up_->fault();
    if (!spin_up_->periodic()) return;
    Bytes contents;
    append_bytes(contents, spin_up_->means());
    spin_up_->stored().save(contents);
    artefacts_.put(question_.flow_key(), contents);
    spun_ = spin_up_->time();
    spin_up_.reset();
    receive(contents);
}

/// False for bytes that are no such flow: it is found anew.
bool Carried::received(std::span<const std::byte> contents) {
    try {
        receive(contents);
        return true;
    } catch (const std::invalid_argument&) {
        return false;
    }
}

void Carried::receive(std::span<const std::byte> contents) {
    FlowMeans means;
    take_bytes(contents, means);
    cloud_.flow.restore(contents);
    require_possible(contents.empty());
    record_.set_flow(means);
}

void Carried::step() {
    const double dt = question_.step();
    const auto in_period = static_cast<double>(steps_ % question_.steps_per_period) + 0.5;
    carry_(cloud_, question_.frequency * in_period * dt, question_.vibration().at(in_period * dt));
    ++steps_;
    const double now = static_cast<double>(steps_) * dt;
    fault_ = thermovibration::fault(cloud_.particles, dt, 1.0 / static_cast<double>(question_.cells), now);
    if (!fault_.empty()) return;
    if (steps_ % question_.sample_steps() == 0 || finished()) record_.sample(now, cloud_.particles);
}

}  // namespace grainsweep::thermovibration
