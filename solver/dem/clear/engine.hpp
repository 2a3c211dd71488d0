// The clear engine: double precision, one loop for each step of the method.
//
//     v += dt/2 (f/m + g);  x += dt v;  w += dt/2 T/I;   f, T from (x, v, w);   v, w: second half     I = 2/5 m R^2
//
// Velocity Verlet. The contact laws use half-step velocities, as in LIGGGHTS 3.8. At the start, and when walls are set,
// forces are evaluated once at full-step velocities without advancing the memories of contacts.
//
// The neighbour list is rebuilt when any particle or wall has moved by half the skin, so no contact is missed. A
// rebuild sorts the particles by cell. Sums have a fixed order: the same input gives the same bits.
#pragma once

#include "solver/bytes.hpp"
#include "solver/dem/clear/bodies.hpp"
#include "solver/dem/energy_balance.hpp"
#include "solver/dem/kinds.hpp"
#include "solver/dem/reading.hpp"
#include "solver/dem/step_control.hpp"
#include "solver/dem/walls/moving_wall.hpp"
#include "solver/geometry/domain.hpp"
#include "solver/particles/neighbour_list.hpp"
#include "solver/particles/pair_memory.hpp"
#include "solver/particles/particles.hpp"

#include <unordered_set>

namespace grainsweep::dem::clear {

/// Wall, with the particles that may touch it before the next rebuild, ascending, and its contacts.
struct WallContacts {
    MovingWall wall;
    std::vector<std::unique_ptr<const AnyContact>> laws;  // one for its contacts with each kind of spheres
    std::vector<double> stiffness;                        // likewise, divided by the stiffness of the first pair of
                                                          // kinds
    std::vector<std::uint32_t> near;
    double built = 0;  // wall time of the last listing, s
    geometry::Pose pose_when_built;
    // Of the last evaluation, in the order of `near`; several touches of one particle are distinguished by their
    // normals.
    std::vector<WallTouch> touches;
    std::vector<double> memory;  // all components of one touch, then of the next
    WallLoad load;               // about load_about
    Vec3 load_about{};
};

class ClearEngine final : public Engine {
public:
    /// `equal`: all radii are the same; reduced masses and radii then have simpler formulas (with other last digits).
    ClearEngine(const Setup& setup, const Method& method, const AnyContact& laws, bool equal);

    void run(std::int64_t steps) override;
    void run_part() override { step(); }
    [[nodiscard]] double part() const override { return part_; }
    [[nodiscard]] bool at_step() const override { return parts_done_ == 0; }
    void set_walls(std::vector<Wall> walls) override;
    void change_walls(std::vector<Wall> walls) override;
    void add(std::span<const Sphere> spheres, std::span<const Body> bodies) override;
    void remove(std::span<const std::int32_t> ids) override;

