// Class of the mixed-precision engine. Its files:
//
//   mixed_engine.cpp      construction: spheres and walls in the engine's units
//   mixed_stepping.cpp    time steps and rebuilds of the lists
//   mixed_reading.cpp     a state in SI: particles, contacts, energy
//   mixed_checkpoint.cpp  a state to bytes and back
//
// Other code uses it only as an Engine (mixed_engine.hpp).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "solver/dem/engine.hpp"
#include "solver/dem/fast/checkpoint.hpp"
#include "solver/dem/fast/clumps.hpp"
#include "solver/dem/fast/columns.hpp"
#include "solver/dem/fast/contact_reader.hpp"
#include "solver/dem/fast/faults.hpp"
#include "solver/dem/fast/layout.hpp"
#include "solver/dem/fast/rebuild.hpp"
#include "solver/dem/fast/resting.hpp"
#include "solver/dem/fast/scale.hpp"
#include "solver/dem/fast/shared_walls.hpp"
#include "solver/dem/fast/subdomains.hpp"
#include "solver/dem/fast/wall_touches.hpp"
#include "solver/dem/fast/walls.hpp"
#include "solver/dem/fast/watch.hpp"
#include "solver/dem/step_control.hpp"

namespace grainsweep::dem::fast {

/// Relative displacements since the lists were made, in largest diameters.
struct Drift {
    double outer = std::numeric_limits<double>::infinity();
    double inner = std::numeric_limits<double>::infinity();
    double last_step = 0;
    std::int64_t steps = 0;  ///< since the outer list was made
};

/// Engine of one case, with its laws, its instruction path and its state.
class MixedEngine final : public Engine {
public:
    MixedEngine(const Setup& setup, Method::Path path, double skin, double rest_speed, Threads threads);

    void run(std::int64_t steps) override { advance(steps, false); }
    void run_part() override { advance(1, true); }
    [[nodiscard]] double part() const override { return space_.scale.time; }
    [[nodiscard]] bool at_step() const override { return part_ == 0; }
    int set_threads(int count) override;
    void set_walls(std::vector<Wall> walls) override;
    void change_walls(std::vector<Wall> walls) override;
    void add(std::span<const Sphere> spheres, std::span<const Body> bodies) override;
    void remove(std::span<const std::int32_t> ids) override;
    [[nodiscard]] std::size_t size() const override { return static_cast<std::size_t>(field_.count); }
    [[nodiscard]] double wall_time() const override { return time_after(wall_steps_); }
    void state(State& into) const override;
    [[nodiscard]] double largest_overlap() const override { return static_cast<double>(overlap()); }
    [[nodiscard]] double peak_overlap() const override { return static_cast<double>(peak_overlap_); }
    [[nodiscard]] double peak_wall_overlap() const override { return static_cast<double>(peak_wall_overlap_); }
    void forget_peak_overlap() override { peak_overlap_ = peak_wall_overlap_ = 0; }
    void contacts(std::vector<ContactForce>& into) const override { read_contacts({}, into); }
    void step_contacts(std::vector<ContactForce>& into) const override { read_contacts(motions(0), into); }
    [[nodiscard]] const Wall& wall(std::size_t wall) const override { return walls_[wall].wall(); }
    [[nodiscard]] WallLoad wall_load(std::size_t wall, const Vec3& about) const override;
    [[nodiscard]] const geometry::BodyEnergy& wall_energy(std::size_t wall) const override {
        return walls_[wall].energy();
    }
    void take_crossings(std::vector<Crossing>& into) override { crossings_.take(into); }
    [[nodiscard]] const std::string& fault() const override { return fault_; }
    [[nodiscard]] Work work() const override {
        Work done = work_;
        done.most_parts = control_.most_parts();
        return done;
    }
    void save(std::vector<std::byte>& into) const override;
    void restore(std::span<const std::byte> from) override;

private:
    void load(const Setup& setup);
    void advance(std::int64_t steps, bool one_part);
    /// Returns the time after a count of completed steps and the parts of the present one, s.
    [[nodiscard]] double time_after(std::int64_t steps) const {
        return static_cast<double>(steps * control_.parts() + part_) * space_.scale.time;
    }
    void take_parts();
    void use_parts();
    void check_network();
    void append(std::span<const Sphere> spheres, std::span<const Body> bodies, std::int32_t id);
    void map_clumps();
    void advance_clumps();
    void restore_clumps();
    void suit_caches();
    [[nodiscard]] float single_radius(const Sphere& sphere) const;
    [[nodiscard]] double relative_density(const Sphere& sphere) const;
    void write_pair_laws();
    void stand_walls();
    void begin_tally();
    void press_walls(bool moves);
    [[nodiscard]] std::vector<Velocities> motions(double share = 1) const;
    void read_contacts(std::span<const Velocities> before, std::vector<ContactForce>& into) const;
    [[nodiscard]] Moment moment(std::span<const Velocities> motions) const;
    void set_limits();
    void check_energy();
    void account_travel();
    void make_lists(std::span<const std::int32_t> removed = {});
    void list_advanced();
    void list_crossings();
    void follow_crossings();
    [[nodiscard]] Vec3 place_to_follow(std::size_t i) const;
    void use_wanted_subdomains();
    void advance_particles();
    void sweep_pairs(bool goes_on, bool advance, bool keep_histories);
    void join_lists() const { subdomains_.join(field_, columns_); }
    void shift_velocities(double way);
    void full_step_velocities();
    void restart_forces(std::span<const std::int32_t> removed = {});
    void shake();
    [[nodiscard]] Seal seal() const;
    [[nodiscard]] double half_change(std::int32_t particle, int axis) const;
    [[nodiscard]] double half_spin_change(std::int32_t particle, int axis) const;
    [[nodiscard]] FaultView view() const {
        join_lists();
        return {field_, columns_.id.data(), space_.scale,           walls_, table_, smallest_diameter_,
                sound_, work_.steps,        time_after(work_.steps)};
    }
    /// Returns the largest overlap of all pairs divided by the smaller diameter, including parked contacts.
    [[nodiscard]] float overlap() const { return std::max(tally_.overlap, resting_.overlap()); }
    /// Returns the number of ids given so far.
    [[nodiscard]] std::int32_t ids() const { return spheres_at_start_ + static_cast<std::int32_t>(added_.size()); }
    [[nodiscard]] bool is_frozen(std::int32_t particle) const { return !(field_.records[particle].inverse_mass > 0); }
    [[nodiscard]] bool is_member(std::int32_t particle) const {
        return field_.member != nullptr && field_.member[particle] >= 0;
    }
    [[nodiscard]] bool is_resting(std::int32_t particle) const {
        return needs_.resting && resting_.holds(particle) && !is_frozen(particle);
    }
    [[nodiscard]] bool beyond(const SoundOverlaps& limits) const {
        return tally_.overlap > limits.pair || tally_.wall_overlap > limits.wall;
    }
    /// Takes the overlaps of the last sweep into the peaks.
    void note_overlaps() {
        peak_overlap_ = std::max(peak_overlap_, overlap());
        peak_wall_overlap_ = std::max(peak_wall_overlap_, tally_.wall_overlap);
    }
    /// Returns whether contacts must be judged individually.
    [[nodiscard]] bool suspicious() const { return contacts_differ_ && beyond(resolved_); }
    template <class Self, class Archive>
    static void pass(Self& self, Archive& archive);
    void require_possible() const;
    void tidy_spare_entries();
    void clear_spare_entries() const;
    static void pass_walls(const MixedEngine& self, Writer& archive);
    static void pass_walls(MixedEngine& self, Reader& archive);

