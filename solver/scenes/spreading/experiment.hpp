// Run of the spreading experiment, layer by layer: settling, then sweeping, sampled at equal distances of travel.
#pragma once

#include "solver/dem/engine.hpp"
#include "solver/observables/layer.hpp"
#include "solver/scenes/scene.hpp"
#include "solver/scenes/spreading/study.hpp"

#include <limits>

namespace grainsweep::spreading {

inline constexpr double layer_thickness = 0.5;  // of the velocity profile, in diameters
inline constexpr double behind_to = 15;         // of solid_behind, in diameters

/// Answers of each layer; NaN: undefined.
struct LayerAnswer {
    static constexpr double none = std::numeric_limits<double>::quiet_NaN();
    double mfr = none, packing_fraction = none, roughness = none, empty_share = none, patch_sd = none, force = none;
};

class Experiment final : public Scene {
public:
    /// Takes a shared bed from `artefacts`, or settles it and stores it there. `artefacts` must outlive the experiment.
    Experiment(const Study& study, std::uint64_t seed, const dem::Method& method, Artefacts& artefacts);

    void advance(double until) override;
    int use_threads(int count) override {
        method_.threads = count;  // of the engines of later layers
        return engine_->set_threads(count);
    }
    void observe(Observations& into) const override;
    [[nodiscard]] double time() const override {
        return study_.time_step * static_cast<double>(layer_ * study_.steps_of_layer() + step_);
    }
    [[nodiscard]] bool finished() const override { return layer_ + 1 == study_.layers && step_ == last_step(); }
    [[nodiscard]] double progress() const override;
    [[nodiscard]] Health health() const override { return {engine_->fault()}; }
    [[nodiscard]] double particle_steps() const override {
        return earlier_particle_steps_ + engine_->work().particle_steps - borrowed_particle_steps_;
    }
    void save(Bytes& into) const override;
    void restore(std::span<const std::byte> from) override;
    [[nodiscard]] Snapshot snapshot() const override;
    [[nodiscard]] double picture_focus() const override {
        return study_.time_step * static_cast<double>(study_.settle_steps);
    }

    static constexpr std::size_t profile_layers = 12;

private:
    /// Returns the last step of this layer, counted like step_.
    [[nodiscard]] std::int64_t last_step() const { return step_of_sample(end_sample_); }
    [[nodiscard]] std::int64_t step_of_sample(std::int64_t sample) const;
    [[nodiscard]] double time_of_sample(std::size_t sample) const;
    [[nodiscard]] double flux_scale() const;
    [[nodiscard]] std::vector<double> measured_flux() const;
    [[nodiscard]] bool known_well_enough() const;
    /// Returns the shared bed stored by another case; nullptr: there is none.
    [[nodiscard]] std::unique_ptr<dem::Engine> settled_before(const dem::Setup& setup, const dem::Method& method);
    void end_settling();
    void start_sweep();
    void sample();
    /// Prepares the next layer above the bed: engine, walls and columns.
    void supply(const dem::State& bed);
    [[nodiscard]] dem::Setup setup_of_layer() const;
    /// Stores the properties of the spheres of `setup` by id.
    void take_over(const dem::Setup& setup);
    void next_layer();
    /// Returns the present powder without the particles glued to the base.
    [[nodiscard]] dem::State powder() const;
    /// Adds the particles that have left the box since the last sample to left_behind_, and stores the places of the
    /// others.
    void count_left(double front);
    [[nodiscard]] double mean_flux() const;
    [[nodiscard]] LayerAnswer layer_answer() const;
    void observe_flux(Observations& into) const;
    void observe_profile(Observations& into) const;
    void observe_tool(Observations& into) const;
    void observe_layer(Observations& into) const;
    void observe_layers(Observations& into, const LayerAnswer& last) const;

    Study study_;
    std::uint64_t seed_;
    dem::Method method_;
    Artefacts& artefacts_;
    std::unique_ptr<dem::Engine> engine_;
    std::int64_t layer_ = 0;
    std::int64_t step_ = 0;  // of this layer
    bool sweeping_ = false;
    double borrowed_particle_steps_ = 0;  // work of another case on the bed
    double earlier_particle_steps_ = 0;   // of the earlier layers
    double earlier_overlap_ = 0;
    dem::State bed_;                   // powder on the platform when this layer was supplied
    std::vector<LayerAnswer> layers_;  // earlier layers
    std::int64_t end_sample_ = sweep_samples;
    std::vector<double> volume_;  // by id, in volumes of the sphere of diameter D; 0 for spheres not supplied for this
                                  // layer
    std::vector<double> behind_;  // volume behind the edge, by sample, including particles that left the box there
    std::vector<double> under_;   // volume under the blade and below the gap, by sample
    std::vector<double> solid_;   // solid_behind by sample
    double force_sum_ = 0, lift_sum_ = 0;  // of the means between measured samples, N
    geometry::Vec3 impulse_{};             // of the powder on the tool, up to the last sample, N s
    enum class Place : char { ahead, behind, left };
    std::vector<Place> place_;      // by id: place relative to the edge at the last sample, or outside the box
    double left_behind_ = 0;        // volume that left the box behind the edge
    dem::Domain domain_;            // for pictures, as the walls
    std::vector<dem::Wall> gates_;  // gates between which the layer settles
    observables::VelocityProfile profile_{profile_layers};
    dem::State state_;  // scratch of sample()
};

}  // namespace grainsweep::spreading