    [[nodiscard]] std::size_t size() const override { return p_.size(); }
    [[nodiscard]] double wall_time() const override { return time_after(wall_steps_); }
    void state(State& into) const override;
    [[nodiscard]] double largest_overlap() const override { return largest_overlap_; }
    [[nodiscard]] double peak_overlap() const override { return peak_overlap_; }
    [[nodiscard]] double peak_wall_overlap() const override { return peak_wall_overlap_; }
    void forget_peak_overlap() override { peak_overlap_ = peak_wall_overlap_ = 0; }
    void contacts(std::vector<ContactForce>& into) const override { read_contacts(false, into); }
    void step_contacts(std::vector<ContactForce>& into) const override { read_contacts(true, into); }
    [[nodiscard]] const Wall& wall(std::size_t wall) const override { return walls_.at(wall).wall.wall(); }
    [[nodiscard]] WallLoad wall_load(std::size_t wall, const Vec3& about) const override;
    [[nodiscard]] const geometry::BodyEnergy& wall_energy(std::size_t wall) const override {
        return walls_.at(wall).wall.energy();
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
    using Contacts = WallContacts;

    [[nodiscard]] double radius(std::size_t i) const { return p_.radius[i]; }
    [[nodiscard]] bool mobile(std::size_t i) const { return p_.inverse_mass[i] > 0; }
    /// Returns 1/m of a mobile particle.
    [[nodiscard]] double inverse_mass(std::size_t i) const { return p_.inverse_mass[i]; }
    /// Returns m*; a frozen partner has infinite mass.
    [[nodiscard]] double reduced_mass(std::size_t i, std::size_t j) const {
        if (!equal_) return 1 / (p_.inverse_mass[i] + p_.inverse_mass[j]);
        return mobile(i) && mobile(j) ? mass_ / 2 : mass_;
    }
    /// Returns the same at a contact with a normal: a clump's side of it has the mass of its shape's DampingMass.
    [[nodiscard]] double reduced_mass(std::size_t i, std::size_t j, const Vec3& normal) const {
        if (!bodies_.is_member(i) && !bodies_.is_member(j)) return reduced_mass(i, j);
        return 1 / (inverse_mass_at(i, normal) + inverse_mass_at(j, normal));
    }
    [[nodiscard]] double inverse_mass_at(std::size_t i, const Vec3& normal) const {
        return bodies_.is_member(i) ? bodies_.inverse_mass_at(i, normal) : p_.inverse_mass[i];
    }
    [[nodiscard]] double effective_radius(std::size_t i, std::size_t j) const {
        return equal_ ? radius(i) / 2 : radius(i) * radius(j) / (radius(i) + radius(j));
    }
    /// Returns 1/(1/I_i + 1/I_j) about the contact; a frozen partner does not rotate.
    [[nodiscard]] double rolling_inertia(std::size_t i, std::size_t j) const {
        const double ri = radius(i), rj = radius(j);
        return inertia_about_contact / (inverse_mass(i) / (ri * ri) + inverse_mass(j) / (rj * rj));
    }
    [[nodiscard]] std::size_t pair(std::size_t i, std::size_t j) const { return place_of_pair(p_.kind[i], p_.kind[j]); }
    [[nodiscard]] const AnyContact& laws_of(std::size_t i, std::size_t j) const { return *laws_[pair(i, j)]; }
    [[nodiscard]] particles::Radii radii() const { return {0, p_.radius}; }
    /// Returns the number of ids given so far.
    [[nodiscard]] std::size_t ids() const { return spheres_at_start_ + added_.size(); }
    /// Returns dF_n/dd divided by normal_slope(), from the radius of the contact.
    [[nodiscard]] double slope_over(double contact_radius) const { return linear_ ? 1 : contact_radius; }
    /// Returns the number of components of a contact's memory.
    [[nodiscard]] std::size_t memories() const { return pairs_.components(); }

    // forces.cpp; `advance`: memories of contacts advance by a time step
    void evaluate(bool advance);
    [[nodiscard]] std::size_t find_touching(std::size_t first, std::size_t last);
    void pair_contacts(bool advance);
    void wall_contacts(Contacts& contacts, bool advance);
    void find_touches(Contacts& contacts);
    template <class T>
    [[nodiscard]] bool begins(const AnyContact& laws, T& t, double* memory) const;
    [[nodiscard]] Touch<Partner::particle> touch(std::size_t i, std::size_t j, const Vec3& branch, double r2) const;
    [[nodiscard]] Touch<Partner::wall> touch(std::size_t i, const geometry::Closest& closest, const Vec3& v) const;
    template <class Visit>
    void for_each_touching_pair(Visit&& visit) const;
    template <class Visit>
    void for_each_touched_wall(Visit&& visit) const;
    [[nodiscard]] Velocities half_a_step_before(std::size_t i) const;
    void read_contacts(bool of_step, std::vector<ContactForce>& into) const;
    [[nodiscard]] double mechanical_energy(double& active) const;

    // stepping.cpp
    void step();
    void use_parts();
    /// Returns the time after a count of completed steps and the parts of the present one, s.
    [[nodiscard]] double time_after(std::int64_t steps) const {
        return part_ * static_cast<double>(steps * control_.parts() + parts_done_);
    }
    [[nodiscard]] double inverse_mass_of(const Sphere& sphere) const;
    void append(std::span<const Sphere> spheres, std::span<const Body> bodies, std::size_t id);
    void map_bodies();
    [[nodiscard]] std::vector<bool> wrap_bodies(const std::unordered_set<std::int32_t>& removed);
    void restart_forces();
    void kick_and_drift();
    void kick();
    void kick_walls();
    void shake();
    [[nodiscard]] Vec3 momentum() const;
    void rebuild(std::span<const std::int32_t> removed = {});
    void forget_separated();
    [[nodiscard]] std::vector<double> constants() const;
    [[nodiscard]] std::vector<Contacts> make_walls(const std::vector<Wall>& walls) const;
    void list_walls(std::span<const std::uint32_t> fresh_index);
    void carry_touches(Contacts& contacts, std::span<const std::uint32_t> before,
                       std::span<const std::uint32_t> fresh_index) const;
    [[nodiscard]] bool list_is_stale() const;
    void list_crossings();

    // soundness.cpp
    [[nodiscard]] bool sound();
    void check_energy();
    void check_network();
    void gather_network();
    void set_speed_limit();
    void judge_wall_speeds();
    void judge_passages(const Contacts& contacts);
    void judge_frozen();
    void report(const std::string& what, std::size_t i);
    void report_contacts();

    // checkpoint.cpp
    template <class Self, class Visit>
    static void visit_state(Self& self, Visit&& visit);
    void require_possible() const;
    void map_restored_bodies();
    void restore_walls(ByteReader& in);

    ContactTable table_;
    std::vector<std::unique_ptr<const AnyContact>> laws_;  // of pairs of kinds
    std::vector<double> stiffness_;                        // normal_slope() of these divided by that of the first pair
    bool spins_, rolls_, reaches_, remembers_separation_;  // traits of the laws
    geometry::Domain domain_;
    std::array<Vec3, 27> image_shifts_;
    Vec3 gravity_;
    Shaking shaking_;
    bool shaken_;
    Vec3 body_;  // acceleration of a free particle at the present step: gravity and shaking
    double time_step_;
    StepControl control_;
    double part_;                  // length of a part of a step, s
    std::int64_t parts_done_ = 0;  // of the present step
    bool equal_;
    double mass_ = 0;                           // mass of every particle, if equal_
    Radii radii_;                               // of all spheres, including those that may be added
    std::pair<double, double> inverse_masses_;  // least and largest of them
    bool linear_;                               // the normal law
    double deepest_in_walls_;
    double swing_factor_;  // part^2 normal_slope() of the first pair; times stiffest_ it is the square of a contact's
                           // phase per step
    double skin_;
    double beyond_pair_ = 0, beyond_wall_ = 0;  // largest gap of a lasting contact, m
    std::vector<double> densities_;             // of kinds of contact, kg/m3
    std::vector<ToCome> to_come_;
    std::size_t spheres_at_start_;
    Setup announced_;                  // shapes and domain, by which clumps that are added are judged
    std::vector<std::uint8_t> added_;  // kinds of the spheres added since

    particles::Particles p_;
    Bodies bodies_;
    std::vector<Vec3> position_at_build_;
    std::vector<std::uint32_t> near_open_face_;
    particles::NeighbourList list_;
    particles::PairMemory pairs_;
    std::vector<Contacts> walls_;
    particles::Cells cells_;
    struct Touching {
        Vec3 branch;
        double r2;
        std::uint32_t i, entry;
    };
    std::vector<Touching> touching_;         // scratch of pair_contacts
    std::vector<WallTouch> touched_before_;  // scratch of find_touches
    std::vector<double> memory_before_;      // likewise

    std::int64_t wall_steps_ = 0;
    bool displaced_ = false;  // a particle has moved by half the skin, or its position is NaN
    double largest_overlap_ = 0;
    double peak_overlap_ = 0;          // largest of it so far
    double largest_wall_overlap_ = 0;  // divided by the diameter
    double peak_wall_overlap_ = 0;     // largest of it so far
    double stiffest_ = 0;              // largest slope_over() of a contact divided by its mass, times its stiffness
    double speed_limit_ = 0;
    double work_of_walls_ = 0;     // J, since the walls were set
    double work_of_shaking_ = 0;   // J, since the start
    double work_of_wrapping_ = 0;  // J, potential energy lost when particles wrap at periodic faces
    EnergyBalance balance_;
    Network network_;  // scratch of check_network
    Crossings crossings_;
    std::string fault_;
    Work work_;
};

/// Returns an engine at step 0 for a valid setup, which make_engine has checked.
[[nodiscard]] std::unique_ptr<Engine> make_clear_engine(const Setup& setup, const Method& method);

}  // namespace grainsweep::dem::clear
