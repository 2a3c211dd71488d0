// Observables of a bed in a rotating drum: sums over frames in the plane across the drum's axis.
//
// In the plane, x is horizontal and z is up. The drum rotates from z to x, so the bed is raised towards negative x; its
// angles are positive. By default the axis is y through the origin. Lengths in m. The volume of a sphere counts at its
// centre.
//
//     surface           per column of cells the height at which the mean solid fraction falls through a level, from
//                       above, linear between the cells' centres. A line is fitted through |x| <= 0.4 R
//     flow              mean velocity down this line, in layers below it, within 2.5 D of the foot of the perpendicular
//                       from the axis
//     cover             share of the frames in which a sphere hides the cell's centre in a view along the axis. It
//                       corresponds to a time-averaged photograph of a drum with light behind it
#pragma once

#include "solver/dem/engine.hpp"
#include "solver/observables/line_fit.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace grainsweep::observables {

/// Sphere in the plane: its centre relative to the axis, m, and its velocity, m/s.
struct SectionSphere {
    double x = 0, z = 0, vx = 0, vz = 0;
    double radius = 0;
};
using Section = std::vector<SectionSphere>;

/// Plane across an axis; unit vectors.
struct SectionView {
    dem::Vec3 through{};  ///< a point on the axis, m
    dem::Vec3 across{1, 0, 0}, up{0, 0, 1};

    [[nodiscard]] SectionSphere sphere(const dem::State& state, std::size_t i) const;
};

/// Grid of square cells that cover the drum, with edges at whole multiples of `cell` from the axis. Numbered from the
/// smallest x and z, x fastest.
struct SectionGrid {
    double cell = 0;
    std::int64_t count = 0;  ///< along each axis; even

    SectionGrid() = default;
    SectionGrid(double radius, double its_cell);

    [[nodiscard]] std::size_t cells() const { return static_cast<std::size_t>(count * count); }
    /// Returns the coordinate of the centres of the k-th column or row.
    [[nodiscard]] double centre(std::int64_t k) const {
        return (static_cast<double>(k) + 0.5 - 0.5 * static_cast<double>(count)) * cell;
    }
    [[nodiscard]] std::size_t number(std::int64_t column, std::int64_t row) const {
        return static_cast<std::size_t>(row * count + column);
    }
    /// Returns the column of a coordinate, which may lie beyond the grid.
    [[nodiscard]] std::int64_t column(double x) const;
};

/// Returns the points where `values` fall through `level`, from above, in each column whose centre lies within `reach`
/// of the axis.
[[nodiscard]] std::vector<std::array<double, 2>> falling_through(const SectionGrid& grid,
                                                                 std::span<const double> values, double level,
                                                                 double reach);

/// Mean solid fraction of a drum of some length on cells as large as a particle.
class SolidFraction {
public:
    SolidFraction(double radius, double length, double diameter);
    void add(std::span<const SectionSphere> spheres);

    [[nodiscard]] const SectionGrid& grid() const { return grid_; }
    [[nodiscard]] std::vector<double> mean() const;
    /// Returns the line through the surface; NaN: too few columns contain powder.
    [[nodiscard]] Line surface_line(double radius) const;

    static void fields(auto& s, auto&& visit) { visit(s.volume_), visit(s.frames_); }

private:
    SectionGrid grid_;
    double length_;
    std::vector<double> volume_;
    std::int64_t frames_ = 0;
};

/// Mean velocity of centres on cells of a fifth of a particle.
class SectionFlow {
public:
    SectionFlow(double radius, double diameter);
    void add(std::span<const SectionSphere> spheres);

    struct DownhillProfile {
        double surface_speed = 0;  ///< m/s: centres 0 to 1 D below the line; NaN: none
        double depth = 0;          ///< D: where the mean velocity changes sign; NaN: nowhere
    };
    /// Returns the profile below a line of the surface.
    [[nodiscard]] DownhillProfile below(const Line& surface) const;

    static void fields(auto& s, auto&& visit) { visit(s.vx_), visit(s.vz_), visit(s.centres_); }

private:
    SectionGrid grid_;
    double diameter_;
    std::vector<double> vx_, vz_;
    std::vector<std::int64_t> centres_;
};

/// Share of frames in which each cell's centre is hidden.
class Cover {
public:
    Cover(double radius, double cell);
    void add(std::span<const SectionSphere> spheres);

    [[nodiscard]] const SectionGrid& grid() const { return grid_; }
    [[nodiscard]] std::vector<double> share() const;
    /// Returns 1 for each cell whose centre a sphere hides, else 0; valid until the next call.
    [[nodiscard]] std::span<const char> hidden_by(std::span<const SectionSphere> spheres);

    static void fields(auto& s, auto&& visit) { visit(s.hidden_), visit(s.frames_); }

private:
    SectionGrid grid_;
    std::vector<std::int64_t> hidden_;
    std::int64_t frames_ = 0;
    std::vector<char> now_;  // scratch
};

/// Returns the mean tangential speed, in the drum's sense, of the spheres nearer than a tenth of D to the lower half of
/// the wall, m/s; empty: there are none.
[[nodiscard]] std::optional<double> wall_layer_speed(std::span<const SectionSphere> spheres, double radius,
                                                     double diameter);

}  // namespace grainsweep::observables
