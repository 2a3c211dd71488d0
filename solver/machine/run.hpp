// Run of any machine: phases one after the other, frames at which probes are evaluated, batches of feeds, and checks
// whether a phase ends early.
//
// The spec fixes the steps of all these events, so slices of the caller, threads and resuming change no bit.
#pragma once

#include "solver/dem/engine.hpp"
#include "solver/machine/feeding.hpp"
#include "solver/machine/partner_order.hpp"
#include "solver/machine/reduction.hpp"
#include "solver/machine/setup.hpp"
#include "solver/machine/spec.hpp"
#include "solver/scenes/scene.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace grainsweep::machine {

class Run final : public Scene {
public:
    /// `artefacts` may have packings; nullptr: they are made.
    Run(Spec spec, std::uint64_t seed, Artefacts* artefacts = nullptr);

    void advance(double until) override;
    int use_threads(int count) override { return engine_->set_threads(count); }
    void observe(Observations& into) const override;
    [[nodiscard]] double time() const override { return spec_.time_step * static_cast<double>(step_); }
    [[nodiscard]] bool finished() const override { return phase_ == spec_.phases.size(); }
    [[nodiscard]] double progress() const override;
    [[nodiscard]] Health health() const override { return {fault_.empty() ? with_names(engine_->fault()) : fault_}; }
    [[nodiscard]] double particle_steps() const override {
        return engine_->work().particle_steps - borrowed_particle_steps_;
    }
    void save(Bytes& into) const override;
    void restore(std::span<const std::byte> from) override;
    [[nodiscard]] std::string remark() const override;
    [[nodiscard]] Snapshot snapshot() const override;
    [[nodiscard]] double picture_focus() const override;
    [[nodiscard]] bool may_end_early() const override;

private:
    /// Samples of a measurement so far.
    struct Record {
        std::vector<Sample> samples;
        std::vector<double> bins, sums, counts, last;  // of a profile
        std::vector<double> first;                     // of a relative value, or of each bin
        double looked = undefined;                     // time of the last frame, s
        std::vector<FrameInterval> intervals;          // between frames, of a value that is integrated
        double integral = undefined;                   // since the start, at the last frame
    };

    /// Returns a message of the engine with "wall 2" replaced by the wall's name.
    [[nodiscard]] std::string with_names(std::string fault) const;
    /// Return the largest overlaps so far.
    [[nodiscard]] double peak_overlap() const { return std::max(peak_overlap_, engine_->peak_overlap()); }
    [[nodiscard]] double peak_wall_overlap() const {
        return std::max(peak_wall_overlap_, engine_->peak_wall_overlap());
    }
    [[nodiscard]] std::int64_t steps_in(double seconds) const;
    [[nodiscard]] const Phase& phase() const { return spec_.phases[phase_]; }
    [[nodiscard]] std::int64_t phase_steps() const { return steps_in(phase().duration); }
    [[nodiscard]] std::int64_t step_of_frame(std::int64_t frame) const;
    [[nodiscard]] std::int64_t next_stop() const;
    void begin_phase();
    void judge_walls_that_appear();
    /// Ends the run if a free wall has passed through another one since the last frame.
    void judge_free_walls();
    void change_walls();
    /// Takes the state at the end of the start from another case, or stores it for others.
    void take_start(const dem::Setup& setup);
    void store_start() const;
    [[nodiscard]] std::string key_of_start() const;
    /// Takes away and fills what this phase begins with.
    void take_away();
    void fill_again();
    /// Tells moving regions where their walls are at a time of the engine's walls, s.
    void move_regions(double wall_time);
    /// Returns whether the standard error of a measurement is small enough at the last frame.
    [[nodiscard]] bool is_known(const Known& known) const;
    /// Returns what of a record belongs to a run of phases, as far as it has begun.
    [[nodiscard]] Record part_of(const Record& record, const WhileIn& phases) const;
    void end_phase(std::uint8_t condition);
    [[nodiscard]] bool measured(std::size_t phase) const;
    void stop_here();
    void feed();
    /// Returns the future steps with which a feed has already been credited.
    [[nodiscard]] std::int64_t credited_ahead(const Feed& feed) const;
    void take_frame();
    void look_once_more();
    void take(std::size_t m, const Frame& frame);
    std::int64_t run_watched_step();
    /// Returns the number of the condition that ends the phase now, from 1; 0: none.
    [[nodiscard]] std::uint8_t ended_by();
    /// Returns whether the conditions of the phase are checked in this step.
    [[nodiscard]] bool checks_here(bool framed);
    [[nodiscard]] bool holds_now(std::size_t condition);
    [[nodiscard]] bool is_quiet(const Quiet& quiet, std::size_t condition);
    /// Adds the bins of a measurement at this frame to its record.
    static void add_profile(const Measure& measure, std::span<const Sample> profile, double time, Record& record);
    enum class Contacts { none, present, of_step };
    [[nodiscard]] Frame look(Contacts contacts);
    [[nodiscard]] Frame frame() const;
    [[nodiscard]] bool has_clumps() const {
        return std::ranges::any_of(spec_.species, [](const Species& s) { return s.shape.has_value(); });
    }
    [[nodiscard]] const dem::State& particles() const { return has_clumps() ? particles_ : spheres_; }
    /// Return the number of particles present, of all so far, and of those that left the domain.
    [[nodiscard]] std::int64_t present() const;
    [[nodiscard]] std::int64_t so_far() const;
    [[nodiscard]] std::int64_t lost() const { return so_far() - present() - taken_; }
    [[nodiscard]] std::string remark_of_creep() const;
    void gather_particles();
    void add_orientations(Snapshot& picture) const;
    void give_crossings();
    [[nodiscard]] double mass_in(const Region& region);
    void add(const Filled& filled);
    /// Returns the walls with the present travel and speed of those that the powder moves.
    [[nodiscard]] std::vector<dem::Wall> walls_now() const;
    /// Stores species and size of new particles.
    void enlist(const Filled& filled);
    void observe(const Measure& measure, const Record& record, Observations& into) const;
    void observe_series(const Measure& measure, const Record& record, Observations& into) const;
    /// Returns the last run of phases of a measurement that has begun, or its first one.
    [[nodiscard]] WhileIn last_run(const Measure& measure) const;
    void observe_each(const Measure& measure, const Record& record, Observations& into) const;
    /// Returns the number and its error; NaN: undefined.
    [[nodiscard]] std::pair<double, double> reduced(const Measure& measure, const Record& record) const;
    template <class State, class Visit>
    static void fields(State& run, Visit&& visit);

