// The DEM step written down as plainly as possible: double precision, every pair looked at every step, histories in a
// map. The opponent of every optimised engine; a few hundred particles at most.
#pragma once

#include <map>
#include <set>
#include <utility>
#include <vector>

#include "solver/dem/engine.hpp"

namespace grainsweep::tests {

/// Velocity Verlet with the Hertz-Mindlin law of solver/dem/engine.hpp, forces of the start without histories. A shaken
/// vessel is computed in the laboratory's frame: frozen spheres move (walls do not: give none), and so, at the start,
/// do the mobile ones that rest in it.
class PlainDem {
public:
    explicit PlainDem(const dem::Setup& setup);

    void run(std::int64_t steps);
    void set_walls(std::vector<dem::Wall> walls);
    /// Marks a particle as gone.
    void remove(std::int32_t id);

    [[nodiscard]] const std::vector<dem::Vec3>& position() const { return x_; }
    [[nodiscard]] dem::Vec3 displacement() const { return displacement(steps_); }  ///< of the vessel, m
    [[nodiscard]] const std::vector<dem::Vec3>& velocity() const { return v_; }
    [[nodiscard]] const std::vector<dem::Vec3>& angular_velocity() const { return w_; }
    [[nodiscard]] const std::vector<dem::Vec3>& force() const { return f_; }
    [[nodiscard]] double largest_overlap() const { return largest_overlap_; }
    [[nodiscard]] std::size_t contacts() const { return pair_history_.size(); }
    [[nodiscard]] double kinetic_energy() const;

private:
    using Key = std::pair<std::size_t, std::size_t>;
    struct Contact;
    void forces(bool update);
    void pair(std::size_t i, std::size_t j, bool update);
    void wall(std::size_t i, std::size_t w, bool update);
    static void attract(Contact& c, double area);
    [[nodiscard]] static double bridge_volume(const dem::Material& m, double radius, bool at_wall);
    [[nodiscard]] static double end_of_contact(const dem::Material& m, double radius, bool lasts, bool at_wall);
    /// Force on i and n x F_t of one contact.
    [[nodiscard]] static double of_limit(const dem::Material& m, double force, double damper, double speed);
    void respond(const Contact& c, bool update, dem::Vec3& history, dem::Vec3& force, dem::Vec3& turn) const;
    /// Moment on i of the rolling resistance.
    [[nodiscard]] dem::Vec3 rolling(const Contact& c, bool update, dem::Vec3& history, const dem::Vec3& force) const;
    [[nodiscard]] double mass(std::size_t i) const;
    [[nodiscard]] dem::Vec3 displacement(std::int64_t step) const;
    void move_frozen();

    dem::Setup setup_;
    std::vector<dem::Vec3> x_, v_, w_, f_, t_;
    std::vector<char> gone_;
    std::map<Key, dem::Vec3> pair_history_, wall_history_, pair_rolling_, wall_rolling_;
    std::set<Key> pairs_that_last_, at_walls_that_last_;
    std::int64_t wall_steps_ = 0;
    std::int64_t steps_ = 0;
    double largest_overlap_ = 0;
};

}  // namespace grainsweep::tests
