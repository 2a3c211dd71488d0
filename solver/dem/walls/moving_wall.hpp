// Wall in its domain at a time: its place, the velocity of its points, and the places where particles touch it.
//
// A particle is transformed to the wall's nearest periodic image and, if the wall has rotated, to its body frame, in
// double precision. A wall that is only shifted needs no body frame. Some motions do not move the surface, only the
// material: a drum rotating about its axis, a belt running in its plane. They do not change the place of the wall, so
// lists stay valid.
#pragma once

#include "solver/dem/walls/wall.hpp"
#include "solver/geometry/bounds.hpp"
#include "solver/geometry/domain.hpp"
#include "solver/particles/cells.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace grainsweep::dem {

/// Touch of a wall by a particle in one place.
struct WallTouch {
    std::uint32_t entry = 0;  ///< index in the searched list
    geometry::Closest place;
};

/// Middle of a wall and period, along periodic axes across which the wall has ends; else 0.
struct NearestImage {
    Vec3 middle{}, period{};

    [[nodiscard]] Vec3 of(Vec3 x) const {
        for (std::size_t k = 0; k < 3; ++k)
            if (period[k] > 0) x[k] -= period[k] * std::nearbyint((x[k] - middle[k]) / period[k]);
        return x;
    }
};

/// Returns the motions that move the surface of a shape. A rotation may leave the surface unchanged only if all earlier
/// rotations do; a shift, only if no motion rotates the shape.
[[nodiscard]] std::vector<geometry::Motion> displacing(const Shape& shape, std::span<const geometry::Motion> motions);

/// Integrals of the load on a wall over time: of the force, N s, and of the torque about the origin, N m s.
struct LoadIntegrals {
    Vec3 impulse{}, angular_impulse{};
};

class MovingWall {
public:
    enum class Searches { many, few };
    /// `largest`: radius of the largest particle. For few searches the wall is not prepared, which saves milliseconds
    /// for a mesh and changes no contact. Throws std::invalid_argument with one sentence for an impossible wall.
    MovingWall(Wall wall, const geometry::Domain& domain, double largest, Searches searches = Searches::many);

    /// Returns the same body with the motions and presence of `other`; place() completes it. Throws like the
    /// constructor, and if `other` is another body.
    [[nodiscard]] MovingWall moving_as(const Wall& other, const geometry::Domain& domain) const;

    /// Sets place and velocity of the wall at `time` after the walls were set, s. A shape with several contacts has no
    /// velocity at time 0, before the first step. So a dashpot does not push powder on it before the first slip (moving
    /// meshes in LIGGGHTS behave in the same way). A shape with one contact has its velocity then.
    void place(double time);

    /// Returns whether the powder moves it: it has a press or a drive.
    [[nodiscard]] bool free() const { return free_; }
    /// Changes the speeds of a free wall by a load, which acts for `span` from `time` on; see geometry::kick.
    void kick(const Vec3& force, const Vec3& torque, const Vec3& about, double time, double span);
    /// Moves a free wall by its speeds; place() completes the motion.
    void drift(double span);
    /// What changed the kinetic energy of a free wall since the walls were set.
    [[nodiscard]] const geometry::BodyEnergy& energy() const { return energy_; }

    /// Adds a load that acts for `span`, s; the torque is about a point.
    void integrate(const Vec3& force, const Vec3& torque, const Vec3& about, double span);
    [[nodiscard]] const Vec3& impulse() const { return integrals_.impulse; }
    [[nodiscard]] Vec3 angular_impulse(const Vec3& about) const;

    /// Calls visit for what a checkpoint has of it beside its Wall.
    template <class Self, class Visit>
    static void for_each_sum(Self& self, Visit&& visit) {
        if (self.free_) visit(self.energy_);
        if (self.wall_.integrated) visit(self.integrals_);
    }