    Spec spec_;
    std::uint64_t seed_;  // of fillings
    Artefacts* artefacts_;
    std::string start_key_;               // empty: the start is not shared
    double borrowed_particle_steps_ = 0;  // work of another case on the start
    double wall_zero_ = 0;                // time at which the walls were set, s
    /// Pose of a wall, for checkpoints.
    struct WallPlace {
        std::array<Vec3, 3> rows;
        Vec3 shift;
    };
    struct Follower {
        std::size_t wall;
        std::optional<Vec3> along;
        std::shared_ptr<Vec3> way;
    };
    std::vector<Follower> followers_;    // of moving regions
    dem::State bed_;                     // position, velocity and radius of the particles before the latest filling
    std::size_t newest_ = 0;             // least id of the latest filling
    std::vector<std::uint8_t> species_;  // by id
    std::vector<double> density_;        // by id; mass divided by volume
    std::vector<double> radius_;  // by id; of a clump's first member the radius of the sphere of equal volume, of
                                  // the others 0
    std::vector<std::int32_t> particle_;  // by id of a sphere, where there are clumps: id of its particle
    std::vector<std::int32_t> named_;     // ids of the particles with a name
    std::unique_ptr<dem::Engine> engine_;
    std::vector<std::unique_ptr<Probe>> probes_;                 // of measures
    std::vector<std::vector<std::unique_ptr<Probe>>> watching_;  // probes that end a phase, by phase and condition
    std::vector<std::vector<Probe*>> at_steps_;                  // of both, the probes that are called at every step,
                                                                 // by phase
    std::vector<bool> scattered_;                                // frames, by phase
    std::vector<std::size_t> first_plane_;  // of each measure in Setup::counting, and the number of all
    std::vector<Feeder> feeders_;
    bool needs_contacts_ = false;

    std::int64_t step_ = 0;
    std::size_t phase_ = 0;
    std::int64_t phase_begin_ = 0;              // step
    std::int64_t frame_ = 0;                    // next frame of the phase
    std::int64_t check_ = 0;                    // next check of the phase, counted from 1
    std::vector<double> calm_since_, watched_;  // by condition that ends the phase
    double peak_overlap_ = 0;                   // of the earlier phases
    double peak_wall_overlap_ = 0;              // likewise
    double judged_overlap_ = 0;                 // of the earlier phases that are measured: pouring harms no answer
    double judged_wall_overlap_ = 0;            // likewise
    bool has_free_walls_ = false;
    std::vector<WallPlace> places_;  // of the walls at the last frame, if one of them is free
    std::string fault_;              // of walls where none may be
    std::int64_t glued_ = 0;
    std::map<std::string, std::int64_t> counts_;  // of Filled
    std::optional<double> tight_;                 // least of the cuts
    std::optional<std::int64_t> seen_at_;         // step of the last look, if its state is still the present one
    Contacts seen_ = Contacts::none;              // of that look
    std::int64_t lost_first_ = 0;                 // particles that left in the first phase
    std::int64_t taken_ = 0;                      // particles that removals took away
    PhaseTimes times_;
    std::vector<std::uint8_t> ended_by_;  // by phase: number of the condition, from 1; 0: its time
    std::vector<Record> records_;
    dem::State spheres_;
    dem::State particles_;  // of which each clump is one; only where there are clumps
    std::vector<dem::ContactForce> contacts_;
    PartnerOrder partner_order_;
    std::vector<dem::Crossing> crossings_;
};

}  // namespace grainsweep::machine
