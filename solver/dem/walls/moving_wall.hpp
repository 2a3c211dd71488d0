// A wall in its domain at a time: where it stands, how its points move, and where particles touch it.
//
// A particle is taken to the wall's nearest periodic image and, where the wall has turned, into its body frame, in
// double precision; a wall that is only shifted is evaluated where it stands. Some motions leave the surface where it
// is: a drum that turns about its axis, a belt that runs in its plane. They move the material only. They do not change
// the place of the wall, and lists need not follow them.
#pragma once

#include "solver/dem/walls/wall.hpp"
#include "solver/geometry/domain.hpp"
#include "solver/particles/cells.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace grainsweep::dem {

/// A particle within reach of a wall, in one place of it.
struct WallTouch {
    std::uint32_t entry = 0;  ///< of the list that was searched
    geometry::Closest place;
};

/// Along periodic axes across which a wall has ends: the middle of it and the period, else 0.
struct NearestImage {
    Vec3 middle{}, period{};

    [[nodiscard]] Vec3 of(Vec3 x) const {
        for (std::size_t k = 0; k < 3; ++k)
            if (period[k] > 0) x[k] -= period[k] * std::nearbyint((x[k] - middle[k]) / period[k]);
        return x;
    }
};

class MovingWall {
public:
    /// `largest`: radius of the largest particle. Throws std::invalid_argument with one sentence on what cannot be.
    MovingWall(Wall wall, const geometry::Domain& domain, double largest);

    /// The same body with the motions and presence of `other`; place() completes it. Throws as the constructor does,
    /// and where `other` is another body.
    [[nodiscard]] MovingWall moving_as(const Wall& other, const geometry::Domain& domain) const;

    /// Lets it stand where, and move as, it does at `time` after the walls were set, s. What has several contacts
    /// starts from rest: it has no velocity yet at time 0, before the first step, so that powder that rests on it is
    /// not pushed by a dashpot before anything has slipped (LIGGGHTS has moving meshes so). What has one contact moves
    /// by then.
    void place(double time);

    /// Whether the powder moves it: it has a press or a drive.
    [[nodiscard]] bool free() const { return free_; }
    /// Changes the speeds of a free wall by a load, which acts for `span` from `time` on; see geometry::kick.
    void kick(const Vec3& force, const Vec3& torque, const Vec3& about, double time, double span);
    /// Moves a free wall on by its speeds; place() completes it.
    void drift(double span);
    /// What changed the kinetic energy of a free wall since the walls were set.
    [[nodiscard]] const geometry::BodyEnergy& energy() const { return energy_; }
    /// That of a checkpoint.
    void take_energy(const geometry::BodyEnergy& energy) { energy_ = energy; }

    [[nodiscard]] const Wall& wall() const { return wall_; }
    /// The shape as particles find it in its body frame: with its images where they can touch more than one.
    [[nodiscard]] const Shape& found() const { return found_; }
    [[nodiscard]] const geometry::Pose& pose() const { return pose_; }
    /// Where it stood a step before it was placed last; of a free wall as drift() found it.
    [[nodiscard]] geometry::Pose pose_before(double time) const {
        return free_ ? before_ : geometry::pose_at(displacing_, time);
    }
    [[nodiscard]] geometry::Pose pose_at(double time) const { return geometry::pose_at(displacing_, time); }
    [[nodiscard]] const geometry::Twist& twist() const { return twist_; }  ///< of the material
    [[nodiscard]] const NearestImage& image() const { return image_; }
    /// Upper bound of how far a point of the surface that a particle can reach is from where it was in `before`, m.
    [[nodiscard]] Vec3 moved_since(const geometry::Pose& before) const;
    /// Least and largest velocity components of the surface, where a particle can reach it, during the `step` after
    /// `time`, m/s.
    void surface_velocities(double time, double step, Vec3& low, Vec3& high) const;
    /// Upper bound of the material's speed at all times, m/s; of the surface, without motions that leave it in place.
    [[nodiscard]] double fastest() const { return fastest_; }
    [[nodiscard]] double fastest_surface() const { return fastest_surface_; }
    [[nodiscard]] bool at_rest() const { return wall_.motions.empty(); }
    /// Whether anything can touch it; one that is absent need not be placed.
    [[nodiscard]] bool present() const { return wall_.present; }

    /// The particles of `list` nearer than their radius plus `beyond`, with the places, in the order of the list.
    void find(std::span<const std::uint32_t> list, std::span<const Vec3> position, const particles::Radii& radii,
              double beyond, std::vector<WallTouch>& into) const;
    /// Of one particle; `into` keeps what it has.
    void find(std::uint32_t entry, const Vec3& position, double reach, std::vector<WallTouch>& into) const;
    /// Where the contacts of one particle take their memory from: for each of `now` its number in `before`, or -1. That
    /// of a shape with one contact goes on as long as it lasts, others by their normals (geometry/contact_memory.hpp).
    void inherit(std::span<const WallTouch> before, std::span<const WallTouch> now,
                 std::vector<std::int32_t>& from) const;

    /// Whether it has no inside, so that a centre could pass it unseen.
    [[nodiscard]] bool thin() const { return thin_; }
    /// Whether a centre that moved straight from one place to another passed it; `before`: its pose at the start.
    [[nodiscard]] bool passed(const geometry::Pose& before, const Vec3& from, const Vec3& to) const;

private:
    void take_motions(std::vector<geometry::Motion> motions);
    void bound_speeds();
    void require_possible(const geometry::Domain& domain) const;
    [[nodiscard]] Shape with_images(const geometry::Domain& domain) const;
    [[nodiscard]] std::array<Vec3, 8> corners(const geometry::Pose& pose) const;
    /// At any time, and at one time.
    [[nodiscard]] double bound_of_speed(std::span<const geometry::Motion> motions) const;
    [[nodiscard]] double bound_of_speed_at(std::span<const geometry::Motion> motions, double time) const;

    Wall wall_;
    Shape found_;
    std::vector<geometry::Motion> displacing_;  // those that move the surface
    bool switches_ = false;                     // one of them starts late or ends
    bool free_ = false;
    geometry::Pose before_;        // of a free wall
    geometry::BodyEnergy energy_;  // likewise
    bool bounded_ = false;
    bool single_contact_ = true;
    bool thin_ = false;
    Vec3 low_{}, high_{};  // of the body where it has ends everywhere, else of the space particles can reach
    NearestImage body_image_, image_;
    geometry::Pose pose_;
    geometry::Twist twist_;
    double fastest_ = 0, fastest_surface_ = 0;
};

}  // namespace grainsweep::dem