    [[nodiscard]] const Wall& wall() const { return wall_; }
    /// Returns the shape in its body frame that is searched for contacts; with its images if a particle can touch
    /// several.
    [[nodiscard]] const Shape& found() const { return found_; }
    [[nodiscard]] const geometry::Pose& pose() const { return pose_; }
    /// Returns its pose one step before the last place(); for a free wall before drift().
    [[nodiscard]] geometry::Pose pose_before(double time) const {
        return free_ ? before_ : geometry::pose_at(displacing_, time);
    }
    [[nodiscard]] geometry::Pose pose_at(double time) const { return geometry::pose_at(displacing_, time); }
    [[nodiscard]] const geometry::Twist& twist() const { return twist_; }  ///< of the material
    [[nodiscard]] const NearestImage& image() const { return image_; }
    /// Returns an upper bound of the displacement since `before` of any point of the surface that a particle can reach,
    /// m.
    [[nodiscard]] Vec3 moved_since(const geometry::Pose& before) const;
    /// Returns the smallest and largest velocity components of the surface within reach of particles, during the
    /// `step` after `time`, m/s.
    [[nodiscard]] geometry::Bounds surface_velocities(double time, double step) const;
    /// Return upper bounds at all times, m/s, of the speed of the material, and of the surface (without motions that do
    /// not move it).
    [[nodiscard]] double fastest() const { return fastest_; }
    [[nodiscard]] double fastest_surface() const { return fastest_surface_; }
    [[nodiscard]] bool at_rest() const { return wall_.motions.empty(); }
    /// Returns whether particles can touch it; an absent wall needs no place().
    [[nodiscard]] bool present() const { return wall_.present; }

    /// Finds the particles of `list` nearer than their radius plus `beyond`, with the places, in the order of the list.
    void find(std::span<const std::uint32_t> list, std::span<const Vec3> position, const particles::Radii& radii,
              double beyond, std::vector<WallTouch>& into) const;
    /// Appends the touches of one particle.
    void find(std::uint32_t entry, const Vec3& position, double reach, std::vector<WallTouch>& into) const;
    /// Returns the entry in `list` of the first sphere that lies deeper in the wall than a share of its diameter, but
    /// not as a whole behind it.
    [[nodiscard]] std::optional<std::uint32_t> reaches(std::span<const std::uint32_t> list,
                                                       std::span<const Vec3> position, const particles::Radii& radii,
                                                       double share) const;
    /// Finds the origin of the memory of one particle's contacts: for each of `now` its index in `before`, or -1. For a
    /// shape with one contact the memory continues as long as the contact. Several contacts are matched by their
    /// normals (geometry/contact_memory.hpp).
    void inherit(std::span<const WallTouch> before, std::span<const WallTouch> now,
                 std::vector<std::int32_t>& from) const;

    /// Returns whether the wall has no inside, so that a centre could pass it unnoticed.
    [[nodiscard]] bool thin() const { return thin_; }
    /// Returns whether a centre that moved straight from one place to another passed the wall; `before`: pose of the
    /// wall at the start.
    [[nodiscard]] bool passed(const geometry::Pose& before, const Vec3& from, const Vec3& to) const;

private:
    void take_motions(std::vector<geometry::Motion> motions);
    void bound_speeds();
    void require_possible(const geometry::Domain& domain) const;
    [[nodiscard]] Shape with_images(const geometry::Domain& domain) const;
    [[nodiscard]] std::array<Vec3, 8> corners(const geometry::Pose& pose) const;
    /// Return bounds of the speed at all times, and at one time.
    [[nodiscard]] double bound_of_speed(std::span<const geometry::Motion> motions) const;
    [[nodiscard]] double bound_of_speed_at(std::span<const geometry::Motion> motions, double time) const;

    Wall wall_;
    Shape found_;
    std::vector<geometry::Motion> displacing_;  // motions that move the surface
    bool switches_ = false;                     // one of these motions starts late or ends
    bool free_ = false;
    geometry::Pose before_;        // of a free wall
    geometry::BodyEnergy energy_;  // likewise
    LoadIntegrals integrals_;
    bool bounded_ = false;
    bool single_contact_ = true;
    bool thin_ = false;
    Vec3 low_{}, high_{};  // of the body if it is finite, else of the space that particles can reach
    NearestImage body_image_, image_;
    geometry::Pose pose_;
    geometry::Twist twist_;
    double fastest_ = 0, fastest_surface_ = 0;
};

}  // namespace grainsweep::dem
