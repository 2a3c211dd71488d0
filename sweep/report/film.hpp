// Film of a case: the frames of a scene, packed for the player of the page (page/watch).
//
// Positions are 16-bit numbers between the ends of the film's box along each axis, with an error of half of 1/65535 of
// it. Colours and slices are 8-bit numbers (0: undefined), with an error of 1/508 of their range. The range ends at the
// 99.5 % quantile if a few values lie far beyond. Vectors are shown by their magnitude. A flow is shown on the three
// planes through the middle of its box, interpolated between adjacent cells. Forces are the normal forces of touching
// particles, pairs of spheres with 8-bit numbers.
#pragma once

#include "solver/scenes/values.hpp"
#include "sweep/report/table.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

namespace grainsweep::report {

struct FilmLimits {
    std::size_t spheres = 100'000;  ///< of more spheres a fixed random subset is shown
    /// Limit of the film's size as text (base64), or 8.3 bytes per sphere and frame if that is more. Columns beyond the
    /// limit are left out; positions are always kept.
    std::size_t bytes = 10'000'000;
    bool columns = true;  ///< every column of the scene; false: only velocity
    bool forces = false;  ///< normal forces of the contacts of particles
};

class Film {
public:
    explicit Film(const FilmLimits& limits = {}) : limits_(limits) {}

    /// Adds a frame, later than all earlier ones. Throws std::invalid_argument if a column has another length than the
    /// positions.
    void add(const Snapshot& snapshot, double time);
    /// Keeps only these frames; indices in ascending order.
    void keep(const std::vector<std::size_t>& frames);
    [[nodiscard]] std::size_t frames() const { return times_.size(); }
    [[nodiscard]] std::size_t spheres() const { return spheres_.size(); }
    /// Returns whether the page draws forces: they are wanted, and two bytes number every sphere.
    [[nodiscard]] bool shows_forces() const { return limits_.forces && spheres_.size() <= 65'536; }
    /// Returns whether the film shows particles or a flow.
    [[nodiscard]] bool shows_anything() const { return !spheres_.empty() || !slices_.empty() || !walls_.empty(); }

    /// Returns the film: "GSF2", the length of the header (32 bits, little endian), the header (JSON, UTF-8) and the
    /// blocks, whose lengths and numbers are in the header. `about`: text on the case.
    [[nodiscard]] std::string bytes(const Json& about) const;

private:
    struct Sphere {
        double diameter = 0;
        bool mobile = true;
    };
    /// Normal force of a contact of two spheres, which are numbered by their places.
    struct Force {
        std::size_t first = 0, second = 0;
        double size = 0;
    };
    struct Frame {
        std::vector<std::array<float, 3>> positions;  ///< by place; NaN: absent
        std::map<std::string, std::vector<float>, std::less<>> columns;
        std::vector<Force> forces;
    };
    struct Wall {
        WallSurface shape;                                          ///< in its first frame
        std::size_t first = 0;                                      ///< frame
        std::vector<std::vector<std::array<double, 3>>> corners{};  ///< of this frame and each later one
        bool moves = false, closed = false;
    };
    struct Slice {
        std::string field, quantity;
        int component = -1;  ///< component of a vector; 3: magnitude; -1: a scalar
        std::array<std::vector<double>, 3> faces;
        std::array<std::vector<float>, 3> planes{};  ///< frame by frame
        std::size_t frames = 0;
    };

    std::vector<std::size_t> places_of(const Snapshot& snapshot);
    void add_particles(const Snapshot& snapshot);
    void add_forces(const Snapshot& snapshot, Frame& frame) const;
    void add_walls(const Snapshot& snapshot);
    void add_slices(const FlowField& field);
    [[nodiscard]] Slice& slice_of(const FlowField& field, const std::string& quantity, int component);

    friend class FilmWriter;

    FilmLimits limits_;
    std::vector<double> times_;
    std::vector<Frame> frames_;
    std::vector<Sphere> spheres_;
    std::unordered_map<std::int64_t, std::size_t> place_of_;  ///< place of an id; never iterated
    double kept_share_ = 1;
    std::size_t most_present_ = 0;  ///< most particles at a time, before thinning
    std::vector<Wall> walls_;
    std::vector<Slice> slices_;
    std::map<std::string, std::string, std::less<>> units_;
    std::string length_unit_ = "m", time_unit_ = "s";
    std::array<double, 3> periods_{};
};

}  // namespace grainsweep::report
