#include "solver/scenes/kit/checkpoint.hpp"
#include "solver/scenes/spreading/experiment.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace grainsweep::spreading {
namespace {

constexpr std::uint64_t checkpoint_format = 0x6772'6e73'7370'0005ULL;  // "grnssp", version 5

/// What a bed is, without names that say nothing of it.
template <class State, class Visit>
void columns(State& bed, Visit visit) {
    visit(bed.position);
    visit(bed.velocity);
    visit(bed.angular_velocity);
    visit(bed.radius);
}

}  // namespace

void Experiment::save(Bytes& into) const {
    kit::write_checkpoint(into, checkpoint_format, *engine_, [this](ByteWriter& out) {
        out.put(layer_);
        out.put(step_);
        out.put(sweeping_);
        out.put(borrowed_particle_steps_);
        out.put(earlier_particle_steps_);
        out.put(earlier_overlap_);
        out.put(end_sample_);
        out.put(behind_);
        out.put(under_);
        out.put(solid_);
        out.put(force_sum_);
        out.put(lift_sum_);
        out.put(impulse_);
        out.put(place_);
        out.put(left_behind_);
        out.put(profile_.sum);
        out.put(profile_.samples);
        out.put(layers_);
        columns(bed_, [&out](const auto& column) { out.put(column); });
    });
}

void Experiment::restore(std::span<const std::byte> from) {
    ByteReader in = kit::open_checkpoint(from, checkpoint_format);
    std::int64_t layer = 0, step = 0, end_sample = 0;
    bool sweeping = false;
    double borrowed = 0, earlier = 0, overlap = 0, force = 0, lift = 0, left = 0;
    geometry::Vec3 impulse{};
    std::vector<double> behind, under, solid;
    std::vector<Place> place;
    observables::VelocityProfile profile(profile_layers);
    std::vector<LayerAnswer> layers;
    dem::State bed;
    in.get(layer);
    in.get(step);
    in.get(sweeping);
    in.get(borrowed);
    in.get(earlier);
    in.get(overlap);
    in.get(end_sample);
    in.get(behind);
    in.get(under);
    in.get(solid);
    in.get(force);
    in.get(lift);
    in.get(impulse);
    in.get(place);
    in.get(left);
    in.get(profile.sum);
    in.get(profile.samples);
    in.get(layers);
    columns(bed, [&in](auto& column) { in.get(column); });
    const Bytes engine = kit::engine_at_end(in);

    in.require(layer >= 0 && layer < study_.layers && static_cast<std::int64_t>(layers.size()) == layer);
    const std::size_t lying = bed.position.size();
    columns(bed, [&](const auto& column) { in.require(column.size() == lying && (layer > 0 || lying == 0)); });
    in.require(lying <= static_cast<std::size_t>(layer) * 5'000'000);
    if (layer != layer_ || layer > 0) {
        layer_ = layer;
        supply(bed);
    }
    step_ = step;
    sweeping_ = sweeping;
    borrowed_particle_steps_ = borrowed;
    earlier_particle_steps_ = earlier;
    earlier_overlap_ = overlap;
    end_sample_ = end_sample;
    behind_ = std::move(behind);
    under_ = std::move(under);
    solid_ = std::move(solid);
    force_sum_ = force;
    lift_sum_ = lift;
    impulse_ = impulse;
    left_behind_ = left;
    profile_ = std::move(profile);
    layers_ = std::move(layers);
    const auto samples = static_cast<std::int64_t>(behind_.size());
    in.require(end_sample_ >= 0 && end_sample_ <= sweep_samples && place.size() == volume_.size());
    place_ = std::move(place);
    in.require(under_.size() == behind_.size() && solid_.size() == behind_.size());
    in.require(samples <= sweep_samples + 1 && sweeping_ == (samples > 0));
    in.require(step_ >= 0 && step_ <= (sweeping_ ? last_step() : study_.settle_steps));
    in.require(layer_ + 1 == study_.layers || step_ < study_.steps_of_layer());
    in.require(!sweeping_ || (step_ >= step_of_sample(samples - 1) && step_ <= step_of_sample(samples)));
    in.require(profile_.sum.size() == profile_layers && profile_.samples.size() == profile_layers);
    engine_->restore(engine);
}

}  // namespace grainsweep::spreading