    ListSpace space_;
    Vec3 gravity_;
    Shaking shaking_;
    bool shaken_;
    Needs needs_;
    double rest_speed_;
    const Kernels* kernels_;
    std::vector<double> densities_;  ///< of Setup::kinds, kg/m3
    std::vector<ToCome> to_come_;
    ContactTable table_;
    PairContacts laws_;                ///< in SI, for calculations outside a step
    std::vector<std::uint8_t> kinds_;  ///< of spheres of the start by id
    std::vector<std::uint8_t> added_;  ///< of those added since
    std::vector<double> constants_;    ///< constants of the laws, see Field::laws_of_pairs
    std::vector<Material> materials_;  ///< of particles and walls at the start
    Walls walls_;
    WallTouches touches_;
    float smallest_diameter_ = 1;
    float lightest_ = 1;  ///< reference density divided by the smallest
    bool contacts_differ_;
    std::array<SoundOverlaps, most_halvings + 1> resolved_in_parts_;  ///< resolved_ for each number of halvings
    SoundOverlaps resolved_;
    SoundOverlaps sound_;            ///< limits of a sound state: equal to resolved_, unless contacts differ
    bool box_includes_rest_ = true;  ///< displacements are also relative to a body at rest or a face

    Watch watch_;
    Clumps clumps_;
    Vec3 acceleration_;  ///< of gravity and shaking at the present step, m/s2
    Setup announced_;    ///< shapes and domain, by which clumps that are added are judged
    Columns columns_;
    Resting resting_;
    Subdomains subdomains_;
    SharedWalls shared_walls_;
    std::optional<Refresh> refresh_;  ///< request to refresh the subdomains' inner lists in the next sweep
    Threads threads_;
    Field field_{};
    Tally tally_{};
    float peak_overlap_ = 0;       ///< largest of overlap() so far
    float peak_wall_overlap_ = 0;  ///< likewise, at walls
    Drift drift_;
    float inner_skin_ = 0;
    float largest_skin_ = std::numeric_limits<float>::infinity();
    bool adapts_skin_;
    StepControl control_;
    Network network_;            ///< scratch of check_network()
    double time_step_;           ///< s
    Constants start_constants_;  ///< of whole steps
    std::vector<double> start_laws_;
    std::int64_t part_ = 0;      ///< parts of the present step that are done
    double recent_overlap_ = 0;  ///< largest of the last sweep, of pairs and at walls, in diameters
    std::int32_t spheres_at_start_ = 0;
    Crossings crossings_;
    std::int64_t wall_steps_ = 0;
    std::int64_t mobile_ = 0;
    Work work_;
    std::string fault_;
};

}  // namespace grainsweep::dem::fast
