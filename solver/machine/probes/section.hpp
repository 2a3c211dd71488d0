// Shared parts of the probes of a bed in a drum: the view along its axis, and sums over the frames.
#pragma once

#include "solver/machine/selection.hpp"
#include "solver/observables/turned_bed.hpp"

#include <optional>

namespace grainsweep::machine {

inline constexpr Field section_axis_option =
    option("axis", Field::Kind::direction, "",
           "the axis of the drum; angles are positive where turning about it, right hand, raises the bed", true);
inline constexpr Field section_through_option =
    option("through", Field::Kind::vector, "m", "a point on the axis; default: the origin");
inline constexpr Field section_radius_option =
    option("radius", Field::Kind::quantity, "m", "inner radius of the drum", true, {0, 1e3, true, false});
inline constexpr Field section_diameter_option =
    option("diameter", Field::Kind::quantity, "m", "diameter D of the particles", true, {0, 1e3, true, false});

/// Selected particles in the plane across an axis, with "up" against gravity.
class SectionLook {
public:
    /// `by_members`: a clump is all of its spheres; else it is the sphere of equal volume at its centre of mass.
    explicit SectionLook(const Options& options, bool by_members = false)
        : by_members_(by_members),
          selection_(options),
          axis_(options.vector("axis")),
          through_(options.vector("through", {})) {}

    /// Returns nothing if gravity has no component across the axis: there is no surface.
    [[nodiscard]] std::optional<observables::Section> operator()(const Frame& given) const {
        const Frame frame = by_members_ ? given.of_spheres() : given;
        using geometry::operator-;
        using geometry::operator*;
        const Vec3 down = frame.gravity - geometry::dot(frame.gravity, axis_) * axis_;
        const double size = geometry::norm(down);
        if (!(size > 0)) return std::nullopt;
        const Vec3 up = (-1 / size) * down;
        const observables::SectionView view{through_, geometry::cross(axis_, up), up};
        observables::Section section;
        section.reserve(frame.size());
        selection_.each(frame, [&](std::size_t i) { section.push_back(view.sphere(frame.state, i)); });
        return section;
    }

private:
    bool by_members_;
    Selection selection_;
    Vec3 axis_, through_;
};

/// Time of the last frame of a sum, so that a frame that ends one phase and begins the next counts once.
class FramesOnce {
public:
    /// Returns true at the first call for this moment.
    [[nodiscard]] bool operator()(const Frame& frame) {
        const bool again = frame.time == last_;
        last_ = frame.time;
        return !again;
    }
    void save(ByteWriter& out) const { out.put(last_); }
    void restore(ByteReader& in) { in.get(last_); }

private:
    double last_ = undefined;  // s
};

/// Writes a sum of solver/observables/turned_bed.hpp.
template <class Sum>
void save_sum(const Sum& sum, ByteWriter& out) {
    Sum::fields(sum, [&out](const auto& value) { out.put(value); });
}

/// Reads it back. The options fix the lengths of its columns.
template <class Sum>
void restore_sum(Sum& sum, ByteReader& in) {
    Sum::fields(sum, [&in](auto& value) {
        if constexpr (requires { value.size(); }) {
            const std::size_t size = value.size();
            in.get(value);
            in.require(value.size() == size);
        } else {
            in.get(value);
            in.require(value >= 0);
        }
    });
}

}  // namespace grainsweep::machine
